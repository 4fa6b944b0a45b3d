// The answer of the program that reads pictures, which is not trusted: a picture may have broken it.
#pragma once

#include <functional>
#include <stdexcept>

#include "scene/image/file_colors.h"
#include "scene/image/picture.h"
#include "scene/image/reader_wire.h"
#include "scene/image/texel_decoder.h"

namespace cistula {

/// The reason why a picture cannot be read, from the program that reads pictures.
struct PictureRefused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The program that reads pictures ended, or what it says makes no sense.
struct ReaderBroken : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Fills `size` bytes at `to` with what the program says next, or throws.
using Receive = std::function<void(void* to, size_t size)>;

/// Throws ReaderBroken for an answer that makes no sense.
[[noreturn]] void fail_broken();

/// The head of the next part of an answer; throws PictureRefused if that is the reason of a failure, and ReaderBroken.
ReplyHead next_part(const Receive& receive);

/// What comes before the samples.
struct ReplyStart {
    ReplySize size;
    FileColors colors;
};

/// The first parts of an answer; the texels of the picture take `left` bytes at most. Throws PictureRefused,
/// ReaderBroken and what `receive` throws.
ReplyStart receive_start(const Receive& receive, uint64_t left);

/// The rest of an answer, by a decoder for samples of its size; single channels are gray. Throws also std::bad_alloc.
ColorPicture receive_texels(const Receive& receive, const ReplySize& size, const TexelDecoder& decoder);

}  // namespace cistula
