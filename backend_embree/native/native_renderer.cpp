#include "backend_embree/embree/embree_device.h"
#include "backend_embree/embree/embree_renderer.h"
#include "backend_embree/host/frame_loop.h"
#include "backend_embree/native/native_intersector.h"

namespace cistula {
namespace {

/// Embree's tree over its own triangle geometry.
template <class Real>
class NativeTree {
  public:
    NativeTree(const SceneView<Real>& scene, const EmbreeOptions& options)
        : device_(options.device_config), triangles_(native_triangles(scene)) {
        if (!rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED))
            throw Error(ExitCode::device, "--intersector native: this Embree was built without filter functions");
        const GeometryPointer owner(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
        const RTCGeometry geometry = owner.get();
        // Medium quality: high quality splits triangles, and Embree may then report one several times, which a shadow
        // would count.
        const RTCBuildQuality quality = options.tree_quality > 0 ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_LOW;
        rtcSetGeometryBuildQuality(geometry, quality);
        const size_t count = triangles_.size();
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                                     RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * count));
        auto* numbers = static_cast<uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), count));
        device_.check("making room for triangles");
        for (size_t i = 0; i < 3 * count; ++i) {
            const Vec3<float>& corner = triangles_[i / 3].corner[i % 3];
            for (int axis = 0; axis < 3; ++axis) vertices[3 * i + size_t(axis)] = corner[axis];
            numbers[i] = uint32_t(i);
        }
        rtcSetGeometryUserData(geometry, triangles_.data());
        rtcSetGeometryIntersectFilterFunction(geometry, &NativeIntersector<Real>::on_intersect);
        rtcSetGeometryOccludedFilterFunction(geometry, &NativeIntersector<Real>::on_occluded);
        rtcCommitGeometry(geometry);
        scene_.reset(rtcNewScene(device_.get()));
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_.get(), quality);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcCommitScene(scene_.get());
        device_.check("building the tree");
    }

    RTCScene scene() const { return scene_.get(); }
    size_t memory() const { return device_.memory() + triangles_.size() * sizeof(NativeTriangle); }

  private:
    EmbreeDevice device_;
    std::vector<NativeTriangle> triangles_;
    ScenePointer scene_;
};

template <class Real>
class NativeRenderer : public Renderer {
  public:
    NativeRenderer(std::shared_ptr<const CompiledScene<Real>> scene, const EmbreeOptions& options)
        : scene_(std::move(scene)), view_(scene_->view()), tree_(view_, options) {}

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        const NativeIntersector<Real> intersector{view_, tree_.scene()};
        FrameTask task(*scene_, intersector, camera, settings, film, progress);
        effects_ = task.effects();
        return task.run();
    }
    uint32_t effects() const override { return effects_; }
    std::string intersector() const override { return "native"; }
    size_t memory() const override { return scene_->memory() + tree_.memory(); }

  private:
    std::shared_ptr<const CompiledScene<Real>> scene_;
    SceneView<Real> view_;
    NativeTree<Real> tree_;
    uint32_t effects_ = 0;
};

}  // namespace

template <class Real>
std::unique_ptr<Renderer> make_native_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                               const EmbreeOptions& options) {
    return in_default_rounding([&] { return std::make_unique<NativeRenderer<Real>>(std::move(scene), options); });
}

template std::unique_ptr<Renderer> make_native_renderer(std::shared_ptr<const CompiledScene<float>>,
                                                        const EmbreeOptions&);
template std::unique_ptr<Renderer> make_native_renderer(std::shared_ptr<const CompiledScene<double>>,
                                                        const EmbreeOptions&);

}  // namespace cistula
