#include "scene/compile/constant_scene.h"

#include <algorithm>
#include <vector>

#include "base/default_rounding.h"
#include "scene/compile/scene_copies.h"

namespace cistula {
namespace {

/// Whether a ray that is inside a solid is inside no other, and a hit on it is that of no other.
template <class Real>
bool is_by_itself(const SceneView<Real>& scene, const Solid& solid) {
    if (!is_ball(solid)) return solid.kind != SolidKind::mesh && !solid.may_touch;
    const Ball<Real>& ball = scene.balls[solid.first_slab];
    return solid.isolated && ball.has_kin == 0 && ball.touched_count == ball.plane_count;
}

/// Whether a SingleInterior says all about a scene's rays, and no mesh is smooth.
template <class Real>
bool has_single_interiors(const SceneView<Real>& scene) {
    return scene.shared_planes.empty() && scene.normals.empty() && !scene.unseen_faces &&
           std::all_of(scene.solids.begin(), scene.solids.end(),
                       [&](const Solid& solid) { return is_by_itself(scene, solid); });
}

/// Fills `to`; false if the scene does not fit.
template <class Real>
bool assign(const SceneView<Real>& here, const SceneView<Real>& there, ConstantScene<Real>& to) {
    if (!here.balls.empty() || !has_single_interiors(here)) return false;
    if (!to.solids.assign(here.solids) || !to.slabs.assign(here.slabs) ||
        !to.convex.assign(here.convex.size, [&](uint32_t i) { return indexed_solid(here, here.convex[i]); }) ||
        !to.clusters.assign(here.clusters) || !to.materials.assign(here.materials) || !to.lights.assign(here.lights) ||
        !to.textures.assign(here.textures))
        return false;
    to.slab_groups = there.slab_groups;
    to.facets = there.facets;
    to.uvs = there.uvs;
    to.incidents = there.incidents;
    to.visible_lights = there.visible_lights;
    to.texels = there.texels;
    to.tree = there.tree;
    to.tree_items = there.tree_items;
    to.visible_light_tree = there.visible_light_tree;
    to.light_groups = there.light_groups;
    to.planes.assign(to.clusters.size, [&](uint32_t i) { return boxed_plane(here, i); });
    to.sides.assign(to.clusters.size * cluster_lanes, [&](uint32_t slot) { return sides_of(here, slot); });
    cache_transmittances(here.materials, to.cached_transmittances);
    to.opaque_solids = to.clear_solids = to.transmitting_solids = 0;
    for (uint32_t i = 0; i < to.solids.size; ++i) {
        to.opaque_solids |= uint32_t(is_opaque(here, i)) << i;
        to.clear_solids |= uint32_t(is_clear(here, i)) << i;
        to.transmitting_solids |= uint32_t(transmits(here, i)) << i;
    }
    to.plan.clear(to.convex.size, to.clusters.size);
    to.sky_stops = there.sky_stops;
    to.sky = here.sky;
    to.background = here.background;
    to.bound = here.bound;
    to.largest_bound = here.largest_bound;
    to.extent = here.extent;
    return true;
}

/// Fills `to`, a copy of the view where kernels read it; false if the scene does not fit.
template <class Real>
bool assign(const SceneView<Real>& here, BallScene<Real>& to) {
    if (here.balls.empty() || !has_single_interiors(here)) return false;
    std::vector<uint32_t> balls, bodies;
    for (const uint32_t solid : here.convex) (is_ball(here.solids[solid]) ? balls : bodies).push_back(solid);
    const auto sphere = [&](uint32_t i) -> typename BallScene<Real>::Sphere {
        const Ball<Real>& ball = here.balls[here.solids[balls[i]].first_slab];
        return {ball.center, ball.radius * ball.radius};
    };
    return to.spheres.assign(uint32_t(balls.size()), sphere) &&
           to.sphere_solids.assign(uint32_t(balls.size()), [&](uint32_t i) { return balls[i]; }) &&
           to.bodies.assign(uint32_t(bodies.size()), [&](uint32_t i) { return bodies[i]; }) &&
           to.planes.assign(here.clusters.size, [&](uint32_t i) { return boxed_plane(here, i); });
}

}  // namespace

template <class Real>
std::unique_ptr<BallScene<Real>> ball_scene(const SceneView<Real>& here, const SceneView<Real>& there) {
    return in_default_rounding([&]() -> std::unique_ptr<BallScene<Real>> {
        auto scene = std::make_unique<BallScene<Real>>(BallScene<Real>{there, {}, {}, {}, {}});
        return assign(here, *scene) ? std::move(scene) : nullptr;
    });
}

template <class Real>
std::unique_ptr<ConstantScene<Real>> constant_scene(const SceneView<Real>& here, const SceneView<Real>& there) {
    return in_default_rounding([&]() -> std::unique_ptr<ConstantScene<Real>> {
        auto scene = std::make_unique<ConstantScene<Real>>();
        if (!assign(here, there, *scene)) return nullptr;
        plan_shadows(here, scene->plan);
        return scene;
    });
}

template <class Real>
bool fits_constant_scene(const SceneView<Real>& scene) {
    return assign(scene, scene, *std::make_unique<ConstantScene<Real>>());
}

template std::unique_ptr<BallScene<float>> ball_scene(const SceneView<float>&, const SceneView<float>&);
template std::unique_ptr<BallScene<double>> ball_scene(const SceneView<double>&, const SceneView<double>&);
template bool fits_constant_scene(const SceneView<float>&);
template bool fits_constant_scene(const SceneView<double>&);
template std::unique_ptr<ConstantScene<float>> constant_scene(const SceneView<float>&, const SceneView<float>&);
template std::unique_ptr<ConstantScene<double>> constant_scene(const SceneView<double>&, const SceneView<double>&);

}  // namespace cistula
