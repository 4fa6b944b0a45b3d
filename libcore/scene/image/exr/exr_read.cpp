#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <stdexcept>

#include "scene/image/exr/exr.h"
#include "scene/image/exr/exr_attributes.h"
#include "scene/image/exr/exr_checks.h"
#include "scene/image/exr/exr_compression.h"

namespace cistula {
namespace {

/// Throws for whole numbers that floats do not tell apart.
void check_whole_numbers(const LayeredPicture::Channel& channel) {
    const auto is_large = [](float value) { return value >= 0x1p24f; };
    if (std::any_of(channel.values.begin(), channel.values.end(), is_large))
        throw std::runtime_error("channel " + channel.name +
                                 " has whole numbers of 2^24 or more, which are not told apart here");
}

Compression compression_of(Imf::Compression compression) {
    for (const NamedCompression& named : compressions)
        if (named.theirs == compression) return named.ours;
    return Compression::other;
}

LayeredPicture read_part(Imf::MultiPartInputFile& parts, int number, const std::string& path) {
    const Imf::Header& header = parts.header(number);
    check_flat(header, parts.parts() == 1 || !header.hasName() ? "it" : "part " + header.name());
    Imf::InputPart file(parts, number);
    check_sampling(header);
    check_claim(header, path);
    check_chunks(file);
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    LayeredPicture picture;
    picture.width = data.max.x - data.min.x + 1;
    picture.height = data.max.y - data.min.y + 1;
    picture.x = data.min.x - display.min.x;
    picture.y = data.min.y - display.min.y;
    picture.display_width = display.max.x - display.min.x + 1;
    picture.display_height = display.max.y - display.min.y + 1;
    picture.attributes = read_attributes(header);
    picture.compression = compression_of(header.compression());
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

}  // namespace

std::vector<PicturePart> read_exr_parts(const std::string& path) {
    check_readable(path);
    return with_file_errors(path, [&] {
        check_before_opening(path);
        Imf::MultiPartInputFile file(path.c_str());
        std::vector<PicturePart> parts;
        for (int i = 0; i < file.parts(); ++i) {
            const Imf::Header& header = file.header(i);
            parts.push_back({header.hasName() ? header.name() : "", read_part(file, i, path)});
        }
        return parts;
    });
}

LayeredPicture read_exr(const std::string& path) {
    check_readable(path);
    return with_file_errors(path, [&] {
        check_before_opening(path);
        Imf::MultiPartInputFile file(path.c_str());
        if (file.parts() != 1)
            throw std::runtime_error("it has " + std::to_string(file.parts()) + " parts; give a file of one part");
        LayeredPicture picture = read_part(file, 0, path);
        if (file.header(0).hasName()) picture.attributes["name"] = file.header(0).name();
        return picture;
    });
}

bool exr_is_complete(const std::string& path) {
    errno = 0;
    try {
        check_before_opening(path);
        Imf::MultiPartInputFile file(path.c_str());
        for (int i = 0; i < file.parts(); ++i) {
            Imf::InputPart part(file, i);
            check_chunks(part);
            if (part.header().hasTileDescription()) read_part(file, i, path);
        }
        return true;
    } catch (const std::exception&) {
        if (errno == ENOMEM) throw std::bad_alloc();
        return false;
    }
}

}  // namespace cistula
