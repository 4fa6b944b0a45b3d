#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <fcntl.h>
#include <unistd.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <optional>
#include <set>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/default_rounding.h"
#include "image/exr/exr.h"
#include "image/exr/exr_checks.h"
#include "image/exr/exr_header.h"
#include "image/exr/exr_zip.h"

namespace cistula {
namespace {

/// A stream that reports write errors, so that a full disk is noticed: OpenEXR's destructor ignores them.
class CheckedStream : public Imf::OStream {
  public:
    /// `descriptor` stays the caller's; `name` is for OpenEXR's messages.
    CheckedStream(int descriptor, const std::string& name, StopSignal stop)
        : Imf::OStream(name.c_str()), file_(open(descriptor)), stop_(stop) {
        if (!file_) error_number_ = errno;
    }
    ~CheckedStream() override { close(); }

    void write(const char bytes[], int count) override {
        if (stop_.is_given()) check_late();
        if (!file_ || std::fwrite(bytes, 1, static_cast<size_t>(count), file_) != static_cast<size_t>(count)) fail();
    }
    uint64_t tellp() override {
        const off_t at = file_ ? ftello(file_) : -1;
        if (at < 0) fail();
        return static_cast<uint64_t>(at);
    }
    void seekp(uint64_t at) override {
        if (!file_ || fseeko(file_, static_cast<off_t>(at), SEEK_SET) != 0) fail();
    }

    void close() {
        if (file_ && std::fclose(file_) != 0) keep(errno);
        file_ = nullptr;
    }
    /// errno of the first failure; 0 if none.
    int error_number() const { return error_number_; }
    /// Whether writing went on for too long after the signal to stop, and was ended.
    bool is_late() const { return is_late_; }

  private:
    using Clock = std::chrono::steady_clock;

    void check_late() {
        if (!stopped_) stopped_ = Clock::now();
        is_late_ = Clock::now() - *stopped_ > std::chrono::milliseconds(500);
        if (is_late_) throw std::runtime_error("interrupted");
    }
    static FILE* open(int descriptor) {
        const int own = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
        FILE* const file = own < 0 ? nullptr : fdopen(own, "wb");
        if (own >= 0 && !file) ::close(own);
        return file;
    }
    void keep(int error_number) {
        if (error_number_ == 0) error_number_ = error_number != 0 ? error_number : EIO;
    }
    [[noreturn]] void fail() {
        keep(errno);
        throw std::runtime_error("cannot write");
    }

