#include "scene/image/stored_reply.h"

#include <cstring>
#include <set>
#include <string_view>
#include <utility>

#include "scene/image/texture_limits.h"

namespace cistula {
namespace {

constexpr uint32_t most_attributes = 65536;
constexpr uint32_t longest_window = 1 << 30;

StoredType stored_type(ReplyType type) {
    switch (type) {
        case ReplyType::uint8:
            return StoredType::uint8;
        case ReplyType::int8:
            return StoredType::int8;
        case ReplyType::uint16:
            return StoredType::uint16;
        case ReplyType::int16:
            return StoredType::int16;
        case ReplyType::uint32:
            return StoredType::uint32;
        case ReplyType::int32:
            return StoredType::int32;
        case ReplyType::half:
            return StoredType::half;
        case ReplyType::float_:
            return StoredType::float_;
        case ReplyType::double_:
            return StoredType::double_;
    }
    fail_broken();
}

/// What only says how values are packed.
bool is_packing(std::string_view name) {
    static const std::set<std::string_view> names = {"compression",       "CompressionQuality",
                                                     "planarconfig",      "tiff:Compression",
                                                     "tiff:RowsPerStrip", "tiff:PlanarConfiguration",
                                                     "tiff:zipquality",   "png:compressionLevel",
                                                     "png:filter",        "oiio:subimages"};
    return names.count(name) > 0;
}

/// The texts of a part of an answer, each with a zero byte at its end.
std::vector<std::string> texts_of(std::string_view bytes) {
    std::vector<std::string> texts;
    while (!bytes.empty()) {
        const size_t end = bytes.find('\0');
        if (end == bytes.npos) fail_broken();
        texts.emplace_back(bytes.substr(0, end));
        bytes.remove_prefix(end + 1);
    }
    return texts;
}

/// Puts the values of one channel of whole texels behind those that are there.
template <class Sample, class Value>
void append_channel(std::string_view texels, size_t channel, size_t channels, std::vector<Value>& values) {
    const size_t step = channels * sizeof(Sample);
    for (size_t at = channel * sizeof(Sample); at < texels.size(); at += step) {
        Sample sample;
        std::memcpy(&sample, texels.data() + at, sizeof sample);
        values.push_back(static_cast<Value>(sample));
    }
}

template <class Sample, class Value>
void append_texels(StoredPicture& picture, std::string_view texels) {
    for (size_t i = 0; i < picture.channels.size(); ++i)
        append_channel<Sample>(texels, i, picture.channels.size(),
                               std::get<std::vector<Value>>(picture.channels[i].values));
}

void append_texels(StoredPicture& picture, ReplyType type, std::string_view texels) {
    switch (type) {
        case ReplyType::uint8:
            return append_texels<uint8_t, uint32_t>(picture, texels);
        case ReplyType::int8:
            return append_texels<int8_t, int32_t>(picture, texels);
        case ReplyType::uint16:
            return append_texels<uint16_t, uint32_t>(picture, texels);
        case ReplyType::int16:
            return append_texels<int16_t, int32_t>(picture, texels);
        case ReplyType::uint32:
            return append_texels<uint32_t, uint32_t>(picture, texels);
        case ReplyType::int32:
            return append_texels<int32_t, int32_t>(picture, texels);
        case ReplyType::half:
        case ReplyType::float_:
            return append_texels<float, float>(picture, texels);
        case ReplyType::double_:
            return append_texels<double, double>(picture, texels);
    }
}

/// Empty values of the kind that holds a type, with room.
decltype(StoredChannel::values) values_for(ReplyType type, size_t count) {
    const auto with_room = [&](auto values) {
        values.reserve(count);
        return decltype(StoredChannel::values)(std::move(values));
    };
    switch (type) {
        case ReplyType::uint8:
        case ReplyType::uint16:
        case ReplyType::uint32:
            return with_room(std::vector<uint32_t>());
        case ReplyType::int8:
        case ReplyType::int16:
        case ReplyType::int32:
            return with_room(std::vector<int32_t>());
        case ReplyType::double_:
            return with_room(std::vector<double>());
        default:
            return with_room(std::vector<float>());
    }
}

/// The answer, part for part.
class StoredReply {
  public:
    StoredReply(const Receive& receive, uint64_t& left, const std::function<void(uint64_t)>& announced)
        : receive_(receive), left_(left), announced_(announced) {}

