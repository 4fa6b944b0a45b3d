#include "scene/image/texture_reader.h"

#include <new>
#include <stdexcept>

#include "scene/base/file_bytes.h"
#include "scene/image/exr.h"
#include "scene/image/raw_picture.h"
#include "scene/image/reader_process.h"
#include "scene/image/reader_reply.h"

namespace cistula {
namespace {

/// Texels are numbered by 32 bits.
constexpr uint64_t most_bytes = UINT32_MAX * texel_bytes;

TextureLimits within_reach(TextureLimits limits) {
    if (limits.bytes > most_bytes) limits.bytes = most_bytes;
    return limits;
}

}  // namespace

TextureReader::TextureReader(const TextureLimits& limits) : limits_(within_reach(limits)), left_(limits_.bytes) {}

TextureReader::~TextureReader() = default;

ColorPicture TextureReader::read(const std::string& path, ClampedTexels* clamped, std::string_view encoding) {
    ColorPicture picture;
    try {
        picture = read_any(path, encoding);
    } catch (const Error&) {
        throw;
    } catch (const PictureRefused& refused) {
        throw file_error(path, "read", std::string(refused.what()));
    } catch (const std::bad_alloc&) {
        process_.reset();  // it may be in the middle of an answer
        throw;
    } catch (const std::runtime_error& broken) {
        process_.reset();
        throw file_error(path, "read", std::string(broken.what()));
    }
    left_ -= texel_bytes * picture.texels.size();
    const ClampedTexels found = clamp_texels(picture);
    if (!clamped && found.count() > 0) throw Error(ExitCode::file, path + ": " + found.refusal());
    if (clamped) *clamped = found;
    return picture;
}

ColorPicture TextureReader::read_any(const std::string& path, std::string_view encoding) {
    if (regular_file_size(path) == 0) throw file_error(path, "read", std::string("it is empty; give a picture"));
    const std::string extension = lower_extension(path);
    if (extension == ".exr" || read_file_start(path, 4) == exr_magic) return read_in_child(path, true, encoding);
    if (extension == ".data" || extension == ".out")
        return read_raw_picture(path, left_, limits_.bytes, file_encoding(encoding, {}, false));
    return read_in_child(path, false, encoding);
}

ColorPicture TextureReader::read_in_child(const std::string& path, bool is_exr, std::string_view encoding) {
    if (!process_) process_ = std::make_unique<ReaderProcess>();
    const auto start = ReaderProcess::Clock::now();
    const ReadRequest request = {left_,
                                 limits_.bytes,
                                 is_exr ? ReadKind::exr_texture : ReadKind::texture,
                                 static_cast<uint32_t>(limits_.seconds),
                                 static_cast<uint32_t>(path.size()),
                                 0};
    process_->send(&request, sizeof request);
    process_->send(path.data(), path.size());
    auto end = start + patience(limits_.seconds);
    const Receive receive = [&](void* to, size_t size) { process_->receive(to, size, end); };
    const auto [size, colors] = receive_start(receive, left_);
    const bool is_floating = size.sample_bytes == sizeof(float);
    const TexelDecoder decoder(file_encoding(encoding, colors, is_floating), size.sample_bytes, colors.is_half);
    end = start + patience(seconds_for(limits_.seconds, texel_bytes * size.width * size.height));
    return receive_texels(receive, size, decoder);
}

}  // namespace cistula
