// Bitwise comparison of two films.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/film/film.h"

namespace cistula {

struct FilmDifference {
    uint64_t compared = 0, differing = 0;
    std::optional<size_t> first;  // the first pixel that differs, if the films have the same size
};

/// Compares every pixel's sums, counts, id and the bits of its floats, then the frame's counts and flags. Films of
/// different sizes differ in everything.
FilmDifference film_difference(const Film& a, const Film& b);

}  // namespace cistula
