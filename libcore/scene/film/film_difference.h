// Two films, integer by integer.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/film/film.h"

namespace cistula {

struct FilmDifference {
    uint64_t compared = 0, differing = 0;
    std::optional<size_t> first;  // the first pixel that differs, if the films are of one size
};

/// The sums, counts, ids and the bits of the floats of every pixel, then the counts and flags of the frame. Films of
/// different sizes differ in everything.
FilmDifference film_difference(const Film& a, const Film& b);

}  // namespace cistula
