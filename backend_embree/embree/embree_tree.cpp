#include "backend_embree/embree/embree_tree.h"

#include <vector>

#include "backend_embree/host/frame_loop.h"
#include "scene/trees/embree_handles.h"

namespace cistula {

template <class Real>
EmbreeTree<Real>::EmbreeTree(const SceneView<Real>& scene, const EmbreeOptions& options)
    : device_(options.device_config) {
    call_in_default_rounding([&] { build(scene, options); });
}

template <class Real>
void EmbreeTree<Real>::build(const SceneView<Real>& scene, const EmbreeOptions& options) {
    // Boxes are computed before the commit, whose threads may run with flush-to-zero.
    const uint32_t primitives = scene.convex.size + scene.clusters.size;
    std::vector<PaddedBox> boxes(primitives);
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, primitives), [&](const auto& range) {
        for (uint32_t p = range.begin(); p != range.end(); ++p) boxes[p] = primitive_box(scene, p);
    });
    const GeometryPointer owner(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    const RTCGeometry geometry = owner.get();
    const RTCBuildQuality quality = options.tree_quality > 0 ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_LOW;
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcSetGeometryUserPrimitiveCount(geometry, primitives);
    rtcSetGeometryUserData(geometry, boxes.data());
    rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* arguments) {
            const PaddedBox& box = static_cast<const PaddedBox*>(arguments->geometryUserPtr)[arguments->primID];
            RTCBounds& out = *arguments->bounds_o;
            out.lower_x = box.low[0];
            out.lower_y = box.low[1];
            out.lower_z = box.low[2];
            out.upper_x = box.high[0];
            out.upper_y = box.high[1];
            out.upper_z = box.high[2];
        },
        nullptr);
    rtcSetGeometryIntersectFunction(geometry, &EmbreeIntersector<Real>::on_intersect);
    rtcSetGeometryOccludedFunction(geometry, &EmbreeIntersector<Real>::on_occluded);
    rtcCommitGeometry(geometry);
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneBuildQuality(scene_.get(), quality);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcCommitScene(scene_.get());
    device_.check("building the tree");
}

template class EmbreeTree<float>;
template class EmbreeTree<double>;

EmbreeDevice::EmbreeDevice(const std::string& config) : device_(make_embree_device(config)) {
    rtcSetDeviceMemoryMonitorFunction(
        device_.get(),
        [](void* self, ssize_t bytes, bool) {
            static_cast<EmbreeDevice*>(self)->memory_ += bytes;
            return true;
        },
        this);
}

void EmbreeDevice::check(const char* doing) const {
    check_embree(device_.get(), doing);
}

}  // namespace cistula
