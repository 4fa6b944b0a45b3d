// The part that reads pictures of the module that uses OpenImageIO.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <climits>
#include <cstdio>
#include <exception>
#include <new>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "base/file_bytes.h"
#include "base/fnv128.h"
#include "image/reader/oiio_module.h"
#include "image/reader/texture_limits.h"

namespace cistula {
namespace {

/// What OpenImageIO says of a failure, or that it says nothing.
std::string reason_or_none(const std::string& reason) {
    return reason.empty() ? "OpenImageIO gives no reason; the file is damaged" : reason;
}

/// Reports why a file cannot be read.
bool fail(const OiioHost& host, const std::string& reason) {
    host.failed(host.self, reason_or_none(reason).c_str());
    return false;
}

/// Sets the library's own limits, in case a format asks them before the size is seen here; versions differ in which of
/// them they know.
void limit_library(uint64_t texels) {
    constexpr uint64_t most_stored_bytes = 32;  // of a texel: four doubles
    const uint64_t megabytes = texels * most_stored_bytes / (1 << 20) + 1;
    OIIO::attribute("limits:imagesize_MB", static_cast<int>(std::min<uint64_t>(megabytes, INT_MAX)));
    OIIO::attribute("limits:resolution", static_cast<int>(largest_picture_side));
    OIIO::attribute("threads", 1);
}

/// Reads a subimage at a level, some rows at a time, so that the whole picture is never in memory here, but for formats
/// that have it there. Says why that fails.
bool read_rows(OIIO::ImageInput& input, int subimage, int level, int channels, const OIIO::TypeDesc& format,
               const OiioHost& host) {
    const OIIO::ImageSpec spec = input.spec();
    const size_t texel = static_cast<size_t>(channels) * format.size();
    const size_t row = texel * static_cast<size_t>(spec.width);
    constexpr size_t piece = 16 << 20;
    const int step = spec.tile_width > 0 ? spec.tile_height : static_cast<int>(std::clamp<size_t>(piece / row, 1, 256));
    if (step < 1) return fail(host, "its tiles have no height");
    std::vector<char> samples(row * static_cast<size_t>(std::min(step, spec.height)));
    for (int y = 0; y < spec.height; y += std::min(step, spec.height - y)) {
        const int first = spec.y + y;
        const int end = first + std::min(step, spec.height - y);
        const bool done =
            spec.tile_width > 0
                ? input.read_tiles(subimage, level, spec.x, spec.x + spec.width, first, end, spec.z, spec.z + 1, 0,
                                   channels, format, samples.data())
                : input.read_scanlines(subimage, level, first, end, spec.z, 0, channels, format, samples.data());
        if (!done || input.has_error()) return fail(host, input.geterror());  // some formats fail after true
        host.samples(host.self, samples.data(), static_cast<size_t>(end - first) * static_cast<size_t>(spec.width));
    }
    return true;
}

/// Whether a WebP file has colors that the library multiplies by alpha, in their codes: versions before 2.5 know no
/// other way. Those of opaque pixels stay what they are.
bool is_multiplied(OIIO::ImageInput& input) {
    const OIIO::ImageSpec& spec = input.spec();
    if (std::string_view(input.format_name()) != "webp" || spec.alpha_channel < 0) return false;
    if (spec.get_int_attribute("oiio:UnassociatedAlpha") != 0) return false;
    std::vector<uint8_t> row(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.nchannels));
    for (int y = 0; y < spec.height; ++y) {
        if (!input.read_scanline(y, 0, OIIO::TypeDesc::UINT8, row.data()))
            return false;  // which is said when it is read
        for (auto at = static_cast<size_t>(spec.alpha_channel); at < row.size();
             at += static_cast<size_t>(spec.nchannels))
            if (row[at] != 255) return true;
    }
    return false;
}

constexpr const char* multiplied_reason =
    "its colors are multiplied by their alpha when it is read; save it without alpha, or as PNG";

/// The type of a file's values, that of those which are sent, and that in which they are read.
struct SampleType {
    OIIO::TypeDesc::BASETYPE file;
    StoredType sent;
    OIIO::TypeDesc::BASETYPE read;
};
constexpr SampleType stored_types[] = {
    {OIIO::TypeDesc::UINT8, StoredType::uint8, OIIO::TypeDesc::UINT8},
    {OIIO::TypeDesc::INT8, StoredType::int8, OIIO::TypeDesc::INT8},
    {OIIO::TypeDesc::UINT16, StoredType::uint16, OIIO::TypeDesc::UINT16},
    {OIIO::TypeDesc::INT16, StoredType::int16, OIIO::TypeDesc::INT16},
    {OIIO::TypeDesc::UINT32, StoredType::uint32, OIIO::TypeDesc::UINT32},
    {OIIO::TypeDesc::INT32, StoredType::int32, OIIO::TypeDesc::INT32},
    {OIIO::TypeDesc::HALF, StoredType::half, OIIO::TypeDesc::FLOAT},
    {OIIO::TypeDesc::FLOAT, StoredType::float_, OIIO::TypeDesc::FLOAT},
    {OIIO::TypeDesc::DOUBLE, StoredType::double_, OIIO::TypeDesc::DOUBLE},
};
constexpr SampleType texture_types[] = {
    {OIIO::TypeDesc::UINT8, StoredType::uint8, OIIO::TypeDesc::UINT8},
    {OIIO::TypeDesc::UINT16, StoredType::uint16, OIIO::TypeDesc::UINT16},
    {OIIO::TypeDesc::HALF, StoredType::float_, OIIO::TypeDesc::FLOAT},
    {OIIO::TypeDesc::FLOAT, StoredType::float_, OIIO::TypeDesc::FLOAT},
    {OIIO::TypeDesc::DOUBLE, StoredType::float_, OIIO::TypeDesc::FLOAT},
};

/// The entry for a file's type; null for what is not read.
template <size_t count>
const SampleType* sample_type(const SampleType (&types)[count], const OIIO::TypeDesc& format) {
    for (const SampleType& type : types)
        if (type.file == format.basetype) return &type;
    return nullptr;
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

/// Announces a picture with so many channels.
bool announce(const OiioHost& host, const OIIO::ImageSpec& spec, const char* format, int level, int channels,
              StoredType type) {
    std::vector<std::string> names = spec.channelnames;
    for (auto i = names.size(); i < static_cast<size_t>(channels); ++i) names.push_back("channel" + std::to_string(i));
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
                                 static_cast<uint32_t>(channels),
                                 type,
                                 format,
                                 pointers.data()};
    return host.picture(host.self, &picture);
}

/// Gives the host the file's ICC profile.
void send_profile(const OIIO::ImageSpec& spec, const OiioHost& host) {
    const OIIO::ParamValue* profile = spec.find_attribute("ICCProfile");
    if (profile && profile->type().basetype == OIIO::TypeDesc::UINT8)
        host.profile(host.self, profile->data(), static_cast<size_t>(profile->datasize()));
}

bool read_texture(OIIO::ImageInput& input, const char* path, const OiioHost& host) {
    const OIIO::ImageSpec spec = input.spec();
    if (spec.depth > 1 || spec.deep || spec.nchannels < 1)
        return fail(host, "it is no flat picture; a texture has one color per pixel");
    const SampleType* const type = sample_type(texture_types, spec.format);
    if (!type)
        return fail(host, std::string("its samples are of type ") + spec.format.c_str() +
                              "; a texture has 8 or 16 bits, half or float");
    if (is_multiplied(input)) return fail(host, multiplied_reason);
    const int channels = spec.nchannels < 3 ? 1 : 3;
    if (!announce(host, spec, input.format_name(), 0, channels, type->sent)) return false;
    send_profile(spec, host);
    if (const std::string damage = picture_damage(input.format_name(), path); !damage.empty())
        return fail(host, damage);
    return read_rows(input, 0, 0, channels, type->read, host);
}

bool read_level(OIIO::ImageInput& input, int subimage, int level, const OiioHost& host) {
    const OIIO::ImageSpec spec = input.spec();
    if (spec.deep) return fail(host, "it is deep, with several samples in a pixel; flatten it first");
    if (spec.depth > 1) return fail(host, "it is a volume; give a picture");
    if (spec.nchannels < 1 || spec.nchannels > static_cast<int>(most_stored_channels))
        return fail(host, "it has " + std::to_string(spec.nchannels) + " channels; a picture has 1 to " +
                              std::to_string(most_stored_channels));
    const SampleType* const type = sample_type(stored_types, spec.format);
    if (!type)
        return fail(host, std::string("its values are of type ") + spec.format.c_str() +
                              ", which is not compared; they may have up to 32 bits, or be floating-point numbers");
    if (!announce(host, spec, input.format_name(), level, spec.nchannels, type->sent)) return false;
    if (level == 0)
        for (const OIIO::ParamValue& attribute : spec.extra_attribs)
            host.attribute(host.self, attribute.name().c_str(), attribute.type().c_str(),
                           attribute_text(attribute).c_str());
    return read_rows(input, subimage, level, spec.nchannels, type->read, host);
}

bool read_stored(OIIO::ImageInput& input, const char* path, const OiioHost& host) {
    if (is_multiplied(input)) return fail(host, multiplied_reason);
    if (const std::string damage = picture_damage(input.format_name(), path); !damage.empty())
        return fail(host, damage);
    for (int subimage = 0; input.seek_subimage(subimage, 0); ++subimage)
        for (int level = 0; input.seek_subimage(subimage, level); ++level)
            if (!read_level(input, subimage, level, host)) return false;
    return true;
}

/// Versions from 2.5 on refuse pictures beyond limit_library's limits in words of their own, which end with the size:
/// "60000x60000". The host says it in its words, if it is too large for it, too.
bool fail_to_open(const OiioHost& host, const std::string& reason) {
    const std::regex size("([0-9]{1,9})x([0-9]{1,9})");
    std::smatch last;
    for (auto at = std::sregex_iterator(reason.begin(), reason.end(), size); at != std::sregex_iterator(); ++at)
        last = *at;
    if (!last.empty() && reason.find("exceed") != std::string::npos) {
        const OIIO::ImageSpec spec(std::stoi(last[1]), std::stoi(last[2]), 3, OIIO::TypeDesc::UINT8);
        if (!announce(host, spec, "", 0, 3, StoredType::uint8)) return false;
    }
    return fail(host, reason);
}

bool read_file(const char* path, const OiioHost& host) {
    limit_library(host.is_texture ? host.left / texel_bytes : host.left);  // a value is a byte at least
    OIIO::ImageSpec settings;
    settings["oiio:UnassociatedAlpha"] = 1;  // multiplied by alpha, colors would be darker, and wrong before decoding
    if (!host.is_texture) settings["oiio:RawColor"] = 1;  // as CMYK and YCbCr
    const auto input = OIIO::ImageInput::open(path, &settings);
    if (!input) return fail_to_open(host, OIIO::geterror());
    return host.is_texture ? read_texture(*input, path, host) : read_stored(*input, path, host);
}

bool read(const char* path, const OiioHost* host) noexcept {
    try {
        return read_file(path, *host);
    } catch (const std::bad_alloc&) {
        return fail(*host, "decoding it takes more memory than is allowed");
    } catch (const std::exception& error) {
        return fail(*host, error.what());
    } catch (...) {
        return fail(*host, "OpenImageIO threw an exception of an unknown kind");
    }
}

}  // namespace
}  // namespace cistula

extern "C" __attribute__((visibility("default"))) const cistula::OiioModule* cistula_oiio_module_8() {
    static constexpr cistula::OiioModule module = {cistula::read, cistula::open_view, cistula::assumed_space,
                                                   cistula::apply_view, cistula::close_view};
    return &module;
}
