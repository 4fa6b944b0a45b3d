#include "scene/film/film_difference.h"

#include <algorithm>
#include <bit>

namespace cistula {
namespace {

constexpr uint64_t values_of_pixel = 20, values_of_frame = 5;  // of a frame: ray counts and flags

/// Number of a pixel's integers and floats that differ in any bit.
uint64_t differing_values(const PixelRecord& a, const PixelRecord& b) {
    uint64_t count = 0;
    for (int c = 0; c < 3; ++c)
        count += (a.radiance[c] != b.radiance[c]) + (a.pruned[c] != b.pruned[c]) + (a.cut[c] != b.cut[c]) +
                 (std::bit_cast<uint32_t>(a.normal[c]) != std::bit_cast<uint32_t>(b.normal[c]));
    return count + (a.hits != b.hits) + (a.rays != b.rays) + (a.id != b.id) + (a.samples != b.samples) +
           (a.unmet != b.unmet) + (a.checked != b.checked) + (a.off != b.off) +
           (std::bit_cast<uint32_t>(a.z) != std::bit_cast<uint32_t>(b.z));
}

}  // namespace

FilmDifference film_difference(const Film& a, const Film& b) {
    FilmDifference d;
    d.compared = values_of_pixel * std::max(a.pixels.size(), b.pixels.size()) + values_of_frame;
    if (a.pixels.size() != b.pixels.size()) {
        d.differing = d.compared;
        return d;
    }
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const uint64_t count = differing_values(a.pixels[i], b.pixels[i]);
        if (count != 0 && !d.first) d.first = i;
        d.differing += count;
    }
    d.differing += (a.rays.primary != b.rays.primary) + (a.rays.reflected != b.rays.reflected) +
                   (a.rays.transmitted != b.rays.transmitted) + (a.rays.shadow != b.rays.shadow) + (a.flags != b.flags);
    return d;
}

}  // namespace cistula
