#include "scene/compile/lights/light_distance.h"

#include <algorithm>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

/// The distance that counts for a face on which a light lies, times M: such a face is lit only where rounding tilts it
/// by 16 u M over that distance.
constexpr double incident_distance = 0x1p-4;
/// The greatest length of a triangle over its height of which that is true.
constexpr double incident_ratio = 64;
/// How far from the face's plane such a light is at most, times the rounding: half of the 16 u M of rules 5.
constexpr double in_plane = 0.25;

/// Whether a light needs its distance from what is `box_distance` away at least.
bool is_near(const NormalizedLight& light, double box_distance, double extent) {
    return light.falloff && light.lights() && max_or_second(light.radius, box_distance) < small_reach * extent;
}

double distance_to_segment(const dvec3& a, const dvec3& b, const dvec3& p) {
    const dvec3 along = b - a;
    const dvec3 from = p - a;
    const double square = dot(along, along);
    const double share = square > 0 ? clamped(dot(from, along) / square, 0.0, 1.0) : 0;
    return length(from - share * along);
}

/// Whether a light lies in the plane of a triangle, and the triangle's normal is exact enough for incident_distance.
bool is_in_plane(const std::array<dvec3, 3>& corner, const dvec3& p, double tolerance) {
    const dvec3 ab = corner[1] - corner[0];
    const dvec3 bc = corner[2] - corner[1];
    const dvec3 ca = corner[0] - corner[2];
    const double longest = max_or_second(dot(ab, ab), max_or_second(dot(bc, bc), dot(ca, ca)));
    const dvec3 normal = cross(ab, bc);
    const double size = length(normal);
    return incident_ratio * size >= longest && magnitude(dot(normal, p - corner[0])) <= tolerance * size;
}

Box box_at(const TreeNode& node, int side) {
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = static_cast<double>(node.low[side][axis]);
        box.high[axis] = static_cast<double>(node.high[side][axis]);
    }
    return box;
}

/// A lower bound on the least of of_item(item) over a tree's items, which is no less than the distance of a point from
/// the item's box. It is more than half of the least.
template <class Distance>
double least_distance(const Tree& tree, const dvec3& p, const Distance& of_item) {
    struct Waiting {
        int32_t node;
        double distance;
    };
    double nearest = INFINITY, passed_over = INFINITY;
    std::array<Waiting, max_tree_depth + 2> stack{{{0, 0.0}}};
    for (size_t size = tree.nodes.empty() ? 0 : 1; size > 0;) {
        const Waiting at = stack[--size];
        if (at.distance > nearest / 2) {
            passed_over = min_or_second(at.distance, passed_over);
            continue;
        }
        const TreeNode& node = tree.nodes[static_cast<size_t>(at.node)];
        Waiting children[2];
        size_t count = 0;
        for (int side = 0; side < 2; ++side) {
            const Box box = box_at(node, side);
            if (box.empty()) continue;
            if (node.child[side] >= 0) {
                children[count++] = {node.child[side], distance_to_box(box, p)};
                continue;
            }
            for (uint32_t i = 0; i < node.count[side]; ++i)
                nearest = min_or_second(of_item(tree.items[static_cast<size_t>(~node.child[side]) + i]), nearest);
        }
        if (count == 2 && children[0].distance < children[1].distance) std::swap(children[0], children[1]);
        for (size_t i = 0; i < count; ++i) stack[size++] = children[i];
    }
    return min_or_second(passed_over, nearest);
}

bool lies_on(const std::vector<LightFace>& faces, uint32_t solid, uint32_t face) {
    return std::any_of(faces.begin(), faces.end(),
                       [&](const LightFace& on) { return on.incident.solid == solid && on.incident.face == face; });
}

}  // namespace

double distance_to_triangle(const std::array<dvec3, 3>& corner, const dvec3& p) {
    const dvec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    bool over = dot(normal, normal) > 0;
    double nearest = INFINITY;
    for (size_t e = 0; e < 3; ++e) {
        const dvec3 &a = corner[e], &b = corner[(e + 1) % 3];
        over = over && dot(cross(b - a, p - a), normal) >= 0;
        nearest = min_or_second(distance_to_segment(a, b, p), nearest);
    }
    return over ? magnitude(dot(normal, p - corner[0])) / length(normal) : nearest;
}

