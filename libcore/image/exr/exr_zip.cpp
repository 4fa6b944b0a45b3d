#include "image/exr/exr_zip.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfVersion.h>
#include <libdeflate.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>

#include "base/default_rounding.h"

namespace cistula {
namespace {

constexpr int level = 1;  // docs/decisions/0039-quick-zip.md

/// A part as its chunks are made: blocks of lines, in a line the channels by their names.
struct PartLines {
    const LayeredPicture& picture;
    std::vector<const LayeredPicture::Channel*> channels;
    int lines = 0, chunks = 0;  // of a chunk; of the part
    size_t line_words = 0;      // words of 16 bits in a line

    explicit PartLines(const LayeredPicture& of) : picture(of), lines(of.compression == Compression::zips ? 1 : 16) {
        chunks = (of.height + lines - 1) / lines;
        for (const LayeredPicture::Channel& channel : of.channels) {
            channels.push_back(&channel);
            line_words += static_cast<size_t>(of.width) * (channel.half ? 1 : 2);
        }
        std::sort(channels.begin(), channels.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
    }
};

/// What a thread packs chunks with.
class ChunkPacker {
  public:
    /// The bytes of a chunk that begins at a line of the picture: compressed, or as they are where that is not smaller.
    std::string_view pack(const PartLines& part, int first) {
        const int count = std::min(part.lines, part.picture.height - first);
        words_.resize(part.line_words * static_cast<size_t>(count));
        uint16_t* to = words_.data();
        for (int y = first; y < first + count; ++y)
            for (const LayeredPicture::Channel* channel : part.channels) to = put_line(*channel, part.picture, y, to);
        const size_t bytes = 2 * words_.size();
        predict();
        packed_.resize(bytes);
        const size_t packed =
            libdeflate_zlib_compress(compressor_.get(), predicted_.data(), bytes, packed_.data(), bytes - 1);
        if (packed != 0) return {packed_.data(), packed};
        return {reinterpret_cast<const char*>(words_.data()), bytes};
    }

  private:
    struct Free {
        void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
    };
    using Compressor = std::unique_ptr<libdeflate_compressor, Free>;

    static Compressor compressor() {
        Compressor made(libdeflate_alloc_compressor(level));
        if (!made) throw std::bad_alloc();
        return made;
    }

    uint16_t* put_line(const LayeredPicture::Channel& channel, const LayeredPicture& picture, int y, uint16_t* to) {
        const auto width = static_cast<size_t>(picture.width);
        const auto first = static_cast<size_t>(y) * width;
        line_.resize(width);
        channel.put(first, first + width, line_.data());
        if (channel.half) {
            for (size_t x = 0; x < width; ++x) to[x] = half(line_[x]).bits();
            return to + width;
        }
        std::memcpy(to, line_.data(), width * sizeof(float));
        return to + 2 * width;
    }

    /// All low bytes of the words and then all high ones, of each the difference from the byte before it, plus 128.
    void predict() {
        const size_t count = words_.size();
        predicted_.resize(2 * count);
        const uint16_t* from = words_.data();
        uint8_t *low = predicted_.data(), *high = low + count;
        low[0] = static_cast<uint8_t>(from[0]);
        high[0] = static_cast<uint8_t>((from[0] >> 8) - from[count - 1] + 128);
        for (size_t i = 1; i < count; ++i) {
            low[i] = static_cast<uint8_t>(from[i] - from[i - 1] + 128);
            high[i] = static_cast<uint8_t>((from[i] >> 8) - (from[i - 1] >> 8) + 128);
        }
    }

