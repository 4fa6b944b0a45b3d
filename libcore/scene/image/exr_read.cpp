#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <new>
#include <stdexcept>

#include "scene/base/file_bytes.h"
#include "scene/image/exr.h"
#include "scene/image/exr_checks.h"

namespace cistula {
namespace {

/// Throws for what a LayeredPicture does not hold: further parts, and several samples in a pixel.
void check_single_and_flat(const std::string& path) {
    const Imf::MultiPartInputFile file(path.c_str());
    if (file.parts() != 1)
        throw std::runtime_error("it has " + std::to_string(file.parts()) + " parts; give a file of one part");
    const Imf::Header& header = file.header(0);
    if (header.hasType() && Imf::isDeepData(header.type()))
        throw std::runtime_error("it is deep, with several samples in a pixel; flatten it first");
}

/// Throws for whole numbers that floats do not tell apart.
void check_whole_numbers(const LayeredPicture::Channel& channel) {
    const auto is_large = [](float value) { return value >= 0x1p24f; };
    if (std::any_of(channel.values.begin(), channel.values.end(), is_large))
        throw std::runtime_error("channel " + channel.name +
                                 " has whole numbers of 2^24 or more, which are not told apart here");
}

LayeredPicture read_layers(const std::string& path) {
    check_single_and_flat(path);
    Imf::InputFile file(path.c_str());
    check_full_sampling(file.header());
    check_claim(file.header(), path);
    check_chunks(file);
    const Imf::Header& header = file.header();
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    LayeredPicture picture;
    picture.width = data.max.x - data.min.x + 1;
    picture.height = data.max.y - data.min.y + 1;
    picture.x = data.min.x - display.min.x;
    picture.y = data.min.y - display.min.y;
    picture.display_width = display.max.x - display.min.x + 1;
    picture.display_height = display.max.y - display.min.y + 1;
    picture.attributes = read_attributes(header);
    for (auto entry = header.channels().begin(); entry != header.channels().end(); ++entry)
        picture.channels.push_back({entry.name(), entry.channel().type == Imf::HALF, {}});
    Imf::FrameBuffer buffer;
    for (LayeredPicture::Channel& channel : picture.channels) {
        channel.values.resize(static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height));
        buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), data));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(data.min.y, data.max.y);
    for (const LayeredPicture::Channel& channel : picture.channels)
        if (header.channels()[channel.name.c_str()].type == Imf::UINT) check_whole_numbers(channel);
    return picture;
}

ColorPicture read_colors(const std::string& path, const SizeProblem& size_problem) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i data = file.header().dataWindow();
    const auto side = [](int low, int high) { return static_cast<int64_t>(high) - low + 1; };
    if (size_problem) {
        const std::string problem = size_problem(side(data.min.x, data.max.x), side(data.min.y, data.max.y));
        if (!problem.empty()) throw std::runtime_error(problem);
    }
    const Imf::ChannelList& channels = file.header().channels();
    const bool gray = !channels.findChannel("R") && !channels.findChannel("G") && !channels.findChannel("B");
    std::string present;
    for (auto entry = channels.begin(); entry != channels.end(); ++entry)
        present += (present.empty() ? "" : ", ") + std::string(entry.name());
    if (gray ? !channels.findChannel("Y")
             : !channels.findChannel("R") || !channels.findChannel("G") || !channels.findChannel("B"))
        throw std::runtime_error("a texture has the channels R, G and B, or Y; this file has " + present);
    if (gray && (channels.findChannel("RY") || channels.findChannel("BY")))
        throw std::runtime_error("its colors are stored as luminance and chroma (Y, RY, BY); convert it to R, G and B");
    check_full_sampling(file.header());
    check_claim(file.header(), path);
    check_chunks(file);

    ColorPicture picture;
    picture.width = static_cast<uint32_t>(data.max.x - data.min.x + 1);
    picture.height = static_cast<uint32_t>(data.max.y - data.min.y + 1);
    picture.texels.resize(static_cast<size_t>(picture.width) * picture.height);
    Imf::FrameBuffer buffer;
    const char* names[3] = {"R", "G", "B"};
    for (int c = 0; c < (gray ? 1 : 3); ++c)
        buffer.insert(gray ? "Y" : names[c],
                      Imf::Slice::Make(Imf::FLOAT, &picture.texels[0][c], data, sizeof(glm::vec3)));
    file.setFrameBuffer(buffer);
    file.readPixels(data.min.y, data.max.y);
    if (gray)
        for (glm::vec3& texel : picture.texels) texel = glm::vec3(texel[0]);
    return picture;
}

}  // namespace

LayeredPicture read_exr(const std::string& path) {
    limit_exr_sizes();
    check_readable(path);
    return with_file_errors(path, [&] { return read_layers(path); });
}

bool exr_is_complete(const std::string& path) {
    limit_exr_sizes();
    errno = 0;
    try {
        Imf::InputFile file(path.c_str());
        check_chunks(file);
        if (file.header().hasTileDescription()) read_layers(path);
        return true;
    } catch (const std::exception&) {
        if (errno == ENOMEM) throw std::bad_alloc();
        return false;
    }
}

ColorPicture read_exr_texture(const std::string& path, const SizeProblem& size_problem) {
    limit_exr_sizes();
    check_readable(path);
    return with_file_errors(path, [&] { return read_colors(path, size_problem); });
}

}  // namespace cistula
