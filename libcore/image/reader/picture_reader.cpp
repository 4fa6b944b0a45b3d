#include "image/reader/picture_reader.h"

#include <new>
#include <stdexcept>
#include <utility>

#include "base/file_bytes.h"
#include "image/color/texel_decoder.h"
#include "image/exr/exr.h"
#include "image/exr/exr_file.h"
#include "image/picture/raw_picture.h"
#include "image/reader/reader_process.h"
#include "image/reader/reader_reply.h"

namespace cistula {
namespace {

/// Texels are numbered by 32 bits.
constexpr uint64_t most_bytes = UINT32_MAX * texel_bytes;

TextureLimits within_reach(TextureLimits limits) {
    if (limits.bytes > most_bytes) limits.bytes = most_bytes;
    return limits;
}

/// Clamps what is no radiance, or throws where that is not wanted. `place`: of the message.
void clamp_or_refuse(ColorPicture& picture, ClampedTexels* clamped, ErrorKind kind, const std::string& place) {
    const ClampedTexels found = clamp_texels(picture);
    if (!clamped && found.count() > 0) throw Error(kind, found.refusal()).at(place);
    if (clamped) *clamped = found;
}

/// Whether a file is an EXR, by extension or by content. Throws Error where there is nothing in it.
bool is_exr(const std::string& path) {
    check_readable(path);
    if (regular_file_size(path) == 0) throw file_error(path, "read", std::string("it is empty"), "give a picture");
    return lower_extension(path) == ".exr" || read_file_start(path, exr_magic.size()) == exr_magic;
}

}  // namespace

GuardedReader::GuardedReader(const TextureLimits& limits, std::string users)
    : limits_(limits), left_(limits.bytes), users_(std::move(users)) {}

GuardedReader::~GuardedReader() = default;

void GuardedReader::ask(const std::string& path, ReadKind kind, const std::function<void(ReaderReply&)>& take) {
    using Clock = ReaderProcess::Clock;
    const uint64_t before = left_;
    try {
        if (!process_) process_ = std::make_unique<ReaderProcess>(users_);
        const auto start = Clock::now();
        const ReadRequest request = {
            left_, limits_.bytes, kind, static_cast<uint32_t>(limits_.seconds), static_cast<uint32_t>(path.size()), 0};
        process_->send(&request, sizeof request);
        process_->send(path.data(), path.size());
        const Receive receive = [&](void* to, size_t size) {
            // Five times the processor time, on the clock: other processes may need the processors, too.
            const int64_t seconds = 5 * seconds_for(limits_.seconds, before - left_);
            process_->receive(to, size, start + std::chrono::seconds(seconds));
        };
        ReaderReply reply(receive, kind != ReadKind::stored, left_);
        take(reply);
        return;
    } catch (const PictureRefused& refused) {
        left_ = before;
        throw file_error(path, "read", std::string(refused.what()));
    } catch (const std::bad_alloc&) {
        left_ = before;
        process_.reset();  // it may be in the middle of an answer
        throw;
    } catch (const std::runtime_error& broken) {
        left_ = before;
        process_.reset();
        throw file_error(path, "read", std::string(broken.what()));
    }
}

TextureReader::TextureReader(const TextureLimits& limits)
    : GuardedReader(within_reach(limits), "textures other than .data") {}

ColorPicture TextureReader::read(const std::string& path, ClampedTexels* clamped, std::string_view encoding) {
    ColorPicture picture;
    const bool exr = is_exr(path);
    const std::string extension = lower_extension(path);
    if (!exr && (extension == ".data" || extension == ".out")) {
        try {
            picture = read_raw_picture(path, left_, limits_.bytes, file_encoding(encoding, {}, false));
        } catch (const Error&) {
            throw;
        } catch (const std::runtime_error& unknown) {  // encoding
            throw file_error(path, "read", std::string(unknown.what()));
        }
        left_ -= texel_bytes * picture.texels.size();
    } else {
        ask(path, exr ? ReadKind::exr_texture : ReadKind::texture,
            [&](ReaderReply& reply) { picture = receive_texture(reply, encoding); });
    }
    clamp_or_refuse(picture, clamped, ErrorKind::file, path);
    return picture;
}

ColorPicture TextureReader::decode(const TexelArray& array, ClampedTexels* clamped, std::string_view encoding) {
    const auto refuse = [](const std::string& problem, const char* remedy = "") {
        throw Error(ErrorKind::usage, problem, remedy).at("the texels");
    };
    const std::string problem = texture_size_problem(array.width, array.height, left_, limits_.bytes);
    if (!problem.empty()) refuse(problem);
    const size_t texels = size_t{array.width} * array.height;
    ColorPicture picture{array.width, array.height, {}};
    const auto meaning = [&](bool is_floating) {
        try {
            return file_encoding(encoding, {}, is_floating);
        } catch (const std::runtime_error& unknown) {
            throw Error(ErrorKind::usage, unknown.what()).at("the texels");
        }
    };
    std::visit(
        [&]<class Value>(const std::vector<Value>& values) {
            if (array.channels == 0 || values.size() % array.channels != 0 || values.size() / array.channels != texels)
                refuse("there are " + std::to_string(values.size()) + " numbers for " + std::to_string(array.width) +
                           "x" + std::to_string(array.height) + " texels of " + std::to_string(array.channels) +
                           " channels",
                       "give one for each channel of each");
            const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
            picture.texels.reserve(texels);
            TexelDecoder(meaning(std::is_same_v<Value, float>), sizeof(Value))
                .append(bytes, array.channels, picture.texels);
        },
        array.values);
    left_ -= texel_bytes * texels;
    clamp_or_refuse(picture, clamped, ErrorKind::usage, "the texels");
    return picture;
}

StoredReader::StoredReader(const TextureLimits& limits) : GuardedReader(limits, "pictures other than EXR") {}

StoredFile StoredReader::read(const std::string& path) {
    if (is_exr(path)) return read_stored_exr(path);
    StoredFile file;
    ask(path, ReadKind::stored, [&](ReaderReply& reply) { file = receive_stored(reply); });
    return file;
}

std::pair<StoredFile, StoredFile> StoredReader::read_two(
    const std::string& first, const std::string& second,
    const std::function<bool(const StoredFile&, const StoredFile&)>& want) {
    if (is_exr(first) && is_exr(second)) {
        std::pair headers(read_stored_exr(first, false), read_stored_exr(second, false));
        if (!want(headers.first, headers.second)) return headers;
    }
    StoredFile a = read(first);
    return {std::move(a), read(second)};
}

}  // namespace cistula
