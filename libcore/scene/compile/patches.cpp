#include "scene/compile/patches.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cistula/numerics/vec.h"
#include "scene/trees/tree_build.h"

namespace cistula {
namespace {

using glm::dvec3;

/// A patch with its plane and area; none if it has no area.
std::optional<Patch> make_patch(uint32_t solid, int32_t convex, uint32_t face, std::vector<dvec3> corners) {
    dvec3 across(0);
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        across += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    const double twice = std::sqrt(dot(across, across));
    if (!(twice > 0)) return std::nullopt;
    Patch patch{solid, convex, face, std::move(corners), {}, across / twice, 0, twice / 2};
    for (const dvec3& p : patch.corners) patch.box.add(p);
    patch.offset = dot(patch.normal, middle(patch.corners));
    return patch;
}

/// Whether the patches are apart along an in-plane normal of one of a's edges.
bool apart(const Patch& a, const Patch& b, double least) {
    for (size_t i = 0; i < a.corners.size(); ++i) {
        const dvec3 edge = a.corners[(i + 1) % a.corners.size()] - a.corners[i];
        dvec3 out = cross(edge, a.normal);
        const double length = std::sqrt(dot(out, out));
        if (!(length > 0)) continue;
        out /= length;
        double nearest = INFINITY, widest = 0;
        for (const dvec3& p : b.corners) nearest = std::min(nearest, dot(out, p - a.corners[i]));
        for (const dvec3& p : a.corners) widest = std::min(widest, dot(out, p - a.corners[i]));
        if (nearest > -least || widest > -least) return true;
    }
    return false;
}

}  // namespace

double Patch::farthest(const Patch& other) const {
    double farthest = 0;
    for (const dvec3& p : other.corners) farthest = std::max(farthest, std::abs(dot(normal, p) - offset));
    return farthest;
}

dvec3 middle(const std::vector<dvec3>& corners) {
    dvec3 sum(0);
    for (const dvec3& p : corners) sum += p;
    return sum / double(corners.size());
}

bool touch(const Box& a, const Box& b, double pad) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.low[axis] - pad > b.high[axis] + pad || b.low[axis] - pad > a.high[axis] + pad) return false;
    return true;
}

Box padded(const Box& box, double pad) {
    return {box.low - dvec3(pad), box.high + dvec3(pad)};
}

bool overlap(const Patch& a, const Patch& b, double least) {
    return !apart(a, b, least) && !apart(b, a, least);
}

template <class Real>
std::vector<Patch> touching_patches(const CompiledScene<Real>& scene, const std::vector<ConvexSolid>& convex,
                                    const std::vector<Box>& boxes, double pad) {
    std::vector<RTCBuildPrimitive> primitives;
    for (uint32_t i = 0; i < boxes.size(); ++i)
        if (!boxes[i].empty()) primitives.push_back(padded_primitive(boxes[i], pad, i));
    const Tree tree = build_tree(primitives, 0);
    const auto meets_another = [&](const Box& box, uint32_t solid) {
        return any_in_box(tree, padded(box, pad),
                          [&](uint32_t other) { return other != solid && touch(box, boxes[other], pad); });
    };
    std::vector<bool> near(boxes.size());
    for (uint32_t i = 0; i < boxes.size(); ++i) near[i] = !boxes[i].empty() && meets_another(boxes[i], i);

    std::vector<uint32_t> triangles(scene.solids.size());
    for (const Cluster<Real>& cluster : scene.clusters) triangles[cluster.solid] += cluster.count;
    std::vector<Patch> patches;
    const auto with_own = [&](uint32_t solid) {
        return scene.solids[solid].kind == SolidKind::sheet && triangles[solid] <= most_with_own;
    };
    const auto add = [&](std::optional<Patch> patch) {
        if (!patch) return;
        patch->with_own = with_own(patch->solid);
        if (patch->with_own || meets_another(patch->box, patch->solid)) patches.push_back(std::move(*patch));
    };
    for (int32_t i = 0; i < int32_t(convex.size()); ++i) {
        const ConvexSolid& solid = convex[size_t(i)];
        if (!near[solid.solid]) continue;
        for (uint32_t face = 0; face < 2 * solid.planes.size(); ++face)
            if (std::vector<dvec3> corners = solid.face_corners(face); !corners.empty())
                add(make_patch(solid.solid, i, face, std::move(corners)));
    }
    for (const Cluster<Real>& cluster : scene.clusters) {
        if (!near[cluster.solid] && !with_own(cluster.solid)) continue;
        for (uint32_t lane = 0; lane < cluster.count; ++lane) {
            std::vector<dvec3> corners;
            for (const auto& corner : cluster.corner)
                corners.emplace_back(corner[0][lane], corner[1][lane], corner[2][lane]);
            add(make_patch(cluster.solid, -1, cluster.triangle[lane], std::move(corners)));
        }
    }
    return patches;
}

template std::vector<Patch> touching_patches(const CompiledScene<float>&, const std::vector<ConvexSolid>&,
                                             const std::vector<Box>&, double);
template std::vector<Patch> touching_patches(const CompiledScene<double>&, const std::vector<ConvexSolid>&,
                                             const std::vector<Box>&, double);

}  // namespace cistula
