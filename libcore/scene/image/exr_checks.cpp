#include "scene/image/exr_checks.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>

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

}  // namespace

void limit_exr_sizes() {
    static const bool once = [] {
        Imf::Header::setMaxImageSize(static_cast<int>(largest_picture_side), static_cast<int>(largest_picture_side));
        Imf::Header::setMaxTileSize(largest_tile_side, largest_tile_side);
        return true;
    }();
    (void)once;
}

void check_claim(const Imf::Header& header, const std::string& path) {
    double packing = 2048;
    if (header.compression() == Imf::NO_COMPRESSION) packing = 1;
    if (header.compression() == Imf::DWAA_COMPRESSION || header.compression() == Imf::DWAB_COMPRESSION)
        packing = 64 * 1032;
    const Imath::Box2i window = header.dataWindow();
    const double width = static_cast<double>(window.max.x) - window.min.x + 1;
    const double height = static_cast<double>(window.max.y) - window.min.y + 1;
    double bytes = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        bytes += width * height * (channel.channel().type == Imf::HALF ? 2 : 4);
    const auto size = static_cast<double>(std::filesystem::file_size(path));
    if (bytes > packing * size)
        throw std::runtime_error("it says that it has " + std::to_string(static_cast<int64_t>(width)) + "x" +
                                 std::to_string(static_cast<int64_t>(height)) +
                                 " pixels, more than its bytes can hold; it is damaged");
}

template <class File>
void check_chunks(File& file) {
    if (!file.isComplete()) throw std::runtime_error("the file is not complete: chunks of pixels are missing");
    if (file.header().hasTileDescription()) return;
    const Imath::Box2i window = file.header().dataWindow();
    const int step = lines_per_chunk(file.header().compression());
    for (int64_t y = window.min.y; y <= window.max.y; y += step) {
        const char* bytes = nullptr;
        int count = 0;
        file.rawPixelData(static_cast<int>(y), bytes, count);
    }
}

template void check_chunks(Imf::InputFile& file);
template void check_chunks(Imf::InputPart& file);

void check_full_sampling(const Imf::Header& header, const std::string& name) {
    const Imf::Channel& channel = header.channels()[name.c_str()];
    if (channel.xSampling != 1 || channel.ySampling != 1)
        throw std::runtime_error("channel " + name + " is subsampled; convert it to one value per pixel");
}

void check_full_sampling(const Imf::Header& header) {
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        check_full_sampling(header, channel.name());
}

ExrAttributes read_attributes(const Imf::Header& header) {
    ExrAttributes attributes;
    for (auto entry = header.begin(); entry != header.end(); ++entry) {
        const std::string name = entry.name();
        // Every file has these.
        if (name == "pixelAspectRatio" || (name == "screenWindowWidth" && header.screenWindowWidth() == 1)) continue;
        const Imf::Attribute& attribute = entry.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
            attributes[name] = text->value();
        } else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
            attributes[name] = whole->value();
        } else if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) {
            attributes[name] = number->value();
        } else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
            attributes[name] = static_cast<double>(single->value());
        } else if (const auto* ratio = dynamic_cast<const Imf::RationalAttribute*>(&attribute)) {
            attributes[name] = Ratio{ratio->value().n, ratio->value().d};
        } else if (const auto* list = dynamic_cast<const Imf::FloatVectorAttribute*>(&attribute)) {
            attributes[name] = std::vector<float>(list->value());
        } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
            const float* first = matrix->value().getValue();
            attributes[name] = std::vector<float>(first, first + 16);
        } else if (const auto* colors = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&attribute)) {
            const Imf::Chromaticities& c = colors->value();
            attributes[name] =
                std::vector<float>{c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y};
        }
    }
    return attributes;
}

}  // namespace cistula
