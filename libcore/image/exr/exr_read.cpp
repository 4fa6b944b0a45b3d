// What is made of OpenEXR files: layered pictures, textures, files as they stand.
#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "image/color/file_colors.h"
#include "image/exr/exr.h"
#include "image/exr/exr_checks.h"
#include "image/exr/exr_file.h"

namespace cistula {
namespace {

/// Throws unless all channels have one value per pixel; where `is_chroma`, RY and BY may have one for two by two.
void check_sampling(const ExrPart& part, bool is_chroma) {
    for (const ExrChannel& channel : part.channels) {
        const bool may_be_halved = is_chroma && (channel.name == "RY" || channel.name == "BY");
        if ((channel.x_sampling != 1 || channel.y_sampling != 1) && !(may_be_halved && channel.is_halved()))
            throw std::runtime_error("channel " + channel.name + " is subsampled; convert it to one value per pixel" +
                                     (may_be_halved ? ", or one for two by two" : ""));
    }
}

/// Throws for whole numbers that floats do not tell apart.
void check_whole_numbers(const ExrChannel& channel) {
    const auto is_large = [](uint32_t number) { return number >= 1u << 24; };
    if (std::any_of(channel.numbers.begin(), channel.numbers.end(), is_large))
        throw std::runtime_error("channel " + channel.name +
                                 " has whole numbers of 2^24 or more, which are not told apart here");
}

std::vector<size_t> all_channels(const ExrPart& part) {
    std::vector<size_t> channels(part.channels.size());
    std::iota(channels.begin(), channels.end(), size_t{0});
    return channels;
}

/// A part; without `values` what its header says.
LayeredPicture read_part(const ExrFile& file, size_t number, bool values = true) {
    const ExrPart& part = file.parts()[number];
    check_sampling(part, false);
    LayeredPicture picture;
    picture.width = part.data.width;
    picture.height = part.data.height;
    picture.x = part.data.x - part.display.x;
    picture.y = part.data.y - part.display.y;
    picture.display_width = part.display.width;
    picture.display_height = part.display.height;
    picture.attributes = part.attributes;
    picture.compression = part.compression;
    std::vector<ExrChannel> channels = values ? file.read(number, all_channels(part)) : part.channels;
    for (ExrChannel& channel : channels) {
        check_whole_numbers(channel);
        picture.channels.push_back({channel.name, channel.type == StoredType::half, std::move(channel.values)});
    }
    return picture;
}

/// The channels that a texture is made of: three, or one of gray.
std::vector<size_t> color_channels(const ExrPart& part) {
    const auto number = [&](std::string_view name) {
        const auto found = std::find_if(part.channels.begin(), part.channels.end(),
                                        [&](const ExrChannel& channel) { return channel.name == name; });
        return static_cast<size_t>(found - part.channels.begin());
    };
    const auto has = [&](std::string_view name) { return number(name) < part.channels.size(); };
    if (has("R") && has("G") && has("B")) return {number("R"), number("G"), number("B")};
    if (part.channels.size() == 1) return {0};
    // With X and Z, Y is a coordinate.
    if (has("Y") && !has("R") && !has("G") && !has("B") && !has("X") && has("RY") == has("BY"))
        return has("RY") ? std::vector{number("RY"), number("Y"), number("BY")} : std::vector{number("Y")};
    std::string present;
    for (const ExrChannel& channel : part.channels) present += (present.empty() ? "" : ", ") + channel.name;
    throw std::runtime_error(
        "a texture has the channels R, G and B, or Y, or Y, RY and BY, or a single one; this file has " + present);
}

/// An attribute, or null if there is none. Throws if it is of another type.
template <class Value>
const Value* attribute(const ExrPart& part, const std::string& name, const std::string& type) {
    const auto found = part.header.find(name);
    if (found == part.header.end()) return nullptr;
    if (found->second.type != type)
        throw std::runtime_error("its attribute " + name + " is of the type " + found->second.type +
                                 "; it must be of the type " + type);
    return std::get_if<Value>(&part.attributes.at(name));
}

FileColors colors_of(const ExrPart& part) {
    FileColors colors;
    if (const auto* id = attribute<std::string>(part, "colorInteropID", "string")) colors.id = *id;
    if (const auto* given = attribute<std::vector<float>>(part, "chromaticities", "chromaticities"))
        std::copy(given->begin(), given->end(), colors.chromaticities.emplace().begin());
    const auto* aces = attribute<int>(part, "acesImageContainerFlag", "int");
    colors.is_aces = aces && *aces == 1;
    return colors;
}

ColorPicture read_colors(const ExrFile& file, FileColors& colors) {
    const ExrPart& part = file.parts()[0];
    const std::vector<size_t> channels = color_channels(part);
    const bool is_chroma = channels.size() == 3 && part.channels[channels[0]].name == "RY";
    check_sampling(part, is_chroma);
    colors = colors_of(part);
    bool is_halved[3] = {};
    for (size_t c = 0; c < channels.size(); ++c) {
        is_halved[c] = part.channels[channels[c]].is_halved();
        colors.is_half |= part.channels[channels[c]].type == StoredType::half;
    }
    ColorPicture picture = file.read_colors(0, channels);
    if (channels.size() == 1)
        for (glm::vec3& texel : picture.texels) texel = glm::vec3(texel[0]);
    if (is_chroma) {
        const ColorSpace space =
            colors.chromaticities ? color_space_of(*colors.chromaticities) : color_spaces().front();
        colors_from_chroma(picture, is_halved, luminance_weights(space));
    }
    return picture;
}

}  // namespace

namespace {

std::vector<PicturePart> read_parts(const std::string& path, bool values) {
    return with_file_errors(path, [&] {
        const ExrFile file(path);
        std::vector<PicturePart> parts;
        for (size_t i = 0; i < file.parts().size(); ++i)
            parts.push_back({file.parts()[i].name, read_part(file, i, values)});
        return parts;
    });
}

}  // namespace

std::vector<PicturePart> read_exr_parts(const std::string& path) {
    return read_parts(path, true);
}

std::vector<PicturePart> read_exr_headers(const std::string& path) {
    return read_parts(path, false);
}

LayeredPicture read_exr(const std::string& path) {
    return with_file_errors(path, [&] {
        const ExrFile file(path);
        if (file.parts().size() != 1)
            throw std::runtime_error("it has " + std::to_string(file.parts().size()) +
                                     " parts; give a file of one part");
        LayeredPicture picture = read_part(file, 0);
        if (!file.parts()[0].name.empty()) picture.attributes["name"] = file.parts()[0].name;
        return picture;
    });
}

bool exr_is_complete(const std::string& path) {
    try {
        const ExrFile file(path);
        return file.is_complete();
    } catch (const Error&) {
        return false;
    }
}

ColorPicture read_exr_texture(const std::string& path, const SizeProblem& size_problem, FileColors* colors) {
    FileColors own;
    return with_file_errors(path, [&] { return read_colors(ExrFile(path, size_problem), colors ? *colors : own); });
}

StoredFile read_stored_exr(const std::string& path, bool values) {
    const ExrFile file(path);
    StoredFile result;
    result.format = "openexr";
    for (size_t number = 0; number < file.parts().size(); ++number) {
        const ExrPart& part = file.parts()[number];
        for (const ExrLevel level : part.levels) {
            StoredPicture picture = {part.name, level.x, level.y, part.data, part.display, {}, {}, {}};
            if (!values && !picture.is_whole()) continue;
            if (picture.is_whole()) {  // those of the part, once
                picture.attributes = part.header;
                picture.packing = part.packing;
            }
            std::vector<ExrChannel> channels =
                values ? file.read(number, all_channels(part), level, picture.data) : part.channels;
            for (ExrChannel& channel : channels) {
                StoredChannel stored = {channel.name, channel.type, channel.x_sampling, channel.y_sampling, {}};
                if (channel.type == StoredType::uint)
                    stored.values = std::move(channel.numbers);
                else
                    stored.values = std::move(channel.values);
                picture.channels.push_back(std::move(stored));
            }
            result.pictures.push_back(std::move(picture));
        }
    }
    return result;
}

}  // namespace cistula
