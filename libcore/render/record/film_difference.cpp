#include "render/record/film_difference.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>

#include "base/fnv128.h"

namespace cistula {
namespace {

/// Calls visit with each value of a record and its like in another; of floats with their bits.
template <class Visit>
void for_each_value(const PixelRecord& a, const PixelRecord& b, const Visit& visit) {
    const auto visit_bits = [&](float x, float y) { visit(std::bit_cast<uint32_t>(x), std::bit_cast<uint32_t>(y)); };
    for (int c = 0; c < 3; ++c) {
        visit(a.radiance[c], b.radiance[c]);
        visit(a.pruned[c], b.pruned[c]);
        visit(a.cut[c], b.cut[c]);
        visit_bits(a.normal[c], b.normal[c]);
    }
    visit(a.hits, b.hits);
    visit(a.rays, b.rays);
    visit(a.id, b.id);
    visit(a.samples, b.samples);
    visit(a.unmet, b.unmet);
    visit(a.checked, b.checked);
    visit(a.off, b.off);
    visit_bits(a.z, b.z);
}

template <class Visit>
void for_each_value(const Total& a, const Total& b, const Visit& visit) {
    visit(a.low, b.low);
    visit(a.high, b.high);
    visit(a.most, b.most);
}

/// Rays, flags and totals of a frame.
template <class Visit>
void for_each_value(const FrameCounts& a, const FrameCounts& b, const Visit& visit) {
    for_each_value(a.totals.units, b.totals.units, visit);
    for (int c = 0; c < 3; ++c) {
        for_each_value(a.totals.radiance[c], b.totals.radiance[c], visit);
        for_each_value(a.totals.pruned[c], b.totals.pruned[c], visit);
        for_each_value(a.totals.cut[c], b.totals.cut[c], visit);
    }
    visit(a.rays.primary, b.rays.primary);
    visit(a.rays.reflected, b.rays.reflected);
    visit(a.rays.transmitted, b.rays.transmitted);
    visit(a.rays.shadow, b.rays.shadow);
    visit(a.flags, b.flags);
}

template <class Record>
uint64_t count_differing(const Record& a, const Record& b) {
    uint64_t count = 0;
    for_each_value(a, b, [&](const auto& x, const auto& y) { count += x != y; });
    return count;
}

template <class Record>
uint64_t count_values() {
    uint64_t count = 0;
    for_each_value(Record(), Record(), [&](const auto&, const auto&) { ++count; });
    return count;
}

}  // namespace

uint64_t differing_values(const PixelRecord& a, const PixelRecord& b) {
    return count_differing(a, b);
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
    d.compared = count_values<PixelRecord>() * std::max(a.pixels.size(), b.pixels.size()) + count_values<FrameCounts>();
    if (a.pixels.size() != b.pixels.size() || a.pixels.parts() != b.pixels.parts()) {
        d.differing = d.compared;
        return d;
    }
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const uint64_t count = differing_values(a.pixels[i], b.pixels[i]);
        if (count != 0 && !d.first) d.first = i;
        d.differing += count;
    }
    d.differing += count_differing<FrameCounts>(a, b);
    return d;
}

}  // namespace cistula
