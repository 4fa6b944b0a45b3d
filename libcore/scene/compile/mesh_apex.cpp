#include "scene/compile/mesh_apex.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace cistula {
namespace {

using glm::dvec3;

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

/// Whether an open segment passes through a triangle, given the volumes between its ends and the triangle. Touching
/// with an end does not count.
bool crosses(const dvec3& from, double from_volume, const dvec3& to, double to_volume, const std::array<dvec3, 3>& q) {
    if (!((from_volume > 0 && to_volume < 0) || (from_volume < 0 && to_volume > 0))) return false;
    const double a = volume(from, to, q[0], q[1]), b = volume(from, to, q[1], q[2]), c = volume(from, to, q[2], q[0]);
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Place of another triangle relative to a tetrahedron's base.
struct Placement {
    int shared[3] = {-1, -1, -1};  // for each of its corners the corner of the base at the same position; -1: none
    double highest = -INFINITY;    // of its corners over the base; shared ones are at 0
};

/// The tetrahedron between a triangle and its apex on one side. It shrinks with the apex' height.
struct ApexView {
    ApexView(const std::array<dvec3, 3>& base, const dvec3& unit_normal)
        : corner(base), centroid((base[0] + base[1] + base[2]) / 3.0), up(unit_normal) {}

    std::array<dvec3, 3> corner;
    dvec3 centroid, up;  // unit normal on that side

    Placement placement(const std::array<dvec3, 3>& q) const {
        Placement place;
        for (int k = 0; k < 3; ++k) {
            for (int i = 0; i < 3; ++i)
                if (q[k] == corner[i]) place.shared[k] = i;
            const double over = place.shared[k] < 0 ? dot(up, q[k] - corner[0]) : 0;
            place.highest = max_or_second(over, place.highest);
        }
        return place;
    }

    /// Whether another triangle intersects the tetrahedron other than through its base.
    bool blocked_by(const std::array<dvec3, 3>& q, const Placement& place, double height) const {
        const int* const shared = place.shared;
        const dvec3 apex = along(centroid, height, up);
        const dvec3 plane = cross(q[1] - q[0], q[2] - q[0]);
        const double apex_volume = dot(apex - q[0], plane);
        for (int i = 0; i < 3; ++i)
            if (shared[0] != i && shared[1] != i && shared[2] != i &&
                crosses(apex, apex_volume, corner[i], dot(corner[i] - q[0], plane), q))
                return true;
        for (int i = 0; i < 3; ++i) {  // the side opposite corner i
            const int b = (i + 1) % 3, c = (i + 2) % 3;
            const std::array<dvec3, 3> face{apex, corner[b], corner[c]};
            const dvec3 side = cross(face[1] - face[0], face[2] - face[0]);
            double beyond[3];
            for (int k = 0; k < 3; ++k) beyond[k] = dot(q[k] - face[0], side);
            for (int k = 0; k < 3; ++k) {
                const int l = (k + 1) % 3;
                // An edge that starts at a corner of a side only touches that side.
                const bool touches = shared[k] == b || shared[k] == c || shared[l] == b || shared[l] == c;
                if (!touches && crosses(q[k], beyond[k], q[l], beyond[l], face)) return true;
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

/// Cost of an exact test of a tetrahedron against a triangle, of which 1 is a look at its corners.
constexpr uint32_t cost_of_test = 8;

/// What may be spent on a group of triangles.
struct ApexLimits {
    size_t around;       // triangles that are looked at
    size_t cost_a_side;  // of tests, for each side of each triangle
};

/// Checks the apexes of groups, each for itself.
class ApexCheck {
  public:
    ApexCheck(const NormalizedMesh& mesh, const Groups& groups, const Tree& tree, ApexHeights& heights)
        : mesh_(mesh), groups_(groups), tree_(tree), heights_(heights) {}

    /// Lowers the heights of a group's triangles.
    ApexFaults check(uint32_t group, const ApexLimits& limits) {
        gather(group, limits.around);
        ApexFaults faults;
        for (uint32_t i = groups_.first[group]; i < groups_.first[group + 1]; ++i) {
            const uint32_t t = groups_.order[i];
            const auto corner = mesh_.triangle(t);
            Box box = box_of(corner);
            const double h = max_or_second(heights_.side[0][t], heights_.side[1][t]);
            box.low -= dvec3{h};
            box.high += dvec3{h};
            near_.clear();
            for (const Neighbor& other : around_)
                if (other.number != t && !apart(box, other.box)) near_.push_back(&other);
            check_triangle(t, corner, limits.cost_a_side, faults);
        }
        return faults;
    }

  private:
    /// Finds the triangles around a group's: all of them, or the first so many.
    void gather(uint32_t group, size_t most) {
        Box reach;  // box of the apexes and corners of the whole group
        float highest = 0;
        for (uint32_t i = groups_.first[group]; i < groups_.first[group + 1]; ++i) {
            const uint32_t t = groups_.order[i];
            for (const dvec3& p : mesh_.triangle(t)) reach.add(p);
            highest = max_or_second(highest, max_or_second(heights_.side[0][t], heights_.side[1][t]));
        }
        reach.low -= dvec3{highest};
        reach.high += dvec3{highest};
        around_.clear();
        size_t looked_at = 0;
        all_around_ = !any_in_box(tree_, reach, [&](uint32_t other) {
            for (uint32_t i = groups_.first[other]; i < groups_.first[other + 1]; ++i) {
                const auto corner = mesh_.triangle(groups_.order[i]);
                const Box box = box_of(corner);
                if (!apart(reach, box)) around_.push_back({groups_.order[i], corner, box});
            }
            looked_at += groups_.first[other + 1] - groups_.first[other];
            return looked_at > most;
        });
    }

    void check_triangle(uint32_t t, const std::array<dvec3, 3>& corner, size_t most_cost, ApexFaults& faults) {
        const dvec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
        const double size = length(normal);
        if (!(size > 0)) return;
        for (int side = 0; side < 2; ++side) {
            const ApexView view(corner, side ? normal / size : -normal / size);
            float& height = heights_.side[side][t];
            int halvings = 0;
            size_t cost = 0;
            bool through = false, all = all_around_;
            for (const Neighbor* other : near_) {
                if (cost >= most_cost) {
                    all = false;
                    break;
                }
                ++cost;
                const Placement place = view.placement(other->corner);
                const auto blocked = [&](float at) {
                    cost += cost_of_test;
                    return view.blocked_by(other->corner, place, static_cast<double>(at));
                };
                if (!(height > 0) || !(place.highest > 0)) continue;
                if (!blocked(height)) continue;
                // A triangle that passes through the base blocks every apex; no height is better than the one that the
                // other neighbors allow.
                float lower = height;
                int more = 0;
                bool free = false;
                while (!free && halvings + more < most_halvings) {
                    lower /= 2;
                    ++more;
                    free = !blocked(lower);
                }
                through |= !free;
                if (!free) continue;
                height = lower;
                halvings += more;
            }
            faults.crossed += through;
            faults.unchecked += !through && !all;
        }
    }

    const NormalizedMesh& mesh_;
    const Groups& groups_;
    const Tree& tree_;
    ApexHeights& heights_;
    std::vector<Neighbor> around_;
    bool all_around_ = true;  // they are all in around_
    std::vector<const Neighbor*> near_;
};

}  // namespace

ApexFaults check_apexes(const NormalizedMesh& mesh, const Groups& groups, const Tree& tree, ApexHeights& heights) {
    // First every side may take an equal share of the work. Groups that need more, if they are few, share as much
    // again.
    const size_t most_work = 800 * std::max<size_t>(mesh.size(), 100'000);
    const size_t equal_share = most_work / (2 * std::max<size_t>(mesh.size(), 1));
    const ApexLimits first_limits{equal_share, equal_share};
    const ApexHeights initial = heights;
    std::vector<ApexFaults> faults(groups.size());
    const auto check = [&](const auto& range, const ApexLimits& limits, const auto& group_at) {
        ApexCheck checker(mesh, groups, tree, heights);
        for (uint32_t i = range.begin(); i != range.end(); ++i)
            faults[group_at(i)] = checker.check(group_at(i), limits);
    };
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, groups.size(), 64),
                      [&](const auto& range) { check(range, first_limits, [](uint32_t i) { return i; }); });

    std::vector<uint32_t> rest;
    size_t sides = 0;
    for (uint32_t g = 0; g < groups.size(); ++g)
        if (faults[g].unchecked > 0) {
            rest.push_back(g);
            sides += 2 * (groups.first[g + 1] - groups.first[g]);
        }
    const size_t share = rest.empty() ? 0 : most_work / sides;
    if (share >= 2 * equal_share) {
        for (const uint32_t g : rest)
            for (uint32_t i = groups.first[g]; i < groups.first[g + 1]; ++i)
                for (int side = 0; side < 2; ++side)
                    heights.side[side][groups.order[i]] = initial.side[side][groups.order[i]];
        const ApexLimits limits{4 * share, share};
        tbb::parallel_for(tbb::blocked_range<uint32_t>(0, static_cast<uint32_t>(rest.size()), 1),
                          [&](const auto& range) { check(range, limits, [&](uint32_t i) { return rest[i]; }); });
    }
    ApexFaults sum;
    for (const ApexFaults& f : faults) {
        sum.crossed += f.crossed;
        sum.unchecked += f.unchecked;
    }
    return sum;
}

}  // namespace cistula
