// The answer of the program that reads pictures with all of a file, which is not trusted: a picture may have broken it.
#pragma once

#include "scene/image/reader_reply.h"
#include "scene/image/stored_picture.h"

namespace cistula {

/// A whole answer; its values take `left` bytes at most, and what they take is taken off. `announced(bytes)` is called
/// for each picture, before its values. Throws PictureRefused, ReaderBroken, std::bad_alloc and what `receive` throws.
StoredFile receive_stored(const Receive& receive, uint64_t& left,
                          const std::function<void(uint64_t bytes)>& announced = {});

}  // namespace cistula
