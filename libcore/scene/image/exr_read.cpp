#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "scene/base/file_bytes.h"
#include "scene/image/exr.h"

namespace cistula {
namespace {

constexpr int largest_tile_side = 8192;  // the library holds a whole tile in memory, as its header says

/// Runs `read`; the library's exceptions become an Error that names the file, or std::bad_alloc.
template <class Read>
auto with_file_errors(const std::string& path, Read read) {
    errno = 0;
    try {
        return read();
    } catch (const Error&) {
        if (errno == ENOMEM) throw std::bad_alloc();  // the library takes what it could not read for missing
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        if (errno == ENOMEM) throw std::bad_alloc();
        throw file_error(path, "read", std::string(failure.what()));
    }
}

/// Limits picture sizes before the library opens a file, so that a damaged header cannot make it allocate huge arrays.
void limit_sizes() {
    static const bool once = [] {
        Imf::Header::setMaxImageSize(static_cast<int>(largest_picture_side), static_cast<int>(largest_picture_side));
        Imf::Header::setMaxTileSize(largest_tile_side, largest_tile_side);
        return true;
    }();
    (void)once;
}

/// Throws for a header that says more pixels than a file of its size can hold, before memory is taken for them. Deflate
/// packs 1,032 to 1 at most, RLE and PIZ less; DWA does so after it took one value in 64.
void check_claim(const Imf::InputFile& file, const std::string& path) {
    const Imf::Header& header = file.header();
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

/// Throws unless every chunk is present. The table of offsets is not enough: it precedes the pixels, so a truncated
/// file has all of it. Tiles are checked when their pixels are read.
void check_chunks(Imf::InputFile& file) {
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

void check_full_sampling(const Imf::InputFile& file) {
    const Imf::ChannelList& channels = file.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
            throw std::runtime_error(std::string("channel ") + channel.name() +
                                     " is subsampled; convert it to one value per pixel");
}

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

void read_attributes(const Imf::Header& header, LayeredPicture& picture) {
    for (auto entry = header.begin(); entry != header.end(); ++entry) {
        const std::string name = entry.name();
        // Every file has these.
        if (name == "pixelAspectRatio" || (name == "screenWindowWidth" && header.screenWindowWidth() == 1)) continue;
        const Imf::Attribute& attribute = entry.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
            picture.attributes[name] = text->value();
        } else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
            picture.attributes[name] = whole->value();
        } else if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) {
            picture.attributes[name] = number->value();
        } else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
            picture.attributes[name] = static_cast<double>(single->value());
        } else if (const auto* ratio = dynamic_cast<const Imf::RationalAttribute*>(&attribute)) {
            picture.attributes[name] = Ratio{ratio->value().n, ratio->value().d};
        } else if (const auto* list = dynamic_cast<const Imf::FloatVectorAttribute*>(&attribute)) {
            picture.attributes[name] = std::vector<float>(list->value());
        } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
            const float* first = matrix->value().getValue();
            picture.attributes[name] = std::vector<float>(first, first + 16);
        } else if (const auto* colors = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&attribute)) {
            const Imf::Chromaticities& c = colors->value();
            picture.attributes[name] =
                std::vector<float>{c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y};
        }
    }
}

LayeredPicture read_layers(const std::string& path) {
    check_single_and_flat(path);
    Imf::InputFile file(path.c_str());
    check_full_sampling(file);
    check_claim(file, path);
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
    read_attributes(header, picture);
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
    check_full_sampling(file);
    check_claim(file, path);
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
    limit_sizes();
    check_readable(path);
    return with_file_errors(path, [&] { return read_layers(path); });
}

bool exr_is_complete(const std::string& path) {
    limit_sizes();
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
    limit_sizes();
    check_readable(path);
    return with_file_errors(path, [&] { return read_colors(path, size_problem); });
}

}  // namespace cistula
