// Textures from OpenEXR files.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <stdexcept>
#include <vector>

#include "scene/image/color/file_colors.h"
#include "scene/image/exr/exr.h"
#include "scene/image/exr/exr_checks.h"
#include "scene/image/exr/exr_chroma.h"

namespace cistula {
namespace {

/// The channels that a texture is made of: three, or one of gray.
std::vector<const char*> color_channels(const Imf::ChannelList& channels) {
    const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
    if (has("R") && has("G") && has("B")) return {"R", "G", "B"};
    std::string present;
    size_t count = 0;
    for (auto entry = channels.begin(); entry != channels.end(); ++entry, ++count)
        present += (count == 0 ? "" : ", ") + std::string(entry.name());
    if (count == 1) return {channels.begin().name()};
    // With X and Z, Y is a coordinate.
    if (has("Y") && !has("R") && !has("G") && !has("B") && !has("X") && has("RY") == has("BY"))
        return has("RY") ? std::vector{"RY", "Y", "BY"} : std::vector{"Y"};
    throw std::runtime_error(
        "a texture has the channels R, G and B, or Y, or Y, RY and BY, or a single one; this file has " + present);
}

/// An attribute, or null if there is none. Throws if it is of another type.
template <class Type>
const Type* attribute(const Imf::Header& header, const char* name) {
    const auto found = header.find(name);
    if (found == header.end()) return nullptr;
    if (const auto* typed = dynamic_cast<const Type*>(&found.attribute())) return typed;
    throw std::runtime_error(std::string("its attribute ") + name + " is of the type " + found.attribute().typeName() +
                             "; it must be of the type " + Type::staticTypeName());
}

FileColors colors_of(const Imf::Header& header) {
    FileColors colors;
    if (const auto* id = attribute<Imf::StringAttribute>(header, "colorInteropID")) colors.id = id->value();
    if (const auto* given = attribute<Imf::ChromaticitiesAttribute>(header, "chromaticities")) {
        const Imf::Chromaticities& c = given->value();
        colors.chromaticities = {c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y};
    }
    const auto* aces = attribute<Imf::IntAttribute>(header, "acesImageContainerFlag");
    colors.is_aces = aces && aces->value() == 1;
    return colors;
}

ColorPicture read_colors(const std::string& path, const SizeProblem& size_problem, FileColors& colors) {
    check_before_opening(path);
    check_flat(Imf::MultiPartInputFile(path.c_str()).header(0));
    Imf::InputFile file(path.c_str());
    const Imf::Header& header = file.header();
    const Imath::Box2i data = header.dataWindow();
    const auto side = [](int low, int high) { return static_cast<int64_t>(high) - low + 1; };
    if (size_problem) {
        const std::string problem = size_problem(side(data.min.x, data.max.x), side(data.min.y, data.max.y));
        if (!problem.empty()) throw std::runtime_error(problem);
    }
    const std::vector<const char*> names = color_channels(header.channels());
    const bool is_chroma = names.size() == 3 && names[0] == std::string_view("RY");
    check_sampling(file.header(), is_chroma);
    check_claim(file.header(), path);
    check_chunks(file);
    colors = colors_of(header);

    ColorPicture picture;
    picture.width = static_cast<uint32_t>(side(data.min.x, data.max.x));
    picture.height = static_cast<uint32_t>(side(data.min.y, data.max.y));
    picture.texels.resize(static_cast<size_t>(picture.width) * picture.height);
    Imf::FrameBuffer buffer;
    bool is_halved[3] = {};
    for (size_t c = 0; c < names.size(); ++c) {
        const Imf::Channel& channel = header.channels()[names[c]];
        if (channel.type == Imf::HALF) colors.is_half = true;
        const int step = channel.xSampling;  // the same in y
        is_halved[c] = step == 2;
        const size_t stride = static_cast<size_t>(step) * sizeof(glm::vec3);
        buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, &picture.texels[0][static_cast<int>(c)], data, stride,
                                                 stride * picture.width, step, step));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(data.min.y, data.max.y);
    if (names.size() == 1)
        for (glm::vec3& texel : picture.texels) texel = glm::vec3(texel[0]);
    if (is_chroma) {
        const ColorSpace space =
            colors.chromaticities ? color_space_of(*colors.chromaticities) : color_spaces().front();
        colors_from_chroma(picture, is_halved, luminance_weights(space));
    }
    return picture;
}

}  // namespace

ColorPicture read_exr_texture(const std::string& path, const SizeProblem& size_problem, FileColors* colors) {
    check_readable(path);
    FileColors own;
    return with_file_errors(path, [&] { return read_colors(path, size_problem, colors ? *colors : own); });
}

}  // namespace cistula
