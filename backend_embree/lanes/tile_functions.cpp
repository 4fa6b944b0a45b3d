#include "backend_embree/lanes/tile_functions.h"

#include <atomic>

#include "backend_embree/lanes/lane_renderer.h"

namespace cistula {
namespace {

std::atomic<bool> avx512_is_hidden = false;

bool runs_avx512() {
    return !avx512_is_hidden && cistula_float_tiles.avx512 != nullptr && __builtin_cpu_supports("avx512f") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd");
}

}  // namespace

template <class Real>
const TileFunctions* widest_tiles(int most_lanes) {
    const TileCopies& copies = sizeof(Real) == sizeof(float) ? cistula_float_tiles : cistula_double_tiles;
    for (const TileFunctions* copy : {runs_avx512() ? copies.avx512 : nullptr, copies.avx2})
        if (copy != nullptr && (most_lanes == 0 || copy->lanes <= most_lanes)) return copy;
    return nullptr;
}

bool hide_avx512() {
    const bool was_there = runs_avx512();
    avx512_is_hidden = true;
    return was_there;
}

template <class Real>
const TileFunctions* tile_functions(const LaneScene<Real>& scene, int most_lanes) {
    const TileFunctions* const widest = widest_tiles<Real>(most_lanes);
    return widest == nullptr || widest->lanes < scene.least_lanes ? nullptr : widest;
}

template const TileFunctions* widest_tiles<float>(int);
template const TileFunctions* widest_tiles<double>(int);

template const TileFunctions* tile_functions(const LaneScene<float>&, int);
template const TileFunctions* tile_functions(const LaneScene<double>&, int);

}  // namespace cistula
