#include "scene/image/exr/exr_checks.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledInputPart.h>

#include <filesystem>
#include <stdexcept>
#include <type_traits>

#include "scene/image/exr/exr_header.h"

namespace cistula {
namespace {

constexpr int largest_tile_side = 8192;  // the library holds a whole tile in memory, as its header says

int lines_per_chunk(Imf::Compression compression) {
    switch (compression) {
        case Imf::NO_COMPRESSION:
        case Imf::RLE_COMPRESSION:
        case Imf::ZIPS_COMPRESSION:
            return 1;
        case Imf::ZIP_COMPRESSION:
        case Imf::PXR24_COMPRESSION:
            return 16;
        case Imf::PIZ_COMPRESSION:
        case Imf::B44_COMPRESSION:
        case Imf::B44A_COMPRESSION:
        case Imf::DWAA_COMPRESSION:
            return 32;
        case Imf::DWAB_COMPRESSION:
            return 256;
        default:
            return 1;
    }
}

void limit_sizes() {
    static const bool once = [] {
        Imf::Header::setMaxImageSize(static_cast<int>(largest_picture_side), static_cast<int>(largest_picture_side));
        Imf::Header::setMaxTileSize(largest_tile_side, largest_tile_side);
        return true;
    }();
    (void)once;
}

}  // namespace

void check_before_opening(const std::string& path) {
    limit_sizes();
    check_exr_header(path);
}

void check_claim(const Imf::Header& header, const std::string& path) {
    // Deflate packs 1,032 to 1 at most, RLE and PIZ less; DWA does so after it took one value in 64.
    double packing = 2048;
    if (header.compression() == Imf::NO_COMPRESSION) packing = 1;
    if (header.compression() == Imf::DWAA_COMPRESSION || header.compression() == Imf::DWAB_COMPRESSION)
        packing = 64 * 1032;
    const Imath::Box2i window = header.dataWindow();
    const double width = static_cast<double>(window.max.x) - window.min.x + 1;
    const double height = static_cast<double>(window.max.y) - window.min.y + 1;
    double bytes = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        bytes += width * height * (channel.channel().type == Imf::HALF ? 2 : 4) /
                 (static_cast<double>(channel.channel().xSampling) * channel.channel().ySampling);
    const auto size = static_cast<double>(std::filesystem::file_size(path));
    if (bytes > packing * size)
        throw std::runtime_error("it says that it has " + std::to_string(static_cast<int64_t>(width)) + "x" +
                                 std::to_string(static_cast<int64_t>(height)) +
                                 " pixels, more than its bytes can hold; it is damaged");
}

template <class File>
void check_chunks(File& file) {
    if (!file.isComplete()) throw std::runtime_error("the file is not complete: chunks of pixels are missing");
    if constexpr (!std::is_same_v<File, Imf::TiledInputPart>) {
        if (file.header().hasTileDescription()) return;
        const Imath::Box2i window = file.header().dataWindow();
        const int step = lines_per_chunk(file.header().compression());
        for (int64_t y = window.min.y; y <= window.max.y; y += step) {
            const char* bytes = nullptr;
            int count = 0;
            file.rawPixelData(static_cast<int>(y), bytes, count);
        }
    }
}

template void check_chunks(Imf::InputFile& file);
template void check_chunks(Imf::InputPart& file);
template void check_chunks(Imf::TiledInputPart& file);

void check_sampling(const Imf::Header& header, bool is_chroma) {
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const std::string name = channel.name();
        check_sampling(name, channel.channel(), is_chroma && (name == "RY" || name == "BY"));
    }
}

void check_sampling(const std::string& name, const Imf::Channel& channel, bool may_be_halved) {
    const int x = channel.xSampling, y = channel.ySampling;
    if ((x != 1 || y != 1) && !(may_be_halved && x == 2 && y == 2))
        throw std::runtime_error("channel " + name + " is subsampled; convert it to one value per pixel" +
                                 (may_be_halved ? ", or one for two by two" : ""));
}

void check_flat(const Imf::Header& header, const std::string& subject) {
    if (header.hasType() && Imf::isDeepData(header.type()))
        throw std::runtime_error(subject + " is deep, with several samples in a pixel; flatten it first");
}

}  // namespace cistula
