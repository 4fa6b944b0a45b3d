#include "scene/image/stored_oiio.h"

#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "scene/base/fnv128.h"
#include "scene/image/oiio_input.h"
#include "scene/image/picture_damage.h"

namespace cistula {
namespace {

struct SampleType {
    ReplyType type;
    OIIO::TypeDesc format;  // in which the values are read
};

/// The type of a file's values; none for what does not fit into 32 bits, or a double.
std::optional<SampleType> sample_type(OIIO::TypeDesc format) {
    switch (format.basetype) {
        case OIIO::TypeDesc::UINT8:
            return SampleType{ReplyType::uint8, OIIO::TypeDesc::UINT8};
        case OIIO::TypeDesc::INT8:
            return SampleType{ReplyType::int8, OIIO::TypeDesc::INT8};
        case OIIO::TypeDesc::UINT16:
            return SampleType{ReplyType::uint16, OIIO::TypeDesc::UINT16};
        case OIIO::TypeDesc::INT16:
            return SampleType{ReplyType::int16, OIIO::TypeDesc::INT16};
        case OIIO::TypeDesc::UINT32:
            return SampleType{ReplyType::uint32, OIIO::TypeDesc::UINT32};
        case OIIO::TypeDesc::INT32:
            return SampleType{ReplyType::int32, OIIO::TypeDesc::INT32};
        case OIIO::TypeDesc::HALF:
            return SampleType{ReplyType::half, OIIO::TypeDesc::FLOAT};
        case OIIO::TypeDesc::FLOAT:
            return SampleType{ReplyType::float_, OIIO::TypeDesc::FLOAT};
        case OIIO::TypeDesc::DOUBLE:
            return SampleType{ReplyType::double_, OIIO::TypeDesc::DOUBLE};
        default:
            return std::nullopt;
    }
}

/// Texts with blanks between, numbers exact; of bytes and of what is long, the size and a hash.
std::string attribute_text(const OIIO::ParamValue& attribute) {
    const OIIO::TypeDesc type = attribute.type();
    const auto count = static_cast<size_t>(attribute.nvalues()) * type.numelements() * type.aggregate;
    constexpr size_t most = 64;
    const bool is_bytes = type.basetype == OIIO::TypeDesc::UINT8 && count > 1;
    if (count <= most && !is_bytes) {
        std::string text;
        for (size_t i = 0; i < count; ++i) {
            char number[32];
            const void* const data = attribute.data();
            if (type.basetype == OIIO::TypeDesc::FLOAT)
                std::snprintf(number, sizeof number, "%.9g", static_cast<double>(static_cast<const float*>(data)[i]));
            else if (type.basetype == OIIO::TypeDesc::DOUBLE)
                std::snprintf(number, sizeof number, "%.17g", static_cast<const double*>(data)[i]);
            else
                return attribute.get_string(static_cast<int>(most));
            if (i > 0) text += ' ';
            text += number;
        }
        return text;
    }
    Fnv128 hash;
    hash.add_bytes(attribute.data(), static_cast<size_t>(attribute.datasize()));
    return std::to_string(attribute.datasize()) + " bytes, hash " + hash.hex();
}

/// One file in work.
class StoredInput {
  public:
    StoredInput(OIIO::ImageInput& input, const OiioStoredHost& host) : input_(input), host_(host) {}

    bool read(const char* path) {
        if (is_multiplied(input_)) return fail(multiplied_reason);
        if (const std::string damage = picture_damage(input_.format_name(), path); !damage.empty()) return fail(damage);
        for (int subimage = 0; input_.seek_subimage(subimage, 0); ++subimage)
            for (int level = 0; input_.seek_subimage(subimage, level); ++level)
                if (!read_picture(subimage, level)) return false;
        return true;
    }

  private:
    bool fail(const std::string& reason) const {
        host_.failed(host_.self, reason_or_none(reason).c_str());
        return false;
    }

    bool read_picture(int subimage, int level) const {
        const OIIO::ImageSpec spec = input_.spec();
        if (spec.deep) return fail("it is deep, with several samples in a pixel; flatten it first");
        if (spec.depth > 1) return fail("it is a volume; give a picture");
        if (spec.nchannels < 1 || spec.nchannels > static_cast<int>(most_stored_channels))
            return fail("it has " + std::to_string(spec.nchannels) + " channels; a picture has 1 to " +
                        std::to_string(most_stored_channels));
        const std::optional<SampleType> sample = sample_type(spec.format);
        if (!sample)
            return fail(std::string("its values are of type ") + spec.format.c_str() +
                        ", which is not compared; they may have up to 32 bits, or be floating-point numbers");
        if (!announce(spec, level, sample->type)) return false;
        if (level == 0)
            for (const OIIO::ParamValue& attribute : spec.extra_attribs)
                host_.attribute(host_.self, attribute.name().c_str(), attribute.type().c_str(),
                                attribute_text(attribute).c_str());
        const std::string problem =
            read_rows(input_, subimage, level, spec.nchannels, sample->format,
                      [&](const void* values, size_t texels) { host_.samples(host_.self, values, texels); });
        return problem.empty() || fail(problem);
    }

    bool announce(const OIIO::ImageSpec& spec, int level, ReplyType type) const {
        std::vector<std::string> names = spec.channelnames;
        for (auto i = names.size(); i < static_cast<size_t>(spec.nchannels); ++i)
            names.push_back("channel" + std::to_string(i));
        std::vector<const char*> pointers;
        for (const std::string& name : names) pointers.push_back(name.c_str());
        const bool has_display = spec.full_width > 0 && spec.full_height > 0;
        const OiioPicture picture = {spec.x,
                                     spec.y,
                                     spec.width,
                                     spec.height,
                                     has_display ? spec.full_x : spec.x,
                                     has_display ? spec.full_y : spec.y,
                                     has_display ? spec.full_width : spec.width,
                                     has_display ? spec.full_height : spec.height,
                                     static_cast<uint32_t>(level),
                                     static_cast<uint32_t>(spec.nchannels),
                                     type,
                                     input_.format_name(),
                                     pointers.data()};
        return host_.picture(host_.self, &picture);
    }

    OIIO::ImageInput& input_;
    const OiioStoredHost& host_;
};

}  // namespace

bool read_stored(const char* path, const OiioStoredHost* host) noexcept {
    return guarded(*host, [&] {
        limit_library(host->left);  // a value is a byte at least
        OIIO::ImageSpec settings = as_stored();
        settings["oiio:RawColor"] = 1;  // as CMYK and YCbCr
        const auto input = OIIO::ImageInput::open(path, &settings);
        if (input) return StoredInput(*input, *host).read(path);
        host->failed(host->self, reason_or_none(OIIO::geterror()).c_str());
        return false;
    });
}

}  // namespace cistula
