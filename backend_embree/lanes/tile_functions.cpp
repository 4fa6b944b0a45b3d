#include "backend_embree/lanes/tile_functions.h"

#include "backend_embree/lanes/lane_renderer.h"

namespace cistula {
namespace {

#ifdef CISTULA_AVX512
bool has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
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
const TileFunctions* tile_functions(const LaneScene<Real>& scene, int most_lanes) {
    static const TileFunctions* const copies[] = {avx512_copy<Real>(), avx2_copy<Real>()};
    for (const TileFunctions* copy : copies)
        if (copy != nullptr && (most_lanes == 0 || copy->lanes <= most_lanes))
            return copy->lanes < scene.least_lanes ? nullptr : copy;
    return nullptr;
}

template const TileFunctions* tile_functions(const LaneScene<float>&, int);
template const TileFunctions* tile_functions(const LaneScene<double>&, int);

}  // namespace cistula
