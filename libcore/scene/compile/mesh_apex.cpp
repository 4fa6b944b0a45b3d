#include "scene/compile/mesh_apex.h"

#include <atomic>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace cistula {
namespace {

using glm::dvec3;

/// min(1, tan(a / 2)), a the angle between a triangle and its neighbor at one edge, for both sides of the triangle.
struct AngleFactors {
    double inside = 1, outside = 1;
};

AngleFactors angle_factors(const dvec3& edge_start, const dvec3& edge, const dvec3& normal, const dvec3& opposite) {
    // In the plane perpendicular to the edge: x points into the triangle, y along its normal.
    const dvec3 inward = cross(normal, edge), to = opposite - edge_start;
    const double normal_length = length(normal);
    const double x = dot(to, inward) / (normal_length * length(edge)), y = dot(to, normal) / normal_length;
    const double r = square_root(x * x + y * y);
    if (!(r > 0)) return {};  // a neighbor of zero area has no direction
    if (x > 0 && y == 0) return {0, 0};
    const auto half_tangent = [&](double s) { return s <= 0 || x <= 0 ? 1 : s / (r + x); };
    return {half_tangent(-y), half_tangent(y)};
}

struct Neighbor {
    uint32_t number;
    std::array<dvec3, 3> corner;
    Box box;
};

bool apart(const Box& a, const Box& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return true;
    return false;
}

Box box_of(const std::array<dvec3, 3>& corner) {
    Box box;
    for (const dvec3& p : corner) box.add(p);
    return box;
}

/// Six times the signed volume of a tetrahedron: positive if a, b, c are counter-clockwise seen from `top`.
double volume(const dvec3& top, const dvec3& a, const dvec3& b, const dvec3& c) {
    return dot(top - a, cross(b - a, c - a));
}

/// Whether an open segment passes through a triangle. Touching with an end does not count.
bool crosses(const dvec3& from, double from_volume, const dvec3& to, const std::array<dvec3, 3>& q) {
    const double to_volume = volume(to, q[0], q[1], q[2]);
    if (!((from_volume > 0 && to_volume < 0) || (from_volume < 0 && to_volume > 0))) return false;
    const double a = volume(from, to, q[0], q[1]), b = volume(from, to, q[1], q[2]), c = volume(from, to, q[2], q[0]);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// The tetrahedron between a triangle and its apex on one side. It shrinks with the apex' height.
struct ApexView {
    std::array<dvec3, 3> corner;
    dvec3 centroid, up;  // unit normal on that side

    /// Whether another triangle intersects the tetrahedron other than through its base.
    bool blocked_by(const std::array<dvec3, 3>& q, double height) const {
        int shared[3] = {-1, -1, -1};  // for each corner of q the corner at the same position; -1: none
        bool above = false;
        for (int k = 0; k < 3; ++k) {
            for (int i = 0; i < 3; ++i)
                if (q[k] == corner[i]) shared[k] = i;
            above |= shared[k] < 0 && dot(up, q[k] - corner[0]) > 0;
        }
        if (!above) return false;
        const dvec3 apex = along(centroid, height, up);
        const double apex_volume = volume(apex, q[0], q[1], q[2]);
        for (int i = 0; i < 3; ++i)
            if (shared[0] != i && shared[1] != i && shared[2] != i && crosses(apex, apex_volume, corner[i], q))
                return true;
        for (int i = 0; i < 3; ++i) {  // the side opposite corner i
            const int b = (i + 1) % 3, c = (i + 2) % 3;
            const std::array<dvec3, 3> face{apex, corner[b], corner[c]};
            for (int k = 0; k < 3; ++k) {
                const int l = (k + 1) % 3;
                // An edge that starts at a corner of a side only touches that side.
                const bool touches = shared[k] == b || shared[k] == c || shared[l] == b || shared[l] == c;
                if (!touches && crosses(q[k], volume(q[k], face[0], face[1], face[2]), q[l], face)) return true;
            }
        }
        return holds(apex, q);
    }

    bool holds(const dvec3& apex, const std::array<dvec3, 3>& q) const {
        const dvec3 middle = (q[0] + q[1] + q[2]) / 3.0;
        if (!(dot(up, middle - corner[0]) > 0)) return false;
        for (int i = 0; i < 3; ++i) {
            const dvec3 &b = corner[(i + 1) % 3], &c = corner[(i + 2) % 3];
            const double there = volume(middle, apex, b, c), within = volume(centroid, apex, b, c);
            if (!(within > 0 ? there > 0 : there < 0)) return false;
        }
        return true;
    }
};

}  // namespace

ApexHeights apex_heights(const NormalizedMesh& mesh) {
    const MeshTopology& topology = mesh.topology();
    ApexHeights heights;
    for (auto& side : heights.side) side.resize(mesh.size());
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, mesh.size(), 1024), [&](const auto& range) {
        for (uint32_t t = range.begin(); t != range.end(); ++t) {
            const auto corner = mesh.triangle(t);
            const dvec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
            const double twice_area = length(normal);
            double inside = 1, outside = 1, perimeter = 0;
            for (uint32_t e = 0; e < 3; ++e) {
                const dvec3 edge = corner[(e + 1) % 3] - corner[e];
                perimeter += length(edge);
                // Half-edges are numbered in the source's winding; if that is flipped, edge e is the source's edge 2 -
                // e.
                const uint32_t own = 3 * t + (topology.flipped ? 2 - e : e);
                for (uint32_t h = topology.next_along_edge[own]; h != own; h = topology.next_along_edge[h]) {
                    const auto other = mesh.corners(h / 3);
                    const uint32_t other_edge = topology.flipped ? 2 - h % 3 : h % 3;
                    const dvec3 opposite = mesh.vertex(other[(other_edge + 2) % 3]);
                    const AngleFactors f = angle_factors(corner[e], edge, normal, opposite);
                    inside = min_or_second(f.inside, inside);
                    outside = min_or_second(f.outside, outside);
                }
            }
            const double inradius = perimeter > 0 ? twice_area / perimeter : 0;
            heights.side[0][t] = static_cast<float>(inradius / 8 * inside);
            heights.side[1][t] = static_cast<float>(inradius / 8 * outside);
        }
    });
    return heights;
}