double distance_to_box(const Box& box, const dvec3& p) {
    dvec3 d;
    for (int axis = 0; axis < 3; ++axis)
        d[axis] = max_or_second(max_or_second(box.low[axis] - p[axis], p[axis] - box.high[axis]), 0.0);
    return length(d);
}

std::vector<LightDistance> light_distances(const std::vector<NormalizedLight>& lights, const ConvexSolid& solid,
                                           const LightFaces& faces, double extent, double rounding) {
    std::vector<LightDistance> distances;
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const dvec3& p = lights[i].position;
        if (!is_near(lights[i], distance_to_box(solid.box, p), extent)) continue;
        double outside = -INFINITY, within = INFINITY;
        for (uint32_t slab = 0; slab < solid.planes.size(); ++slab) {
            const PlanePair& planes = solid.planes[slab];
            const double n = dot(planes.normal, p);
            const double beyond[2] = {planes.low - n, n - planes.high};
            for (uint32_t side = 0; side < 2; ++side) {
                const bool on =
                    lies_on(faces[i], solid.solid, 2 * slab + side) && magnitude(beyond[side]) <= in_plane * rounding;
                outside = max_or_second(on ? 0.0 : beyond[side], outside);
                within = min_or_second(on ? incident_distance * extent : magnitude(beyond[side]), within);
            }
        }
        distances.push_back({i, (outside > 0 ? outside : within) - rounding});
    }
    return distances;
}

std::vector<LightDistance> light_distances(const std::vector<NormalizedLight>& lights, const PlacedBall& ball,
                                           double extent, double rounding) {
    std::vector<LightDistance> distances;
    for (uint32_t i = 0; i < lights.size(); ++i)
        if (is_near(lights[i], distance_to_box(ball.box(), lights[i].position), extent))
            distances.push_back({i, ball.distance(lights[i].position) - rounding});
    return distances;
}

std::vector<LightDistance> light_distances(const std::vector<NormalizedLight>& lights, const PlacedDisk& disk,
                                           const LightFaces& faces, double extent, double rounding) {
    std::vector<LightDistance> distances;
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const double distance = disk.distance(lights[i].position);
        const bool on = !faces[i].empty() && distance <= in_plane * rounding;
        if (disk.is_endless() ? lights[i].falloff && lights[i].lights() : is_near(lights[i], distance, extent))
            distances.push_back({i, (on ? incident_distance * extent : distance) - rounding});
    }
    return distances;
}

std::vector<LightDistance> light_distances(const std::vector<NormalizedLight>& lights, const NormalizedMesh& mesh,
                                           const Groups& groups, const Tree& tree, uint32_t solid,
                                           uint32_t first_triangle, const LightFaces& faces, double extent,
                                           double rounding) {
    std::vector<LightDistance> distances;
    if (tree.nodes.empty()) return distances;
    Box around;
    for (int side = 0; side < 2; ++side)
        if (const Box box = box_at(tree.nodes[0], side); !box.empty()) around.add(box.low), around.add(box.high);
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const dvec3& p = lights[i].position;
        if (!is_near(lights[i], distance_to_box(around, p), extent)) continue;
        const double least = least_distance(tree, p, [&](uint32_t group) {
            double nearest = INFINITY;
            for (uint32_t k = groups.first[group]; k < groups.first[group + 1]; ++k) {
                const auto corners = mesh.triangle(groups.order[k]);
                const bool on = lies_on(faces[i], solid, first_triangle + groups.order[k]) &&
                                is_in_plane(corners, p, in_plane * rounding);
                nearest = min_or_second(on ? incident_distance * extent : distance_to_triangle(corners, p), nearest);
            }
            return nearest;
        });
        distances.push_back({i, least - rounding});
    }
    return distances;
}

}  // namespace cistula