    Compressor compressor_ = compressor();
    std::vector<float> line_;
    std::vector<uint16_t> words_;
    std::vector<uint8_t> predicted_;
    std::vector<char> packed_;
};

template <class Number>
void append(std::vector<char>& bytes, Number number) {
    const auto* from = reinterpret_cast<const char*>(&number);
    bytes.insert(bytes.end(), from, from + sizeof number);
}

void write(Imf::OStream& stream, const std::vector<char>& bytes) {
    stream.write(bytes.data(), static_cast<int>(bytes.size()));
}

bool has_long_names(const Imf::Header& header) {
    const auto is_long = [](const char* name) { return std::strlen(name) > 31; };
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
        if (is_long(attribute.name())) return true;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        if (is_long(channel.name())) return true;
    return false;
}

void write_headers(Imf::OStream& stream, const std::vector<Imf::Header>& headers) {
    const bool several = headers.size() > 1;
    int version = Imf::EXR_VERSION | (several ? Imf::MULTI_PART_FILE_FLAG : 0);
    if (std::any_of(headers.begin(), headers.end(), has_long_names)) version |= Imf::LONG_NAMES_FLAG;
    std::vector<char> begin;
    append(begin, Imf::MAGIC);
    append(begin, version);
    write(stream, begin);
    for (const Imf::Header& header : headers) {
        header.sanityCheck(false, several);
        header.writeTo(stream);
    }
    if (several) write(stream, {0});
}

}  // namespace

void write_zipped(Imf::OStream& stream, std::vector<Imf::Header> headers,
                  const std::vector<const LayeredPicture*>& pictures) {
    std::vector<PartLines> parts;
    std::vector<char> offsets;  // of all chunks in the file
    for (size_t i = 0; i < pictures.size(); ++i) {
        parts.emplace_back(*pictures[i]);
        if (pictures.size() > 1) headers[i].setChunkCount(parts.back().chunks);
        offsets.resize(offsets.size() + static_cast<size_t>(parts.back().chunks) * sizeof(uint64_t));
    }
    write_headers(stream, headers);
    const uint64_t table = stream.tellp();
    write(stream, offsets);  // takes their place
    uint64_t offset = table + offsets.size();
    offsets.clear();

    struct Chunk {
        size_t part = 0;
        int number = 0;
        std::vector<char> bytes;
    };
    // Those under way, in a ring: a pipeline that ends by an exception leaves what it passes on, so that it is
    // pointers.
    std::vector<Chunk> chunks(2 * static_cast<size_t>(tbb::this_task_arena::max_concurrency()));
    size_t taken = 0, part_taken = 0;
    int number = 0;
    const auto take = [&](tbb::flow_control& control) -> Chunk* {
        if (number == parts[part_taken].chunks) ++part_taken, number = 0;
        if (part_taken == parts.size()) {
            control.stop();
            return nullptr;
        }
        Chunk& chunk = chunks[taken++ % chunks.size()];
        chunk.part = part_taken;
        chunk.number = number++;
        return &chunk;
    };
    tbb::enumerable_thread_specific<ChunkPacker> packers;
    const auto pack = [&](Chunk* chunk) {
        const DefaultRounding rounding;  // of floats that are made here
        const PartLines& part = parts[chunk->part];
        const int first = chunk->number * part.lines;
        const std::string_view packed = packers.local().pack(part, first);
        std::vector<char>& bytes = chunk->bytes;
        bytes.clear();
        bytes.reserve(3 * sizeof(int32_t) + packed.size());
        if (parts.size() > 1) append(bytes, static_cast<int32_t>(chunk->part));
        append(bytes, static_cast<int32_t>(headers[chunk->part].dataWindow().min.y + first));
        append(bytes, static_cast<int32_t>(packed.size()));
        bytes.insert(bytes.end(), packed.begin(), packed.end());
        return chunk;
    };
    const auto put = [&](const Chunk* chunk) {
        append(offsets, offset);
        offset += chunk->bytes.size();
        write(stream, chunk->bytes);
    };
    tbb::parallel_pipeline(chunks.size(), tbb::make_filter<void, Chunk*>(tbb::filter_mode::serial_in_order, take) &
                                              tbb::make_filter<Chunk*, Chunk*>(tbb::filter_mode::parallel, pack) &
                                              tbb::make_filter<Chunk*, void>(tbb::filter_mode::serial_in_order, put));
    stream.seekp(table);
    write(stream, offsets);
}

}  // namespace cistula
