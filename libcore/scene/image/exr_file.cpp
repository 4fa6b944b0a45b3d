#include "scene/image/exr_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>

#include "scene/image/exr_attributes.h"
#include "scene/image/exr_checks.h"

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

ExrPart part_of(const Imf::Header& header) {
    ExrPart part;
    if (header.hasName()) part.name = header.name();
    check_flat(header, part.name.empty() ? "it" : "part " + part.name);
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    part.width = data.max.x - data.min.x + 1;
    part.height = data.max.y - data.min.y + 1;
    part.full_height = display.max.y - display.min.y + 1;
    part.attributes = read_attributes(header);
    for (auto entry = header.channels().begin(); entry != header.channels().end(); ++entry)
        part.channels.push_back({entry.name(), type_of(entry.channel().type), entry.channel().xSampling == 2, {}, {}});
    return part;
}

/// A slice of a frame buffer; the vector gets the size that the part has. `step`: pixels from a value to the next.
template <class Value>
Imf::Slice slice(Imf::PixelType type, std::vector<Value>& values, const Imath::Box2i& data, int step) {
    const auto width = static_cast<size_t>(data.max.x - data.min.x + 1);
    values.resize(width * static_cast<size_t>(data.max.y - data.min.y + 1));
    const size_t stride = static_cast<size_t>(step) * sizeof(Value);
    return Imf::Slice::Make(type, values.data(), data, stride, stride * width, step, step);
}

/// Gives each pixel of two by two the value of the first.
template <class Value>
void repeat_halved(std::vector<Value>& values, size_t width) {
    for (size_t i = 0; i < values.size(); ++i) {
        const size_t x = i % width, y = i / width;
        values[i] = values[(y - y % 2) * width + (x - x % 2)];
    }
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
        }
    });
}

ExrFile::~ExrFile() = default;

std::vector<ExrChannel> ExrFile::read(size_t part, const std::vector<size_t>& channels) const {
    return with_file_errors(path_, [&] {
        Imf::InputPart input(file_->file, static_cast<int>(part));
        const Imf::Header& header = input.header();
        std::vector<ExrChannel> read;
        for (const size_t channel : channels) {
            read.push_back(parts_[part].channels[channel]);
            check_sampling(read.back().name, header.channels()[read.back().name.c_str()], true);
        }
        check_chunks(input);
        const Imath::Box2i data = header.dataWindow();
        Imf::FrameBuffer buffer;
        for (ExrChannel& channel : read) {
            const int step = header.channels()[channel.name.c_str()].xSampling;  // the same in y
            buffer.insert(channel.name, channel.type == ExrChannel::Type::uint
                                            ? slice(Imf::UINT, channel.numbers, data, step)
                                            : slice(Imf::FLOAT, channel.values, data, step));
        }
        input.setFrameBuffer(buffer);
        input.readPixels(data.min.y, data.max.y);
        for (ExrChannel& channel : read) {
            if (channel.is_halved) repeat_halved(channel.values, static_cast<size_t>(data.max.x - data.min.x + 1));
            if (channel.is_halved) repeat_halved(channel.numbers, static_cast<size_t>(data.max.x - data.min.x + 1));
            channel.values.insert(channel.values.end(), channel.numbers.begin(), channel.numbers.end());
        }
        return read;
    });
}

}  // namespace cistula
