#include "backend_cuda/host/scene_upload.h"

#include <algorithm>

#include "scene/compile/constant_scene.h"

namespace cistula {

template <class Real>
DevicePath path_for(const SceneView<Real>& scene) {
    if (!scene.balls.empty()) return ball_scene(scene, scene) ? DevicePath::ball_loop : DevicePath::tree;
    return takes_loop(scene) && fits_constant_scene(scene) ? DevicePath::plain_loop : DevicePath::tree;
}

template <class Real>
SceneUpload<Real>::SceneUpload(const SceneArena<Real>& scene, const SceneView<Real>& here, DevicePath path,
                               cudaStream_t stream) {
    arena_.reserve(std::max<size_t>(scene.bytes().size(), 1));
    CISTULA_CUDA_CHECK(
        cudaMemcpyAsync(arena_.as<void>(), scene.bytes().data(), scene.bytes().size(), cudaMemcpyHostToDevice, stream));
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(stream));
    scene_.view = scene.at(arena_.as<void>());
    if (path == DevicePath::ball_loop) scene_.balls = *ball_scene(here, scene_.view);
    if (path != DevicePath::plain_loop) return;
    scene_.constant = *constant_scene(here, scene_.view);
    primitives_.assign(here.solids.size, 0);
    for (uint32_t i = 0; i < here.convex.size; ++i) primitives_[here.convex[i]] |= 1u << i;
    for (uint32_t i = 0; i < here.clusters.size; ++i)
        primitives_[here.clusters[i].solid] |= 1u << (ShadowPlan::first_cluster + i);
}

template DevicePath path_for(const SceneView<float>&);
template DevicePath path_for(const SceneView<double>&);
template class SceneUpload<float>;
template class SceneUpload<double>;

}  // namespace cistula