    FILE* file_;
    int error_number_ = 0;
    const StopSignal stop_;
    std::optional<Clock::time_point> stopped_;  // when the signal was first seen
    bool is_late_ = false;
};

/// An attribute that every file has, here among the others.
constexpr const char* screen_window_width = "screenWindowWidth";

void check(const LayeredPicture& picture) {
    if (picture.width < 1 || picture.height < 1 || picture.display_width < 1 || picture.display_height < 1)
        throw std::invalid_argument("write_exr: the windows must not be empty");
    if (picture.channels.empty()) throw std::invalid_argument("write_exr: a picture needs a channel");
    const size_t pixels = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
    std::set<std::string> names;
    for (const LayeredPicture::Channel& channel : picture.channels) {
        if (channel.name.empty() || channel.name.size() > 255 || !names.insert(channel.name).second)
            throw std::invalid_argument("write_exr: channel names must differ and have 1 to 255 bytes");
        if (channel.values.size() != (channel.write ? 0 : pixels))
            throw std::invalid_argument("write_exr: channel " + channel.name + " must have width * height values");
    }
    // Attributes of other types under these names make files that readers reject.
    static const std::set<std::string> kept = {"channels",
                                               "chunkCount",
                                               "compression",
                                               "dataWindow",
                                               "displayWindow",
                                               "lineOrder",
                                               "maxSamplesPerPixel",
                                               "name",
                                               "pixelAspectRatio",
                                               "screenWindowCenter",
                                               "tiles",
                                               "type",
                                               "version",
                                               "view"};
    for (const auto& [name, value] : picture.attributes)
        if (name.empty() || name.size() > 255 || kept.count(name) != 0 ||
            (name == screen_window_width && !std::holds_alternative<double>(value)))
            throw std::invalid_argument("write_exr: OpenEXR does not allow the attribute name '" + name + "'");
}

void insert(Imf::Header& header, const std::string& name, const std::vector<float>& values) {
    const char* key = name.c_str();
    if (name == "chromaticities" && values.size() == 8) {
        const auto point = [&](size_t i) { return Imath::V2f(values[2 * i], values[2 * i + 1]); };
        header.insert(key, Imf::ChromaticitiesAttribute(Imf::Chromaticities(point(0), point(1), point(2), point(3))));
    } else if (values.size() == 16) {
        Imath::M44f matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = values[static_cast<size_t>(i)];
        header.insert(key, Imf::M44fAttribute(matrix));
    } else {
        header.insert(key, Imf::FloatVectorAttribute(values));
    }
}

Imf::Compression compression_of(Compression compression) {
    if (compression == Compression::other) throw std::invalid_argument("write_exr: no such compression");
    return compressions[static_cast<size_t>(compression)];
}

Imf::Header header_of(const LayeredPicture& picture) {
    const Imath::Box2i display(Imath::V2i(0, 0), Imath::V2i(picture.display_width - 1, picture.display_height - 1));
    const Imath::Box2i data(Imath::V2i(picture.x, picture.y),
                            Imath::V2i(picture.x + picture.width - 1, picture.y + picture.height - 1));
    Imf::Header header(display, data, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y, compression_of(picture.compression));
    header.dwaCompressionLevel() = picture.dwa_level;
    for (const auto& [name, value] : picture.attributes) {
        if (const auto* text = std::get_if<std::string>(&value))
            header.insert(name.c_str(), Imf::StringAttribute(*text));
        else if (const auto* whole = std::get_if<int>(&value))
            header.insert(name.c_str(), Imf::IntAttribute(*whole));
        else if (const auto* ratio = std::get_if<Ratio>(&value))
            header.insert(name.c_str(), Imf::RationalAttribute(Imf::Rational(ratio->numerator, ratio->denominator)));
        else if (name == screen_window_width)
            header.screenWindowWidth() = static_cast<float>(std::get<double>(value));
        else if (const auto* number = std::get_if<double>(&value))
            header.insert(name.c_str(), Imf::DoubleAttribute(*number));
        else
            insert(header, name, std::get<std::vector<float>>(value));
    }
    for (const LayeredPicture::Channel& channel : picture.channels)
        header.channels().insert(channel.name, Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT));
    return header;
}

/// Lines of a picture, as its file stores them: OpenEXR gets as many at a time, so that no picture need be in memory.
class Lines {
  public:
    explicit Lines(const LayeredPicture& picture) : picture_(picture), of_channels_(picture.channels.size()) {}

    /// The picture's lines from `first` on.
    Imf::FrameBuffer buffer(int first, int count) {
        const auto width = static_cast<size_t>(picture_.width);
        const auto begin = static_cast<size_t>(first) * width;
        const auto end = begin + static_cast<size_t>(count) * width;
        for (size_t i = 0; i < of_channels_.size(); ++i)
            of_channels_[i].resize((end - begin) * (picture_.channels[i].half ? sizeof(half) : sizeof(float)));
        tbb::parallel_for(size_t{0}, (end - begin + block - 1) / block, [&](size_t number) {
            const DefaultRounding rounding;
            const size_t at = begin + number * block;
            write(at, std::min(at + block, end), number * block);
        });
        const int top = picture_.y + first;
        const int left = picture_.x;
        const Imath::Box2i window(Imath::V2i(left, top), Imath::V2i(left + picture_.width - 1, top + count - 1));
        Imf::FrameBuffer buffer;
        for (size_t i = 0; i < of_channels_.size(); ++i) {
            const LayeredPicture::Channel& channel = picture_.channels[i];
            buffer.insert(channel.name,
                          Imf::Slice::Make(channel.half ? Imf::HALF : Imf::FLOAT, of_channels_[i].data(), window));
        }
        return buffer;
    }

  private:
    static constexpr size_t block = 1024;  // pixels: of all channels in turn, while they are still in a cache

