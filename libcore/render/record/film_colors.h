// What a film's sums are in the color space of a file.
#pragma once

#include <cstdint>

#include "render/record/film.h"
#include "render/record/film_picture.h"

namespace cistula {

/// The colors of a file's channels.
class FilmColors {
  public:
    FilmColors(const Film& film, const OutputChannels& channels);

    /// Channel c of the mean radiance whose sums these are.
    float radiance(const int64_t (&sums)[3], int c) const;

    /// Channel c of a share of light, as of a material's color.
    float reflectance(const float (&color)[3], int c) const;

    /// A bound on the error of channel c of a pixel's radiance from the ledger and from whole units, rounded up to
    /// float.
    float error(const PixelRecord& pixel, int c) const;

    /// What samples that meet nothing added to a pixel, and what a file with a transparent background leaves out: the
    /// layer of the background, or, of films without, as often what each adds.
    int64_t left_out(size_t pixel, int c) const {
        if (!transparent_) return 0;
        const int path = film_.layers.plan.path;
        if (path >= 0) return film_.layers.of(pixel)[path + 3 * static_cast<int>(PathLayer::background) + c];
        return (film_.samples - static_cast<int64_t>(film_.pixels.radiance(pixel).hits)) * film_.background[c];
    }

  private:
    const Film& film_;
    bool transparent_, converts_ = false;
    glm::dmat3 matrix_{1.0};
};

}  // namespace cistula
