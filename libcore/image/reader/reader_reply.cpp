#include "image/reader/reader_reply.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <type_traits>
#include <utility>

#include "base/suggest.h"
#include "image/color/texel_decoder.h"
#include "image/reader/texture_limits.h"

namespace cistula {
namespace {

constexpr uint32_t most_attributes = 65536;
constexpr uint32_t longest_window = 1 << 30;

[[noreturn]] void fail_broken() {
    throw ReaderBroken("its decoder gave an answer that makes no sense; the file is damaged, give another");
}

bool is_place(int32_t place) {
    constexpr auto most = static_cast<int32_t>(longest_window);
    return -most <= place && place <= most;
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

template <class Record>
Record record_of(std::string_view bytes) {
    if (bytes.size() < sizeof(Record)) fail_broken();
    Record record;
    std::memcpy(&record, bytes.data(), sizeof record);
    return record;
}

FileColors colors_of(std::string_view bytes) {
    const auto reply = record_of<ReplyColors>(bytes);
    bytes.remove_prefix(sizeof reply);
    if (bytes.size() > largest_reply_id) fail_broken();
    FileColors colors;
    (reply.names_profile != 0 ? colors.profile : colors.id) = bytes;
    if (reply.has_chromaticities != 0) colors.chromaticities = std::to_array(reply.chromaticities);
    colors.factors = std::to_array(reply.factors);
    colors.is_aces = reply.is_aces != 0;
    colors.is_half = reply.is_half != 0;
    return colors;
}

/// Calls `work` with a number of the type as which values are sent.
template <class Work>
void with_sample(StoredType type, Work work) {
    switch (type) {
        case StoredType::uint8:
            return work(uint8_t{});
        case StoredType::int8:
            return work(int8_t{});
        case StoredType::uint16:
            return work(uint16_t{});
        case StoredType::int16:
            return work(int16_t{});
        case StoredType::uint32:
        case StoredType::uint:
            return work(uint32_t{});
        case StoredType::int32:
            return work(int32_t{});
        case StoredType::half:
        case StoredType::float_:
            return work(float{});
        case StoredType::double_:
            return work(double{});
    }
}

/// The numbers of a StoredChannel for values that are sent as samples.
template <class Sample>
using ValuesOf = std::vector<std::conditional_t<std::is_floating_point_v<Sample>, Sample,
                                                std::conditional_t<std::is_signed_v<Sample>, int32_t, uint32_t>>>;

/// Puts the values of whole texels behind those that are there.
void append_texels(StoredPicture& picture, std::string_view texels) {
    const size_t channels = picture.channels.size();
    with_sample(picture.channels[0].type, [&](auto sample) {
        using Sample = decltype(sample);
        for (size_t i = 0; i < channels; ++i) {
            auto& values = std::get<ValuesOf<Sample>>(picture.channels[i].values);
            for (size_t at = i * sizeof sample; at < texels.size(); at += channels * sizeof sample) {
                std::memcpy(&sample, texels.data() + at, sizeof sample);
                values.push_back(sample);
            }
        }
    });
}

}  // namespace

ReplyHead ReaderReply::next_head() const {
    ReplyHead head;
    receive_(&head, sizeof head);
    if (head.bytes > largest_reply_part) fail_broken();
    if (head.kind != ReplyKind::failed) return head;
    std::string reason = bytes_of(head.bytes);
    constexpr size_t longest = 1000;
    reason.resize(std::min(reason.size(), longest));
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    throw PictureRefused(one_line(reason));
}

std::string ReaderReply::bytes_of(size_t count) const {
    std::string bytes(count, '\0');
    receive_(bytes.data(), bytes.size());
    return bytes;
}

ReplyStart ReaderReply::begin(size_t count) {
    const std::string bytes = bytes_of(count);
    const auto reply = record_of<ReplyPicture>(bytes);
    const std::vector<std::string> texts = texts_of(std::string_view(bytes).substr(sizeof reply));
    if (reply.type >= StoredType::uint || reply.channels == 0 || reply.channels > most_stored_channels ||
        texts.size() != reply.channels + 1)
        fail_broken();
    const uint32_t sample = facts_of(reply.type).sample_bytes;
    const bool is_color =
        (reply.channels == 1 || reply.channels == 3) &&
        (reply.type == StoredType::uint8 || reply.type == StoredType::uint16 || reply.type == StoredType::float_);
    if (is_texture_ && (pictures_ > 0 || !is_color)) fail_broken();
    const uint64_t texel = is_texture_ ? texel_bytes : uint64_t{reply.channels} * facts_of(reply.type).value_bytes;
    // Levels follow each other, the whole resolution first.
    if (reply.level != 0 && (pictures_ == 0 || uint64_t{level_} + 1 != reply.level)) fail_broken();
    if (pictures_++ == most_stored_pictures ||
        !size_problem(is_texture_, reply.width, reply.height, texel, left_, left_).empty() ||
        reply.display_width > longest_window || reply.display_height > longest_window || !is_place(reply.x) ||
        !is_place(reply.y) || !is_place(reply.display_x) || !is_place(reply.display_y))
        fail_broken();
    level_ = reply.level;
    texel_ = size_t{reply.channels} * sample;
    texels_left_ = uint64_t{reply.width} * reply.height;
    left_ -= texel * texels_left_;

    ReplyStart start;
    start.format = texts[0];
    start.picture.x_level = start.picture.y_level = static_cast<int>(reply.level);
    start.picture.data = {reply.x, reply.y, static_cast<int>(reply.width), static_cast<int>(reply.height)};
    start.picture.display = {reply.display_x, reply.display_y, static_cast<int>(reply.display_width),
                             static_cast<int>(reply.display_height)};
    std::set<std::string> names;
    for (size_t i = 1; i < texts.size(); ++i) {
        std::string name = texts[i];
        for (int number = 2; !names.insert(name).second; ++number)
            name = texts[i] + " (" + std::to_string(number) + ")";
        start.picture.channels.push_back({name, reply.type, 1, 1, {}});
    }
    return start;
}

void ReaderReply::add_attribute(StoredPicture& picture, size_t count) {
    const std::vector<std::string> texts = texts_of(bytes_of(count));
    if (texts.size() != 3 || ++attributes_ > most_attributes) fail_broken();
    if (texts[0] == "oiio:subimagename")
        picture.name = texts[2];
    else if (is_packing(texts[0]))
        picture.packing[texts[0]] = texts[2];
    else
        picture.attributes[texts[0]] = {texts[1], texts[2], texts[2]};
}

std::optional<ReplyStart> ReaderReply::next() {
    const ReplyHead head = next_head();
    if (head.kind == ReplyKind::end && pictures_ > 0) return std::nullopt;
    if (head.kind != ReplyKind::picture) fail_broken();
    ReplyStart start = begin(head.bytes);
    for (ahead_ = next_head(); ahead_.kind != ReplyKind::samples; ahead_ = next_head()) {
        if (ahead_.kind == ReplyKind::colors)
            start.colors = colors_of(bytes_of(ahead_.bytes));
        else if (ahead_.kind == ReplyKind::attribute && !is_texture_)
            add_attribute(start.picture, ahead_.bytes);
        else
            fail_broken();
    }
    return start;
}

std::string ReaderReply::samples() {
    if (texels_left_ == 0) return {};
    const size_t bytes = ahead_.bytes;
    if (ahead_.kind != ReplyKind::samples || bytes == 0 || bytes % texel_ != 0 || bytes / texel_ > texels_left_)
        fail_broken();
    std::string samples = bytes_of(bytes);
    texels_left_ -= bytes / texel_;
    if (texels_left_ > 0) ahead_ = next_head();
    return samples;
}

ColorPicture receive_texture(ReaderReply& reply, std::string_view encoding) {
    const ReplyStart start = *reply.next();  // the first is there
    const StoredPicture& sent = start.picture;
    const uint32_t sample = facts_of(sent.channels[0].type).sample_bytes;
    const TexelDecoder decoder(file_encoding(encoding, start.colors, sample == sizeof(float)), sample,
                               start.colors.is_half, start.colors.factors);
    for (const double factor : start.colors.factors)
        if (!(is_finite(factor) && factor > 0))
            throw std::runtime_error(
                "its header's EXPOSURE or COLORCORR is no number above 0, by which its numbers could be divided");
    ColorPicture picture;
    picture.divided_by = start.colors.factors;
    picture.width = static_cast<uint32_t>(sent.data.width);
    picture.height = static_cast<uint32_t>(sent.data.height);
    picture.texels.reserve(sent.data.pixels());
    for (std::string samples = reply.samples(); !samples.empty(); samples = reply.samples())
        decoder.append(samples, static_cast<uint32_t>(sent.channels.size()), picture.texels);
    if (reply.next()) fail_broken();
    return picture;
}

StoredFile receive_stored(ReaderReply& reply) {
    StoredFile file;
    while (std::optional<ReplyStart> start = reply.next()) {
        file.format = start->format;
        for (StoredChannel& channel : start->picture.channels)
            with_sample(channel.type, [&](auto sample) {
                channel.values.emplace<ValuesOf<decltype(sample)>>().reserve(start->picture.data.pixels());
            });
        for (std::string samples = reply.samples(); !samples.empty(); samples = reply.samples())
            append_texels(start->picture, samples);
        file.pictures.push_back(std::move(start->picture));
    }
    return file;
}

}  // namespace cistula
