// Which frames are rendered in lanes: told by the scene's form and the camera, not by what a renderer does.
#pragma once

#include <cstdlib>
#include <optional>

#include "backend_embree/lanes/lane_renderer.h"
#include "render/frame/frame_view.h"
#include "render/renderer.h"
#include "scene/compile/lane_scene.h"
#include "scene/description/camera_path.h"

namespace cistula::test {

/// The variable by which tests hide AVX-512 from themselves.
inline bool is_without_avx512() {
    return std::getenv("CISTULA_TEST_WITHOUT_AVX512") != nullptr;
}

/// The least number of lanes that render frame 0; none where its rays are traced one after the other however many
/// there are.
template <class Real>
std::optional<int> least_lanes(const CompiledScene<Real>& scene, const CameraDescription& camera,
                               const FrameSettings& settings) {
    const SceneView<Real> view = scene.view();
    const auto in_lanes = lane_scene(view);
    if (!in_lanes) return std::nullopt;
    FrameView frame = frame_view(scene, camera_at(camera, 0), settings);
    find_camera_solids(in_lanes->scene(), frame);
    for (int i = 0; i < 1 << frame.camera_planes; ++i)
        if (!InteriorSet::holds(frame.camera_sides[i].media, in_lanes->scene().named)) return std::nullopt;
    return in_lanes->scene().least_lanes;
}

/// The number of lanes that render what takes at least `least` of them, where there may be `most` (0: any number).
template <class Real>
int expected_lanes(std::optional<int> least, int most) {
    const TileFunctions* const widest = widest_tiles<Real>(most);
    return widest != nullptr && least && *least <= widest->lanes ? widest->lanes : 1;
}

}  // namespace cistula::test