    StoredFile take() {
        for (ReplyHead head = next(); head.kind != ReplyKind::end; head = next()) {
            if (head.kind == ReplyKind::picture)
                begin_picture(head.bytes);
            else if (head.kind == ReplyKind::attribute)
                add_attribute(head.bytes);
            else if (head.kind == ReplyKind::samples)
                add_samples(head.bytes);
            else
                fail_broken();
        }
        if (texels_left_ > 0 || file_.pictures.empty()) fail_broken();
        return std::move(file_);
    }

  private:
    ReplyHead next() const { return next_part(receive_); }

    std::string bytes_of(size_t count) const {
        std::string bytes(count, '\0');
        receive_(bytes.data(), bytes.size());
        return bytes;
    }

    void begin_picture(size_t count) {
        ReplyPicture reply;
        if (texels_left_ > 0 || count < sizeof reply || file_.pictures.size() == most_stored_pictures) fail_broken();
        receive_(&reply, sizeof reply);
        const std::vector<std::string> texts = texts_of(bytes_of(count - sizeof reply));
        const StoredType type = stored_type(reply.type);
        if (reply.channels == 0 || reply.channels > most_stored_channels || texts.size() != reply.channels + 1)
            fail_broken();
        const uint64_t texel = uint64_t{reply.channels} * value_bytes(reply.type);
        if (!stored_size_problem(reply.width, reply.height, texel, left_, left_).empty() ||
            reply.display_width > longest_window || reply.display_height > longest_window || !is_next(reply.level) ||
            !is_place(reply.x) || !is_place(reply.y) || !is_place(reply.display_x) || !is_place(reply.display_y))
            fail_broken();
        const uint64_t texels = uint64_t{reply.width} * reply.height;
        left_ -= texel * texels;
        if (announced_) announced_(texel * texels);
        StoredPicture picture;
        picture.x_level = picture.y_level = static_cast<int>(reply.level);
        picture.data = {reply.x, reply.y, static_cast<int>(reply.width), static_cast<int>(reply.height)};
        picture.display = {reply.display_x, reply.display_y, static_cast<int>(reply.display_width),
                           static_cast<int>(reply.display_height)};
        file_.format = texts[0];
        std::set<std::string> names;
        for (size_t i = 1; i < texts.size(); ++i) {
            std::string name = texts[i];
            for (int number = 2; !names.insert(name).second; ++number)
                name = texts[i] + " (" + std::to_string(number) + ")";
            picture.channels.push_back({name, type, 1, 1, values_for(reply.type, texels)});
        }
        file_.pictures.push_back(std::move(picture));
        type_ = reply.type;
        texels_left_ = texels;
    }

    /// Levels follow each other, the whole resolution first.
    bool is_next(uint32_t level) const {
        return level == 0 ||
               (!file_.pictures.empty() && static_cast<uint64_t>(file_.pictures.back().x_level) + 1 == level);
    }
    static bool is_place(int32_t place) {
        constexpr auto most = static_cast<int32_t>(longest_window);
        return -most <= place && place <= most;
    }

    void add_attribute(size_t count) {
        const std::vector<std::string> texts = texts_of(bytes_of(count));
        if (file_.pictures.empty() || texts.size() != 3 || ++attributes_ > most_attributes) fail_broken();
        StoredPicture& picture = file_.pictures.back();
        if (texts[0] == "oiio:subimagename")
            picture.name = texts[2];
        else if (is_packing(texts[0]))
            picture.packing[texts[0]] = texts[2];
        else
            picture.attributes[texts[0]] = {texts[1], texts[2], texts[2]};
    }

    void add_samples(size_t count) {
        if (file_.pictures.empty()) fail_broken();
        StoredPicture& picture = file_.pictures.back();
        const size_t texel = picture.channels.size() * sample_bytes(type_);
        if (count == 0 || count % texel != 0 || count / texel > texels_left_) fail_broken();
        append_texels(picture, type_, bytes_of(count));
        texels_left_ -= count / texel;
    }

    const Receive& receive_;
    uint64_t& left_;
    const std::function<void(uint64_t)>& announced_;
    StoredFile file_;
    ReplyType type_ = ReplyType::uint8;
    uint64_t texels_left_ = 0;
    uint32_t attributes_ = 0;
};

}  // namespace

StoredFile receive_stored(const Receive& receive, uint64_t& left, const std::function<void(uint64_t)>& announced) {
    return StoredReply(receive, left, announced).take();
}

}  // namespace cistula
