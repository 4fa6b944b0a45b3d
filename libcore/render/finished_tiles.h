// The tiles of a frame in work that are finished: what another thread may read of its film.
#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "render/record/film.h"

namespace cistula {

/// The finished part of a film.
struct PartialFilm {
    Film film;               // pixels that are not done are zero
    std::vector<bool> done;  // each pixel of the film
    double fraction = 0;     // of the pixels that are done
};

/// Filled by a renderer, tile by tile, and copied from by an observer. The renderer never waits for more than one copy,
/// and writes nothing that it would not write without.
class FinishedTiles {
  public:
    /// Begins a film that has its pixels, in square tiles of this side. Until end() it stays where it is, and the
    /// pixels of a tile do not change once finish() was called for it.
    void begin(const Film& film, int side);
    void finish(const PixelRect& tile);
    void end();

    /// A copy of what is finished; nothing if no film has begun.
    std::optional<PartialFilm> copy() const;

  private:
    mutable std::mutex mutex_;
    const Film* film_ = nullptr;
    std::vector<PixelRect> tiles_;  // finished ones, relative to the film's first pixel
};

}  // namespace cistula
