#include "scene/compile/lights/compile_lights.h"

#include <algorithm>
#include <cmath>

#include "cistula/lights/edge_lights.h"

namespace cistula {
namespace {

template <class Real>
SlabGroup<Real>& first_group(CompiledScene<Real>& scene, uint32_t solid) {
    return scene.slab_groups[scene.solids[solid].first_group];
}

/// Whether no sphere around another solid's lights overlaps this solid.
template <class Real>
bool stands_apart(CompiledScene<Real>& scene, uint32_t solid) {
    return std::all_of(scene.convex.begin(), scene.convex.end(), [&](uint32_t other) {
        if (is_ball(scene.solids[other])) return true;
        const double lights = double(first_group(scene, other).light_square);
        if (other == solid || !(lights > 0)) return true;
        const Vec3<double> between =
            Vec3<double>(scene.solids[solid].center) - Vec3<double>(scene.solids[other].center);
        const double reach = std::sqrt(lights) + std::sqrt(double(scene.solids[solid].padded_square));
        return dot(between, between) > reach * reach;
    });
}

}  // namespace

template <class Real>
void reach_edge_lights(CompiledScene<Real>& scene, const std::vector<uint32_t>& owners) {
    bool known = scene.convex.size() <= most_solids_of_edge_lights;
    for (const uint32_t owner : owners) known = known && owner != no_solid;
    for (const uint32_t solid : scene.convex)
        known = known && scene.solids[solid].slab_count <= most_slabs_of_edge_lights;
    for (const uint32_t solid : scene.convex) {
        if (is_ball(scene.solids[solid])) continue;
        first_group(scene, solid).light_reach = known ? Real(0) : RealTraits<Real>::infinity;
        first_group(scene, solid).light_square = -RealTraits<Real>::infinity;
    }
    if (!known) return;
    for (size_t i = 0; i < owners.size(); ++i) {
        SlabGroup<Real>& group = first_group(scene, owners[i]);
        const VisibleLight<Real>& light = scene.visible_lights[i];
        const Vec3<double> out = Vec3<double>(light.center) - Vec3<double>(scene.solids[owners[i]].center);
        const double radius = double(light.radius);
        const double far = std::sqrt(dot(out, out)) + radius;
        group.light_reach = max_or_second(Real(radius + light_slack * double(scene.extent)), group.light_reach);
        group.light_square = max_or_second(Real(far * far) + Real(sphere_padding), group.light_square);
    }
    for (const uint32_t solid : scene.convex) {
        if (is_ball(scene.solids[solid])) continue;
        SlabGroup<Real>& group = first_group(scene, solid);
        group.lights_apart = group.light_reach > Real(0) && stands_apart(scene, solid);
    }
}

template void reach_edge_lights<float>(CompiledScene<float>&, const std::vector<uint32_t>&);
template void reach_edge_lights<double>(CompiledScene<double>&, const std::vector<uint32_t>&);

}  // namespace cistula
