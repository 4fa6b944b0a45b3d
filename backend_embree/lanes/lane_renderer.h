// Tiles of a frame rendered in lanes, by the widest instruction set that the processor has.
#pragma once

#include <atomic>
#include <memory>

#include "backend_embree/lanes/tile_functions.h"
#include "cistula/lanes/lane_pixel.h"
#include "cistula/lanes/lane_scene.h"
#include "cistula/transport/pixel.h"

namespace cistula {

/// Renders tiles, one after the other.
class TileRenderer {
  public:
    /// The scene, a LaneScene of the precision of `functions`, and the frame must outlive the renderer. `mask`: index
    /// in effect_masks.
    TileRenderer(const TileFunctions& functions, int mask, const void* scene, const FrameView& frame)
        : functions_(functions), tile_(functions.make(mask, scene, &frame), functions.destroy) {}
    /// A renderer of samples by themselves.
    TileRenderer(const TileFunctions& functions, const void* scene, const FrameView& frame)
        : functions_(functions), tile_(functions.make_by_sample(scene, &frame), functions.destroy) {}

    /// Adds samples to the tile. The records must outlive its rendering.
    void add(const LanePixel& pixel) { functions_.add(tile_.get(), &pixel); }
    /// Renders the tile's pixels, unless it is stopped, adds what they count, and begins a new tile.
    void render(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) {
        functions_.render(tile_.get(), &stop, &rays, &flags);
    }

  private:
    const TileFunctions& functions_;
    std::unique_ptr<void, void (*)(void*)> tile_;
};

/// The widest tile renderers that the processor runs, with at most so many lanes (0: any number); null if there are
/// none.
template <class Real>
const TileFunctions* widest_tiles(int most_lanes);

/// Hides AVX-512 from widest_tiles in this process; for tests. False if there was none.
bool hide_avx512();

/// The tile renderers of a scene, with at most so many lanes (0: any number); null if its rays are traced one after the
/// other.
template <class Real>
const TileFunctions* tile_functions(const LaneScene<Real>& scene, int most_lanes);

}  // namespace cistula
