#include "scene/image/exr/exr_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfTiledInputPart.h>

#include <numeric>
#include <utility>

#include "scene/image/exr/exr_attributes.h"
#include "scene/image/exr/exr_checks.h"
#include "scene/image/exr/exr_header_values.h"

namespace cistula {
namespace {

ExrChannel::Type type_of(Imf::PixelType type) {
    switch (type) {
        case Imf::HALF:
            return ExrChannel::Type::half;
        case Imf::UINT:
            return ExrChannel::Type::uint;
        default:
            return ExrChannel::Type::float_;
    }
}

PixelRect window_of(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

ExrPart part_of(const Imf::Header& header) {
    ExrPart part;
    if (header.hasName()) part.name = header.name();
    check_flat(header, part.name.empty() ? "it" : "part " + part.name);
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    part.data = window_of(data);
    part.display = window_of(display);
    part.width = part.data.width;
    part.height = part.data.height;
    part.full_height = part.display.height;
    part.attributes = read_attributes(header);
    part.header = exr_header_values(header);
    part.packing = exr_packing(header);
    for (auto entry = header.channels().begin(); entry != header.channels().end(); ++entry)
        part.channels.push_back({entry.name(),
                                 type_of(entry.channel().type),
                                 entry.channel().xSampling,
                                 entry.channel().ySampling,
                                 {},
                                 {}});
    return part;
}

/// Whether a part is opened as an Imf::TiledInputPart; any other, tiled or not, is as an Imf::InputPart. The library
/// crashes where one part is opened as both.
bool has_levels(const Imf::Header& header) {
    return header.hasTileDescription() && header.tileDescription().mode != Imf::ONE_LEVEL;
}

/// The levels of a part, the whole resolution first.
std::vector<ExrLevel> levels_of(Imf::MultiPartInputFile& file, int part) {
    if (!has_levels(file.header(part))) return {{}};
    const Imf::TiledInputPart tiles(file, part);
    std::vector<ExrLevel> levels;
    for (int y = 0; y < tiles.numYLevels(); ++y)
        for (int x = 0; x < tiles.numXLevels(); ++x)
            if (tiles.isValidLevel(x, y)) levels.push_back({x, y});
    return levels;
}

/// A slice of a frame buffer; the vector gets the size of the window. A value of a subsampled channel goes to the first
/// of its pixels.
template <class Value>
Imf::Slice slice(Imf::PixelType type, std::vector<Value>& values, const Imath::Box2i& data, const ExrChannel& channel) {
    const PixelRect window = window_of(data);
    values.resize(window.pixels());
    const size_t x_stride = static_cast<size_t>(channel.x_sampling) * sizeof(Value);
    const size_t y_stride = static_cast<size_t>(channel.y_sampling) * sizeof(Value) * static_cast<size_t>(window.width);
    return Imf::Slice::Make(type, values.data(), data, x_stride, y_stride, channel.x_sampling, channel.y_sampling);
}

Imf::FrameBuffer buffer_of(std::vector<ExrChannel>& channels, const Imath::Box2i& data) {
    Imf::FrameBuffer buffer;
    for (ExrChannel& channel : channels)
        buffer.insert(channel.name, channel.type == ExrChannel::Type::uint
                                        ? slice(Imf::UINT, channel.numbers, data, channel)
                                        : slice(Imf::FLOAT, channel.values, data, channel));
    return buffer;
}

/// Gives each pixel that shares a value with others that of the first.
template <class Value>
void repeat_values(std::vector<Value>& values, size_t width, const ExrChannel& channel) {
    const auto x_step = static_cast<size_t>(channel.x_sampling), y_step = static_cast<size_t>(channel.y_sampling);
    if (x_step == 1 && y_step == 1) return;
    for (size_t i = 0; i < values.size(); ++i) {
        const size_t x = i % width, y = i / width;
        values[i] = values[(y - y % y_step) * width + (x - x % x_step)];
    }
}

/// Reads channels of a part without levels into these; returns the data window.
Imath::Box2i read_pixels(Imf::MultiPartInputFile& file, int part, std::vector<ExrChannel>& channels) {
    Imf::InputPart input(file, part);
    check_chunks(input);
    const Imath::Box2i data = input.header().dataWindow();
    input.setFrameBuffer(buffer_of(channels, data));
    input.readPixels(data.min.y, data.max.y);
    return data;
}

Imath::Box2i read_level(Imf::MultiPartInputFile& file, int part, ExrLevel level, std::vector<ExrChannel>& channels) {
    Imf::TiledInputPart input(file, part);
    check_chunks(input);
    const Imath::Box2i data = input.dataWindowForLevel(level.x, level.y);
    input.setFrameBuffer(buffer_of(channels, data));
    input.readTiles(0, input.numXTiles(level.x) - 1, 0, input.numYTiles(level.y) - 1, level.x, level.y);
    return data;
}

}  // namespace

struct ExrFile::Open {
    explicit Open(const std::string& path) : file(path.c_str()) {}

    Imf::MultiPartInputFile file;
};

ExrFile::ExrFile(const std::string& path) : path_(path) {
    check_readable(path);
    with_file_errors(path, [&] {
        check_before_opening(path);
        file_ = std::make_unique<Open>(path);
        for (int i = 0; i < file_->file.parts(); ++i) {
            parts_.push_back(part_of(file_->file.header(i)));
            check_claim(file_->file.header(i), path);
            parts_.back().levels = levels_of(file_->file, i);
        }
    });
}

ExrFile::~ExrFile() = default;

std::vector<ExrChannel> ExrFile::read(size_t part, const std::vector<size_t>& channels) const {
    PixelRect window;
    return read(part, channels, {}, window);
}

std::vector<ExrChannel> ExrFile::read(size_t part, const std::vector<size_t>& channels, ExrLevel level,
                                      PixelRect& window) const {
    return with_file_errors(path_, [&] {
        std::vector<ExrChannel> read;
        for (const size_t channel : channels) read.push_back(parts_[part].channels[channel]);
        const int number = static_cast<int>(part);
        window = window_of(has_levels(file_->file.header(number)) ? read_level(file_->file, number, level, read)
                                                                  : read_pixels(file_->file, number, read));
        for (ExrChannel& channel : read) {
            repeat_values(channel.values, static_cast<size_t>(window.width), channel);
            repeat_values(channel.numbers, static_cast<size_t>(window.width), channel);
            channel.values.insert(channel.values.end(), channel.numbers.begin(), channel.numbers.end());
        }
        return read;
    });
}

StoredFile read_stored_exr(const std::string& path) {
    const ExrFile file(path);
    StoredFile result;
    result.format = "openexr";
    for (size_t number = 0; number < file.parts().size(); ++number) {
        const ExrPart& part = file.parts()[number];
        std::vector<size_t> channels(part.channels.size());
        std::iota(channels.begin(), channels.end(), size_t{0});
        for (const ExrLevel level : part.levels) {
            StoredPicture picture = {part.name, level.x, level.y, {}, part.display, {}, {}, {}};
            if (picture.is_whole()) {  // those of the part, once
                picture.attributes = part.header;
                picture.packing = part.packing;
            }
            for (ExrChannel& channel : file.read(number, channels, level, picture.data)) {
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
