#include "backend_embree/lanes/tile_functions.h"

#include "backend_embree/lanes/lane_renderer.h"
#include "cistula/lanes/lane_hit.h"

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

/// Whether the numbers of all faces fit the keys of lanes.
template <class Real>
bool fits_keys(const ConstantScene<Real>& scene) {
    using Keys = KeyFormat<Lanes<Real, lane_bytes / int(sizeof(Real))>>;
    for (const Cluster<Real>& cluster : scene.clusters)
        for (uint32_t lane = 0; lane < cluster.count; ++lane)
            if (cluster.triangle[lane] > Keys::most) return false;
    return true;
}

}  // namespace

template <class Real>
const TileFunctions* tile_functions(const ConstantScene<Real>& scene, const FrameView& frame, int most_lanes) {
    static const TileFunctions* const copies[] = {avx512_copy<Real>(), avx2_copy<Real>()};
    if (frame.tree.budget != 0 || !fits_keys(scene)) return nullptr;
    for (const TileFunctions* copy : copies)
        if (copy != nullptr && (most_lanes == 0 || copy->lanes <= most_lanes)) return copy;
    return nullptr;
}

template const TileFunctions* tile_functions(const ConstantScene<float>&, const FrameView&, int);
template const TileFunctions* tile_functions(const ConstantScene<double>&, const FrameView&, int);

}  // namespace cistula
