// How much memory and time textures may take.
#pragma once

#include <cstdint>
#include <string>

namespace cistula {

/// Bytes of a texel in memory: three floats.
inline constexpr uint64_t texel_bytes = 12;

inline constexpr uint64_t no_texture_limit = UINT64_MAX;

inline constexpr uint32_t most_stored_channels = 4096;  // of a picture that is read as it stands

/// Bytes that the texels of all textures of a scene may take unless something else is said: a quarter of the memory
/// that the process can have.
uint64_t default_texture_bytes();

/// What reading textures may take.
struct TextureLimits {
    uint64_t bytes = default_texture_bytes();  // of the texels of all textures together
    int seconds = 20;                          // of processor time for one texture, and 20 more for each GB of texels
};

/// The processor time in seconds that a texture with so many bytes of texels may take.
int64_t seconds_for(int seconds, uint64_t bytes);

/// Why a picture of this size is not read, as a texture or as it stands, without the file's name; empty if it is: each
/// side has 1 to 65536 pixels, and these take at most `left` bytes of the `limit` for all, `texel` each.
std::string size_problem(bool is_texture, int64_t width, int64_t height, uint64_t texel, uint64_t left, uint64_t limit);

inline std::string texture_size_problem(int64_t width, int64_t height, uint64_t left, uint64_t limit) {
    return size_problem(true, width, height, texel_bytes, left, limit);
}

/// A size in memory for messages: "6.32 GB".
std::string gigabytes(uint64_t bytes);

}  // namespace cistula
