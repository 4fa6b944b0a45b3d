#include "image/reader/texture_limits.h"

#include <cstdio>

#include "base/file_bytes.h"
#include "base/machine.h"

namespace cistula {

uint64_t default_texture_bytes() {
    return machine_memory() / 4;
}

int64_t seconds_for(int seconds, uint64_t bytes) {
    return seconds + static_cast<int64_t>(bytes / 50'000'000);
}

std::string gigabytes(uint64_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g GB", static_cast<double>(bytes) / 1e9);
    return text;
}

std::string size_problem(bool is_texture, int64_t width, int64_t height, uint64_t texel, uint64_t left,
                         uint64_t limit) {
    const std::string size = "its size is " + std::to_string(width) + "x" + std::to_string(height);
    if (width < 1 || height < 1 || width > largest_picture_side || height > largest_picture_side)
        return size + "; width and height of a " + (is_texture ? "texture" : "picture") + " are 1 to " +
               std::to_string(largest_picture_side);
    const uint64_t pixels = static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
    if (pixels <= left / texel) return "";
    return size + (is_texture ? ", which takes " : ", and its values take ") + gigabytes(texel * pixels) +
           " of memory; " + (is_texture ? "textures" : "pictures") + " may take " + gigabytes(limit) +
           (left < limit ? ", and others take " + gigabytes(limit - left) : "") + "; give a smaller one" +
           (is_texture ? ", or raise the limit (`max_texture_gb` of render)" : "");
}

}  // namespace cistula
