// The answer of the program that reads pictures, which is not trusted: a picture may have broken it.
#pragma once

#include <functional>
#include <stdexcept>

#include "scene/image/picture.h"
#include "scene/image/reader_wire.h"

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

/// The first part of an answer: the size of the picture, whose texels take `left` bytes at most. Throws PictureRefused,
/// ReaderBroken and what `receive` throws.
ReplySize receive_size(const Receive& receive, uint64_t left);

/// The rest of an answer as linear colors: 8- and 16-bit samples are decoded from sRGB, single channels are gray.
/// Throws also std::bad_alloc.
ColorPicture receive_texels(const Receive& receive, const ReplySize& size);

}  // namespace cistula
