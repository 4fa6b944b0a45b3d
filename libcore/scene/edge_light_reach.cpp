#include "scene/edge_light_reach.h"

#include <cmath>

#include "cistula/edge_lights.h"

namespace cistula {
namespace {

/// How far a light's center may be off a face, and what rounding adds to all that is asked of a line, in units of M.
constexpr double off_face = 0x1p-16, slack = 0x1p-14;

/// Whether a point lies on two faces of a solid.
template <class Real>
bool on_edge(const CompiledScene<Real>& scene, const Solid& solid, const Vec3<double>& point) {
    const double near = off_face * double(scene.extent);
    int faces = 0;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = scene.slabs[solid.first_slab + i];
        const double n = dot(Vec3<double>(slab.normal), point), below = n - double(slab.low), above = double(slab.high) - n;
        if (below < -near || above < -near) return false;
        faces += (below <= near ? 1 : 0) + (above <= near ? 1 : 0);
    }
    return faces > 1;
}

/// Of how many of the lights are taken in.
template <class Real>
size_t reach_lights(CompiledScene<Real>& scene, const Solid& solid, std::vector<bool>& taken) {
    SlabGroup<Real>& group = scene.slab_groups[solid.first_group];
    const double extent = double(scene.extent);
    double reach = 0, square = 0;
    size_t count = 0;
    for (size_t i = 0; i < taken.size(); ++i) {
        const Vec3<double> center(scene.seen_lights[i].center), out = center - Vec3<double>(solid.center);
        if (taken[i] || !on_edge(scene, solid, center)) continue;
        taken[i] = true;
        ++count;
        const double radius = double(scene.seen_lights[i].radius), far = std::sqrt(dot(out, out)) + radius;
        reach = greatest(reach, radius + (off_face + slack) * extent);
        square = greatest(square, far * far);
    }
    group.light_reach = Real(reach);
    group.light_square = count > 0 ? Real(square) + Real(sphere_padding) : -RealTraits<Real>::infinity;
    return count;
}

/// Whether no sphere around another solid's lights reaches into this one.
template <class Real>
bool stands_apart(const CompiledScene<Real>& scene, const Solid& solid) {
    for (const uint32_t index : scene.convex) {
        const Solid& other = scene.solids[index];
        const Vec3<double> between = Vec3<double>(solid.center) - Vec3<double>(other.center);
        const double lights = double(scene.slab_groups[other.first_group].light_square);
        const double reach = std::sqrt(lights) + std::sqrt(double(solid.padded_square));
        if (&other != &solid && lights > 0 && dot(between, between) <= reach * reach) return false;
    }
    return true;
}

}  // namespace

template <class Real>
void reach_edge_lights(CompiledScene<Real>& scene) {
    std::vector<bool> taken(scene.seen_lights.size());
    size_t count = 0;
    bool few = scene.convex.size() <= most_solids_of_edge_lights;
    for (const uint32_t index : scene.convex) few = few && scene.solids[index].slab_count <= most_slabs_of_edge_lights;
    for (const uint32_t index : scene.convex)
        if (few) count += reach_lights(scene, scene.solids[index], taken);
    const bool all = count == taken.size();
    for (const uint32_t index : scene.convex) {
        const Solid& solid = scene.solids[index];
        SlabGroup<Real>& group = scene.slab_groups[solid.first_group];
        if (!all) group.light_reach = RealTraits<Real>::infinity;
        group.lights_apart = all && group.light_reach > Real(0) && stands_apart(scene, solid);
    }
}

template void reach_edge_lights<float>(CompiledScene<float>&);
template void reach_edge_lights<double>(CompiledScene<double>&);

}  // namespace cistula