uint32_t check_apexes(const NormalizedMesh& mesh, const Groups& groups, const Tree& tree, ApexHeights& heights) {
    std::atomic<uint32_t> blocked_for_good{0};
    const auto check = [&](uint32_t t, const std::array<dvec3, 3>& corner, const std::vector<const Neighbor*>& near) {
        const dvec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
        const double size = length(normal);
        if (!(size > 0)) return;
        for (int side = 0; side < 2; ++side) {
            const ApexView view{corner, (corner[0] + corner[1] + corner[2]) / 3.0,
                                side ? normal / size : -normal / size};
            float& height = heights.side[side][t];
            int halvings = 0;
            bool through = false;
            for (const Neighbor* other : near) {
                float lower = height;
                int more = 0;
                const auto blocked = [&] {
                    return lower > 0 && view.blocked_by(other->corner, static_cast<double>(lower));
                };
                bool free = !blocked();
                for (; !free && halvings + more < most_halvings; free = !blocked()) {
                    lower /= 2;
                    ++more;
                }
                // A triangle that passes through the base blocks every apex; no height is better than the one that the
                // other neighbors allow.
                through |= !free;
                if (!free) continue;
                height = lower;
                halvings += more;
            }
            blocked_for_good += through;
        }
    };

    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, groups.size(), 64), [&](const auto& range) {
        std::vector<Neighbor> around;
        std::vector<const Neighbor*> near;
        for (uint32_t g = range.begin(); g != range.end(); ++g) {
            Box reach;  // box of the apexes and corners of the whole group
            float highest = 0;
            for (uint32_t i = groups.first[g]; i < groups.first[g + 1]; ++i) {
                const uint32_t t = groups.order[i];
                for (const dvec3& p : mesh.triangle(t)) reach.add(p);
                highest = max_or_second(highest, max_or_second(heights.side[0][t], heights.side[1][t]));
            }
            reach.low -= dvec3{highest};
            reach.high += dvec3{highest};
            around.clear();
            for_each_in_box(tree, reach, [&](uint32_t other) {
                for (uint32_t i = groups.first[other]; i < groups.first[other + 1]; ++i) {
                    const auto corner = mesh.triangle(groups.order[i]);
                    const Box box = box_of(corner);
                    if (!apart(reach, box)) around.push_back({groups.order[i], corner, box});
                }
            });
            for (uint32_t i = groups.first[g]; i < groups.first[g + 1]; ++i) {
                const uint32_t t = groups.order[i];
                const auto corner = mesh.triangle(t);
                Box box = box_of(corner);
                const double h = max_or_second(heights.side[0][t], heights.side[1][t]);
                box.low -= dvec3{h};
                box.high += dvec3{h};
                near.clear();
                for (const Neighbor& other : around)
                    if (other.number != t && !apart(box, other.box)) near.push_back(&other);
                check(t, corner, near);
            }
        }
    });
    return blocked_for_good;
}

}  // namespace cistula
