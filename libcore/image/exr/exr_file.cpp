#include "image/exr/exr_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledInputPart.h>

#include <stdexcept>
#include <type_traits>

#include "image/exr/exr_checks.h"
#include "image/exr/exr_header.h"

namespace cistula {
namespace {

StoredType type_of(Imf::PixelType type) {
    switch (type) {
        case Imf::HALF:
            return StoredType::half;
        case Imf::UINT:
            return StoredType::uint;
        default:
            return StoredType::float_;
    }
}

PixelRect window_of(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

/// Throws for several samples in a pixel; the message calls the part `subject`.
void check_flat(const Imf::Header& header, const std::string& subject) {
    if (header.hasType() && Imf::isDeepData(header.type()))
        throw std::runtime_error(subject + " is deep, with several samples in a pixel; flatten it first");
}

ExrPart part_of(const Imf::Header& header) {
    ExrPart part;
    if (header.hasName()) part.name = header.name();
    check_flat(header, part.name.empty() ? "it" : "part " + part.name);
    const Imath::Box2i& data = header.dataWindow();
    const Imath::Box2i& display = header.displayWindow();
    part.data = window_of(data);
    part.display = window_of(display);
    part.width = part.data.width;
    part.height = part.data.height;
    part.attributes = read_attributes(header);
    part.header = exr_header_values(header);
    part.packing = exr_packing(header);
    part.compression = compression_of(header.compression());
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

/// The chunks of a part of lines.
int64_t chunks_of(const Imf::Header& header) {
    const int64_t lines = int64_t{header.dataWindow().max.y} - header.dataWindow().min.y + 1;
    const int step = lines_per_chunk(header.compression());
    return (lines + step - 1) / step;
}

/// Throws unless every chunk is present. The table of offsets is not enough: it precedes the pixels, so a truncated
/// file has all of it. Returns the bytes of chunks of lines and of their table, in a file of one part. Tiles are
/// checked when their pixels are read.
template <class File>
int64_t check_chunks(File& file) {
    int64_t bytes = 0;
    if (!file.isComplete()) throw std::runtime_error("the file is not complete: chunks of pixels are missing");
    if constexpr (!std::is_same_v<File, Imf::TiledInputPart>) {
        if (file.header().hasTileDescription()) return 0;
        const Imath::Box2i window = file.header().dataWindow();
        const int step = lines_per_chunk(file.header().compression());
        for (int64_t y = window.min.y; y <= window.max.y; y += step) {
            const char* data = nullptr;
            int count = 0;
            file.rawPixelData(static_cast<int>(y), data, count);
            bytes += 16 + count;  // offset, line, size
        }
    }
    return bytes;
}

/// A slice of a frame buffer with a value for `step` bytes. One of a subsampled channel goes to the first of its
/// pixels.
Imf::Slice slice(Imf::PixelType type, void* values, size_t step, const Imath::Box2i& data, const ExrChannel& channel) {
    const size_t x_stride = static_cast<size_t>(channel.x_sampling) * step;
    const size_t line = step * static_cast<size_t>(window_of(data).width);
    return Imf::Slice::Make(type, values, data, x_stride, static_cast<size_t>(channel.y_sampling) * line,
                            channel.x_sampling, channel.y_sampling);
}

/// A buffer for the values of channels, which get the size of the window.
Imf::FrameBuffer buffer_of(std::vector<ExrChannel>& channels, const Imath::Box2i& data) {
    Imf::FrameBuffer buffer;
    for (ExrChannel& channel : channels) {
        const bool is_whole = channel.type == StoredType::uint;
        if (is_whole)
            channel.numbers.resize(window_of(data).pixels());
        else
            channel.values.resize(window_of(data).pixels());
        buffer.insert(channel.name, is_whole ? slice(Imf::UINT, channel.numbers.data(), 4, data, channel)
                                             : slice(Imf::FLOAT, channel.values.data(), 4, data, channel));
    }
    return buffer;
}

/// Gives each pixel that shares a value with others that of the first.
template <class Value>
void repeat_values(std::vector<Value>& values, size_t width, const ExrChannel& channel) {
    const auto x_step = static_cast<size_t>(channel.x_sampling);
    const auto y_step = static_cast<size_t>(channel.y_sampling);
    if (x_step == 1 && y_step == 1) return;
    for (size_t i = 0; i < values.size(); ++i) {
        const size_t x = i % width;
        const size_t y = i / width;
        values[i] = values[(y - y % y_step) * width + (x - x % x_step)];
    }
}

/// Reads a level of a part into the frame buffer that `buffer` makes for its data window; returns that.
template <class MakeBuffer>
Imath::Box2i read_level(Imf::MultiPartInputFile& file, int part, ExrLevel level, MakeBuffer buffer) {
    if (!has_levels(file.header(part))) {
        Imf::InputPart input(file, part);
        check_chunks(input);
        Imath::Box2i data = input.header().dataWindow();
        input.setFrameBuffer(buffer(data));
        input.readPixels(data.min.y, data.max.y);
        return data;
    }
    Imf::TiledInputPart input(file, part);
    check_chunks(input);
    Imath::Box2i data = input.dataWindowForLevel(level.x, level.y);
    input.setFrameBuffer(buffer(data));
    input.readTiles(0, input.numXTiles(level.x) - 1, 0, input.numYTiles(level.y) - 1, level.x, level.y);
    return data;
}

}  // namespace

struct ExrFile::Open {
    explicit Open(const std::string& path) : file(path.c_str()) {}

    Imf::MultiPartInputFile file;
};

ExrFile::ExrFile(const std::string& path, const SizeProblem& size_problem) : path_(path) {
    check_readable(path);
    with_file_errors(path, [&] {
        headers_ = check_before_opening(path);
        file_ = std::make_unique<Open>(path);
        for (int i = 0; i < file_->file.parts(); ++i) {
            parts_.push_back(part_of(file_->file.header(i)));
            if (size_problem && i == 0)
                if (const std::string problem = size_problem(parts_[0].data.width, parts_[0].data.height);
                    !problem.empty())
                    throw std::runtime_error(problem);
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
        window = window_of(read_level(file_->file, static_cast<int>(part), level,
                                      [&](const Imath::Box2i& data) { return buffer_of(read, data); }));
        for (ExrChannel& channel : read) {
            repeat_values(channel.values, static_cast<size_t>(window.width), channel);
            repeat_values(channel.numbers, static_cast<size_t>(window.width), channel);
            channel.values.insert(channel.values.end(), channel.numbers.begin(), channel.numbers.end());
        }
        return read;
    });
}

ColorPicture ExrFile::read_colors(size_t part, const std::vector<size_t>& channels) const {
    return with_file_errors(path_, [&] {
        ColorPicture picture;
        read_level(file_->file, static_cast<int>(part), {}, [&](const Imath::Box2i& data) {
            picture.width = static_cast<uint32_t>(window_of(data).width);
            picture.height = static_cast<uint32_t>(window_of(data).height);
            picture.texels.resize(window_of(data).pixels());
            Imf::FrameBuffer buffer;
            for (size_t c = 0; c < channels.size(); ++c) {
                const ExrChannel& channel = parts_[part].channels[channels[c]];
                float* const first = &picture.texels[0][static_cast<int>(c)];
                buffer.insert(channel.name, slice(Imf::FLOAT, first, sizeof(glm::vec3), data, channel));
            }
            return buffer;
        });
        return picture;
    });
}

bool ExrFile::is_complete() const {
    int64_t end = headers_;
    bool has_tiles = false;
    for (size_t part = 0; part < parts_.size(); ++part) {
        const int number = static_cast<int>(part);
        if (file_->file.header(number).hasTileDescription()) {
            has_tiles = true;
            for (size_t channel = 0; channel < parts_[part].channels.size(); ++channel) read(part, {channel});
            continue;
        }
        with_file_errors(path_, [&] {
            Imf::InputPart input(file_->file, number);
            end += check_chunks(input);
            if (parts_.size() > 1) end += 4 * chunks_of(input.header());  // each with the number of its part
        });
    }
    return has_tiles || end == static_cast<int64_t>(regular_file_size(path_));
}

}  // namespace cistula
