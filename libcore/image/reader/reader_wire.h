// What a process and the program that reads pictures for it, cistula-read-picture, say to each other, over a stream
// socket, in the machine's own byte order.
#pragma once

#include <cstdint>

#include "image/picture/stored_picture.h"

namespace cistula {

/// The program's only argument; it changes whenever this header does.
inline constexpr const char* reader_protocol = "cistula-pictures-7 " CISTULA_VERSION;

inline constexpr int reader_socket = 3;           // the program's descriptor of its end
inline constexpr int reader_wrong_protocol = 64;  // the program's exit code for another argument
inline constexpr int reader_out_of_memory = 65;   // and where a limit that it inherited leaves too little memory

/// What is wanted of a file.
enum class ReadKind : uint32_t {
    texture,  // colors of what OpenImageIO finds: one picture of one or three channels, codes of 8 or 16 bits or floats
    exr_texture,  // colors of OpenEXR, as floats
    stored,       // all that OpenImageIO finds, as it stands
};

/// Asks for one file; the bytes of its path follow.
struct ReadRequest {
    uint64_t left, limit;  // bytes that its texels or values may take; of the limit for all pictures
    ReadKind kind;
    uint32_t seconds;  // of TextureLimits
    uint32_t path_size;
    uint32_t reserved;
};

/// The answer is, for each of the file's pictures, `picture`; `colors` and `attribute`s, where the file says such; and
/// `samples` until there are all; and then `end`. It ends at any time with `failed`.
enum class ReplyKind : uint32_t {
    samples = 2,  // whole texels, row-major from the top left
    failed,       // the reason, without the file's name
    colors,       // a ReplyColors, and then the id or the profile's name
    picture,      // a ReplyPicture, the format's name and the channels' names, each with a zero byte
    attribute,    // name, type and text, each with a zero byte
    end,
};

/// Begins each part of an answer.
struct ReplyHead {
    ReplyKind kind;
    uint32_t bytes;  // of what follows, at most largest_reply_part
};
inline constexpr uint32_t largest_reply_part = 1 << 20;

/// A StoredPicture.
struct ReplyPicture {
    int32_t x, y, display_x, display_y;
    uint32_t width, height, display_width, display_height;
    uint32_t level;
    uint32_t channels;
    StoredType type;  // of all of them, but `uint`; halves are sent as floats
    uint32_t reserved;
};
inline constexpr uint32_t most_stored_pictures = 4096;

/// FileColors.
struct ReplyColors {
    float chromaticities[8];
    uint32_t has_chromaticities, is_aces, is_half;
    uint32_t names_profile;  // 1: the text is FileColors::profile; 0: FileColors::id
    double factors[3] = {1, 1, 1};
};
inline constexpr uint32_t largest_reply_id = 255;

}  // namespace cistula
