// What a process and the program that reads pictures for it, cistula-read-picture, say to each other, over a stream
// socket, in the machine's own byte order.
#pragma once

#include <cstdint>

namespace cistula {

/// The program's only argument; it changes whenever this header does.
inline constexpr const char* reader_protocol = "cistula-pictures-4 " CISTULA_VERSION;

inline constexpr int reader_socket = 3;           // the program's descriptor of its end
inline constexpr int reader_wrong_protocol = 64;  // the program's exit code for another argument
inline constexpr int reader_out_of_memory = 65;   // and where a limit that it inherited leaves too little memory

/// Asks for one picture; the bytes of its path follow.
struct ReadRequest {
    uint64_t left, limit;  // bytes that its texels may take; of the limit for all textures
    uint32_t is_exr;       // 1: OpenEXR; 0: what OpenImageIO finds
    uint32_t seconds;      // of TextureLimits
    uint32_t path_size;
    uint32_t reserved;
};

/// The answer is `colors`, where the file says something of them, `size`, and then `samples` until there are all, or at
/// any time `failed`.
enum class ReplyKind : uint32_t {
    size = 1,  // a ReplySize
    samples,   // whole texels, row-major from the top left
    failed,    // the reason, without the file's name
    colors,    // a ReplyColors, and then the id or the profile's name
};

/// Begins each part of an answer.
struct ReplyHead {
    ReplyKind kind;
    uint32_t bytes;  // of what follows, at most largest_reply_part
};
inline constexpr uint32_t largest_reply_part = 1 << 20;

struct ReplySize {
    uint32_t width, height;
    uint32_t channels;      // 1 or 3
    uint32_t sample_bytes;  // 1 or 2: codes, whose largest is white; 4: floats
};

/// FileColors.
struct ReplyColors {
    float chromaticities[8];
    uint32_t has_chromaticities, is_aces, is_half;
    uint32_t names_profile;  // 1: the text is FileColors::profile; 0: FileColors::id
};
inline constexpr uint32_t largest_reply_id = 255;

}  // namespace cistula
