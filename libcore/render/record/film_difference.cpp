#include "render/record/film_difference.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>

#include "base/fnv128.h"

namespace cistula {
namespace {

constexpr uint64_t values_of_pixel = 20, values_of_frame = 5 + 3 * 10;  // of a frame: rays, flags, totals

uint64_t differing_values(const Total& a, const Total& b) {
    return (a.low != b.low) + (a.high != b.high) + (a.most != b.most);
}

uint64_t differing_values(const FrameCounts& a, const FrameCounts& b) {
    uint64_t count = differing_values(a.totals.units, b.totals.units);
    for (int c = 0; c < 3; ++c)
        count += differing_values(a.totals.radiance[c], b.totals.radiance[c]) +
                 differing_values(a.totals.pruned[c], b.totals.pruned[c]) +
                 differing_values(a.totals.cut[c], b.totals.cut[c]);
    return count + (a.rays.primary != b.rays.primary) + (a.rays.reflected != b.rays.reflected) +
           (a.rays.transmitted != b.rays.transmitted) + (a.rays.shadow != b.rays.shadow) + (a.flags != b.flags);
}

}  // namespace

uint64_t differing_values(const PixelRecord& a, const PixelRecord& b) {
    uint64_t count = 0;
    for (int c = 0; c < 3; ++c)
        count += (a.radiance[c] != b.radiance[c]) + (a.pruned[c] != b.pruned[c]) + (a.cut[c] != b.cut[c]) +
                 (std::bit_cast<uint32_t>(a.normal[c]) != std::bit_cast<uint32_t>(b.normal[c]));
    return count + (a.hits != b.hits) + (a.rays != b.rays) + (a.id != b.id) + (a.samples != b.samples) +
           (a.unmet != b.unmet) + (a.checked != b.checked) + (a.off != b.off) +
           (std::bit_cast<uint32_t>(a.z) != std::bit_cast<uint32_t>(b.z));
}

PixelTotals totals_of(const Film& film) {
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, film.pixels.size()), PixelTotals(),
        [&](const auto& range, PixelTotals totals) {
            for (size_t i = range.begin(); i != range.end(); ++i) {
                const PixelRecord pixel = film.pixels[i];
                totals.add(pixel, film.units_lost(pixel));
            }
            return totals;
        },
        [](PixelTotals a, const PixelTotals& b) {
            a.add(b);
            return a;
        });
}

std::string record_hash(const Film& film) {
    Fnv128 hash;
    for (const PixelRecord& pixel : film.pixels) {
        for (const int64_t value : pixel.radiance) hash.add(value);
        for (const int64_t value : pixel.pruned) hash.add(value);
        for (const int64_t value : pixel.cut) hash.add(value);
        hash.add(pixel.hits);
        hash.add(pixel.rays);
        hash.add(pixel.id);
        hash.add(pixel.z);
        for (const float value : pixel.normal) hash.add(value);
    }
    return hash.hex();
}

FilmDifference film_difference(const Film& a, const Film& b) {
    FilmDifference d;
    d.compared = values_of_pixel * std::max(a.pixels.size(), b.pixels.size()) + values_of_frame;
    if (a.pixels.size() != b.pixels.size() || a.pixels.parts() != b.pixels.parts()) {
        d.differing = d.compared;
        return d;
    }
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const uint64_t count = differing_values(a.pixels[i], b.pixels[i]);
        if (count != 0 && !d.first) d.first = i;
        d.differing += count;
    }
    d.differing += differing_values(static_cast<const FrameCounts&>(a), b);
    return d;
}

}  // namespace cistula
