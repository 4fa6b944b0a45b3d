// The answer of the program that reads pictures, which is not trusted: a picture may have broken it.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "image/color/file_colors.h"
#include "image/picture/picture.h"
#include "image/picture/stored_picture.h"
#include "image/reader/reader_wire.h"

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

/// What comes before a picture's samples.
struct ReplyStart {
    std::string format;     // of the file
    StoredPicture picture;  // its channels are of one type, and still empty
    FileColors colors;
};

/// An answer, part for part. All functions throw PictureRefused, ReaderBroken and what `receive` throws.
class ReaderReply {
  public:
    /// Pictures may take `left` bytes in memory, those of textures 12 a texel; what they take is taken off.
    ReaderReply(Receive receive, bool is_texture, uint64_t& left)
        : receive_(std::move(receive)), is_texture_(is_texture), left_(left) {}

    /// The next picture; none at the end. All samples of the one before must have been taken.
    std::optional<ReplyStart> next();

    /// The next samples of the picture, some whole texels; empty where all have been taken.
    std::string samples();

  private:
    ReplyHead next_head() const;
    std::string bytes_of(size_t count) const;
    ReplyStart begin(size_t count);
    void add_attribute(StoredPicture& picture, size_t count);

    Receive receive_;
    bool is_texture_;
    uint64_t& left_;
    ReplyHead ahead_{};  // of the samples that come next
    uint64_t texels_left_ = 0;
    size_t texel_ = 0;  // bytes
    uint32_t pictures_ = 0;
    uint32_t attributes_ = 0;
    uint32_t level_ = 0;
};

/// The texture of an answer, by the encoding of that name or, without one, the file's; single channels are gray. Throws
/// also std::runtime_error for colors that are not known, and std::bad_alloc.
ColorPicture receive_texture(ReaderReply& reply, std::string_view encoding);

/// All of an answer. Throws also std::bad_alloc.
StoredFile receive_stored(ReaderReply& reply);

}  // namespace cistula
