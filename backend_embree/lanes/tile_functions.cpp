#include "backend_embree/lanes/tile_functions.h"

#include <atomic>

#include "backend_embree/lanes/lane_renderer.h"

namespace cistula {
namespace {

#ifdef CISTULA_AVX512
std::atomic<bool> avx512_is_hidden = false;

bool has_avx512() {
    return !avx512_is_hidden && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512cd");
}
template <class Real>
const TileFunctions* avx512_copy() {
    if (!has_avx512()) return nullptr;
    return sizeof(Real) == sizeof(float) ? &cistula_float_tiles_avx512 : &cistula_double_tiles_avx512;
}
#else
template <class Real>
const TileFunctions* avx512_copy() {
    return nullptr;
}
#endif
template <class Real>
const TileFunctions* avx2_copy() {
    return sizeof(Real) == sizeof(float) ? &cistula_float_tiles_avx2 : &cistula_double_tiles_avx2;
}

}  // namespace

template <class Real>
const TileFunctions* widest_tiles(int most_lanes) {
    for (const TileFunctions* copy : {avx512_copy<Real>(), avx2_copy<Real>()})
        if (copy != nullptr && (most_lanes == 0 || copy->lanes <= most_lanes)) return copy;
    return nullptr;
}

bool hide_avx512() {
#ifdef CISTULA_AVX512
    const bool was_there = has_avx512();
    avx512_is_hidden = true;
    return was_there;
#else
    return false;
#endif
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