    void write(size_t first, size_t last, size_t place) {
        for (size_t i = 0; i < of_channels_.size(); ++i) {
            const LayeredPicture::Channel& channel = picture_.channels[i];
            std::array<float, block> values;
            float* to = channel.half ? values.data() : reinterpret_cast<float*>(of_channels_[i].data()) + place;
            channel.put(first, last, to);
            if (channel.half) std::copy_n(to, last - first, reinterpret_cast<half*>(of_channels_[i].data()) + place);
        }
    }

    const LayeredPicture& picture_;
    std::vector<std::vector<char>> of_channels_;
};

/// A part to be written, where it lies.
struct PartToWrite {
    std::string name;
    const LayeredPicture& picture;
};

bool is_zipped(const PartToWrite& part) {
    return part.picture.compression == Compression::zip || part.picture.compression == Compression::zips;
}

void write_pixels(Imf::OStream& stream, const std::vector<PartToWrite>& parts, int most_threads) {
    std::vector<Imf::Header> headers;
    std::vector<const LayeredPicture*> pictures;
    for (const PartToWrite& part : parts) {
        headers.push_back(header_of(part.picture));
        pictures.push_back(&part.picture);
        if (parts.size() == 1) continue;
        headers.back().setName(part.name);
        headers.back().setType(Imf::SCANLINEIMAGE);
    }
    if (std::all_of(parts.begin(), parts.end(), is_zipped)) return write_zipped(stream, std::move(headers), pictures);
    const int threads = std::min(Imf::globalThreadCount(), most_threads);
    // Whole blocks of lines of every compression, and some for each thread.
    const int most_lines = 256 * std::max(1, threads / 4);
    const auto write = [&](auto& file, const LayeredPicture& picture) {
        Lines lines(picture);
        for (int first = 0; first < picture.height; first += most_lines) {
            const int count = std::min(most_lines, picture.height - first);
            file.setFrameBuffer(lines.buffer(first, count));
            file.writePixels(count);
        }
    };
    if (parts.size() == 1) {
        Imf::OutputFile file(stream, headers.front(), threads);
        return write(file, *pictures.front());
    }
    Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), false, threads);
    for (size_t i = 0; i < parts.size(); ++i) {
        Imf::OutputPart part(file, static_cast<int>(i));
        write(part, *pictures[i]);
    }
}

/// Whether the file is not complete: OpenEXR 3.1 leaves out, without a word, blocks of lines for whose compression it
/// got no memory. False where the system does not let us read what we wrote.
bool lacks_chunks(int descriptor) {
    const std::string name = "/proc/self/fd/" + std::to_string(descriptor);
    return access(name.c_str(), R_OK) == 0 && !exr_is_complete(name);
}

void write_parts(const std::string& path, const std::vector<PartToWrite>& parts, int most_threads, StopSignal stop) {
    if (parts.empty()) throw std::invalid_argument("write_exr: a file needs a part");
    for (const PartToWrite& part : parts) check(part.picture);
    AtomicFile target(path);
    CheckedStream stream(target.descriptor(), path, stop);
    errno = 0;
    try {
        write_pixels(stream, parts, most_threads);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        if (stream.is_late()) stop.check();
        if (lacks_memory(failure)) throw std::bad_alloc();
        if (stream.error_number() == 0) throw file_error(path, "write", std::string(failure.what()));
    }
    const bool lacked_memory = errno == ENOMEM;
    stream.close();
    if (stream.error_number() != 0) throw file_error(path, "write", stream.error_number());
    if (!std::all_of(parts.begin(), parts.end(), is_zipped) && lacks_chunks(target.descriptor())) {
        if (lacked_memory) throw std::bad_alloc();
        throw file_error(path, "write", std::string("OpenEXR left out a part of it; is there enough memory?"));
    }
    target.commit();
}

}  // namespace

void set_exr_threads(int threads) {
    Imf::setGlobalThreadCount(threads);
}

void write_exr(const std::string& path, const LayeredPicture& picture, int most_threads, StopSignal stop) {
    write_parts(path, {{"", picture}}, most_threads, stop);
}

void write_exr(const std::string& path, const std::vector<PicturePart>& parts, int most_threads, StopSignal stop) {
    std::vector<PartToWrite> all;
    for (const PicturePart& part : parts) all.push_back({part.name, part.picture});
    write_parts(path, all, most_threads, stop);
}

}  // namespace cistula
