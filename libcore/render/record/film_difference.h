// Bitwise comparison of two films, and what is found over all pixels of one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "render/record/film.h"

namespace cistula {

struct FilmDifference {
    uint64_t compared = 0;
    uint64_t differing = 0;
    std::optional<size_t> first;  // the first pixel that differs, if the films have the same size
};

/// Number of a pixel's integers and floats that differ in any bit.
uint64_t differing_values(const PixelRecord& a, const PixelRecord& b);

/// The totals over the pixels of a film that keeps all parts of them.
PixelTotals totals_of(const Film& film);

/// A hash (film_hash) of all that is known of each pixel: radiance, losses, hits, rays, id and the bits of z and
/// normal.
std::string record_hash(const Film& film);

/// Compares every pixel's sums, counts, id and the bits of its floats, then the frame's counts, flags and totals. Films
/// of different sizes, or that keep different parts, differ in everything.
FilmDifference film_difference(const Film& a, const Film& b);

}  // namespace cistula
