#include "scene/compile/meshes/mesh_apex.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "cistula/lanes/lanes.h"

namespace cistula {
namespace {

using glm::dvec3;

/// Triangles are looked at side by side: each lane has the bits that a number would have.
constexpr int width = lane_bytes / int(sizeof(double));
using Numbers = Lanes<double, width>;
using Vectors = Vec3<Numbers>;
using Mask = Numbers::Mask;

/// Some triangles near a group's.
struct NeighborBlock {
    LaneVectors<Numbers> corner[3], low, high;  // and their boxes
    uint32_t number[width];
};

bool apart(const Box& a, const Box& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return true;
    return false;
}

Mask meet(const Box& box, const NeighborBlock& block) {
    const Vectors low = block.low.all();
    const Vectors high = block.high.all();
    const Vectors box_low = spread<Numbers>(box.low);
    const Vectors box_high = spread<Numbers>(box.high);
    return (box_low.x <= high.x) & (low.x <= box_high.x) & (box_low.y <= high.y) & (low.y <= box_high.y) &
           (box_low.z <= high.z) & (low.z <= box_high.z);
}

/// Six times the signed volume of a tetrahedron: positive if a, b, c are counter-clockwise seen from `top`.
Numbers volume(const Vectors& top, const Vectors& a, const Vectors& b, const Vectors& c) {
    return dot(top - a, cross(b - a, c - a));
}

Mask have_opposite_signs(const Numbers& a, const Numbers& b) {
    const Numbers zero(0);
    return ((a > zero) & (b < zero)) | ((a < zero) & (b > zero));
}

/// Whether a line, from its start to its end, passes by the sides of a triangle alike. The segment between crosses the
/// triangle if its ends lie on either side of it.
Mask passes_through(const Vectors& from, const Vectors& to, const Vectors& q0, const Vectors& q1, const Vectors& q2) {
    const Numbers zero(0), a = volume(from, to, q0, q1), b = volume(from, to, q1, q2), c = volume(from, to, q2, q0);
    return ((a >= zero) & (b >= zero) & (c >= zero)) | ((a <= zero) & (b <= zero) & (c <= zero));
}

/// Corners of some triangles as they lie to another triangle, the base of tetrahedra.
struct PlacedCorners {
    /// `used`: the lanes that hold a triangle.
    PlacedCorners(const std::array<dvec3, 3>& base, const dvec3& unit_normal, const LaneVectors<Numbers> (&at)[3],
                  uint32_t used) {
        for (int k = 0; k < 3; ++k) corner[k] = at[k].all();
        const Vectors b[3] = {spread<Numbers>(base[0]), spread<Numbers>(base[1]), spread<Numbers>(base[2])};
        for (Mask& one : touched) one = Mask(false);
        Mask above(false), below(false);
        for (int k = 0; k < 3; ++k) {
            Mask shared[3];
            for (int i = 0; i < 3; ++i) {
                shared[i] = (corner[k].x == b[i].x) & (corner[k].y == b[i].y) & (corner[k].z == b[i].z);
                touched[i] |= shared[i];
            }
            for (int i = 0; i < 3; ++i) off_side[k][i] = !(shared[(i + 1) % 3] | shared[(i + 2) % 3]);
            const Numbers over = dot(spread<Numbers>(unit_normal), corner[k] - b[0]);
            const Mask own = off_side[k][0] & !shared[0];
            above |= own & (over > Numbers(0));
            below |= own & (over < Numbers(0));
        }
        rises[0] = below.bits() & used;
        rises[1] = above.bits() & used;
    }

    uint32_t rises[2];  // lanes with a corner over the base, on each side of it
    Vectors corner[3];
    Mask touched[3];      // by a corner of the triangle: each corner of the base
    Mask off_side[3][3];  // each corner of the triangle is at neither end of the base's edge opposite corner i
};

/// What the exact test needs, of the first `count` lanes.
struct PlacedBlock : PlacedCorners {
    PlacedBlock(const std::array<dvec3, 3>& base, const dvec3& unit_normal, const LaneVectors<Numbers> (&at)[3],
                int number)
        : PlacedCorners(base, unit_normal, at, (1u << number) - 1), count(number) {
        normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
        middle = (corner[0] + corner[1] + corner[2]) / Numbers(3);
        for (int i = 0; i < 3; ++i) base_volume[i] = dot(spread<Numbers>(base[size_t(i)]) - corner[0], normal);
    }

    int count;
    Vectors normal, middle;
    Numbers base_volume[3];  // of each corner of the base, over the triangle
};

/// The tetrahedron between a triangle and its apex on one side. It shrinks with the apex' height.
class ApexView {
  public:
    ApexView(const std::array<dvec3, 3>& base, const dvec3& unit_normal)
        : corner_(base), centroid_((base[0] + base[1] + base[2]) / 3.0), up_(unit_normal) {}

    /// Which of some triangles lie beyond one of the tetrahedron's sides, but for corners at the ends of its edge: they
    /// do not intersect the tetrahedron, nor any that is lower.
    uint32_t parted_from(const PlacedCorners& q, float height) {
        set_height(height);
        const Numbers zero(0);
        const Vectors apex = spread<Numbers>(apex_);
        const Vectors from_apex[3] = {q.corner[0] - apex, q.corner[1] - apex, q.corner[2] - apex};
        Mask parted(false);
        for (int i = 0; i < 3; ++i) {
            if (within_[i] == 0) continue;
            const Vectors outward = spread<Numbers>(within_[i] > 0 ? -side_[i] : side_[i]);
            Mask beyond(true);
            for (int k = 0; k < 3; ++k) beyond &= (!q.off_side[k][i]) | (dot(from_apex[k], outward) > zero);
            parted |= beyond;
        }
        return parted.bits();
    }

    /// Which of some triangles intersect the tetrahedron of that height other than through its base, of those that rise
    /// over it.
    uint32_t blocked_by(const PlacedBlock& q, uint32_t rising, float height) {
        set_height(height);
        const Mask wanted = Mask::of_bits(rising);
        const Vectors apex = spread<Numbers>(apex_);
        const Vectors base[3] = {spread<Numbers>(corner_[0]), spread<Numbers>(corner_[1]), spread<Numbers>(corner_[2])};
        Mask blocked = holds(q.middle, apex, base[0]) & wanted;
        const Numbers apex_volume = dot(apex - q.corner[0], q.normal);
        for (int i = 0; i < 3; ++i) {
            const Mask across = have_opposite_signs(apex_volume, q.base_volume[i]) & !q.touched[i] & wanted;
            if (any(across)) blocked |= across & passes_through(apex, base[i], q.corner[0], q.corner[1], q.corner[2]);
        }
        const Vectors from_apex[3] = {q.corner[0] - apex, q.corner[1] - apex, q.corner[2] - apex};
        for (int i = 0; i < 3; ++i) {  // the side opposite corner i
            const Vectors side = spread<Numbers>(side_[i]);
            Numbers beyond[3];
            for (int k = 0; k < 3; ++k) beyond[k] = dot(from_apex[k], side);
            for (int k = 0; k < 3; ++k) {
                const int l = (k + 1) % 3;
                // An edge that starts at a corner of a side only touches that side.
                const Mask across =
                    have_opposite_signs(beyond[k], beyond[l]) & q.off_side[k][i] & q.off_side[l][i] & wanted;
                if (any(across))
                    blocked |=
                        across & passes_through(q.corner[k], q.corner[l], apex, base[(i + 1) % 3], base[(i + 2) % 3]);
            }
        }
        return blocked.bits();
    }

  private:
    void set_height(float height) {
        if (height == height_) return;
        height_ = height;
        apex_ = along(centroid_, static_cast<double>(height), up_);
        for (int i = 0; i < 3; ++i) {
            side_[i] = cross(corner_[(i + 1) % 3] - apex_, corner_[(i + 2) % 3] - apex_);
            within_[i] = dot(centroid_ - apex_, side_[i]);
        }
    }

    /// Which points lie in the tetrahedron.
    Mask holds(const Vectors& points, const Vectors& apex, const Vectors& first) const {
        const Numbers zero(0);
        Mask in = dot(spread<Numbers>(up_), points - first) > zero;
        for (int i = 0; i < 3; ++i) {
            const Numbers there = dot(points - apex, spread<Numbers>(side_[i]));
            in &= within_[i] > 0 ? there > zero : there < zero;
        }
        return in;
    }

    std::array<dvec3, 3> corner_;
    dvec3 centroid_, up_;  // unit normal on that side
    float height_ = -1;
    dvec3 apex_, side_[3];  // normals of the sides opposite each corner, not of unit length
    double within_[3];      // of the centroid, over each side
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
            const dvec3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
            const double size = length(normal);
            if (size > 0) check_triangle(t, corner, normal / size, limits.cost_a_side, faults);
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
        size_t found = 0;
        all_around_ = !any_in_box(tree_, reach, [&](uint32_t other) {
            for (uint32_t i = groups_.first[other]; i < groups_.first[other + 1]; ++i) {
                const auto corner = mesh_.triangle(groups_.order[i]);
                const Box box = box_of(corner);
                if (apart(reach, box)) continue;
                if (found % width == 0) around_.emplace_back();
                const int lane = int(found++ % width);
                NeighborBlock& block = around_.back();
                for (size_t k = 0; k < 3; ++k) block.corner[k].set(lane, corner[k]);
                block.low.set(lane, box.low);
                block.high.set(lane, box.high);
                block.number[lane] = groups_.order[i];
            }
            looked_at += groups_.first[other + 1] - groups_.first[other];
            return looked_at > most;
        });
        if (around_.empty()) return;
        for (int lane = int((found - 1) % width) + 1; lane < width; ++lane) {  // boxes that meet none
            around_.back().low.set(lane, dvec3(INFINITY));
            around_.back().high.set(lane, dvec3(-INFINITY));
        }
    }

    /// Places the triangles around one: all of them, or the first so many. Returns whether these are all.
    bool place_near(uint32_t t, const Box& reach, const std::array<dvec3, 3>& corner, const dvec3& unit_normal,
                    size_t most) {
        near_.clear();
        LaneVectors<Numbers> at[3] = {};
        size_t found = 0;
        bool all = true;
        for (const NeighborBlock& block : around_)
            for_each_lane(meet(reach, block), [&](int from) {
                if (block.number[from] == t) return;
                if (found == most) {
                    all = false;
                    return;
                }
                const int lane = int(found++ % width);
                for (int k = 0; k < 3; ++k) at[k].set(lane, block.corner[k][from]);
                if (lane == width - 1) near_.emplace_back(corner, unit_normal, at, width);
            });
        if (found % width != 0) near_.emplace_back(corner, unit_normal, at, int(found % width));
        return all && all_around_;
    }

    /// Whether all triangles around one lie beyond a side of its tetrahedra, as they do in most places of most meshes,
    /// and could be looked at for that cost.
    bool is_free(uint32_t t, const Box& reach, const std::array<dvec3, 3>& corner, const dvec3& unit_normal,
                 size_t most_cost) const {
        if (!all_around_) return false;
        ApexView view[2] = {{corner, -unit_normal}, {corner, unit_normal}};
        size_t cost[2] = {0, 0};
        for (const NeighborBlock& block : around_) {
            uint32_t near = meet(reach, block).bits();
            for (int lane = 0; lane < width; ++lane)
                if (block.number[lane] == t) near &= ~(1u << lane);
            if (near == 0) continue;
            const PlacedCorners q(corner, unit_normal, block.corner, near);
            for (size_t side = 0; side < 2; ++side) {
                const float height = heights_.side[side][t];
                const uint32_t rising = height > 0 ? q.rises[side] : 0;
                cost[side] += size_t(std::popcount(near)) + cost_of_test * size_t(std::popcount(rising));
                if (rising != 0 && (rising & ~view[side].parted_from(q, height)) != 0) return false;
            }
        }
        return cost[0] <= most_cost && cost[1] <= most_cost;
    }

    void check_triangle(uint32_t t, const std::array<dvec3, 3>& corner, const dvec3& unit_normal, size_t most_cost,
                        ApexFaults& faults) {
        Box reach = box_of(corner);
        const double h = max_or_second(heights_.side[0][t], heights_.side[1][t]);
        reach.low -= dvec3{h};
        reach.high += dvec3{h};
        if (is_free(t, reach, corner, unit_normal, most_cost)) return;
        const bool all_placed = place_near(t, reach, corner, unit_normal, most_cost);
        for (int side = 0; side < 2; ++side) {
            ApexView view(corner, side ? unit_normal : -unit_normal);
            Lowering at{heights_.side[side][t]};
            const bool all = std::all_of(near_.begin(), near_.end(), [&](const PlacedBlock& block) {
                return lower(view, block, block.rises[side], most_cost, at);
            });
            faults.crossed += at.through;
            faults.unchecked += !at.through && !(all && all_placed);
        }
    }

    /// An apex that is lowered.
    struct Lowering {
        float& height;
        int halvings = 0;
        size_t cost = 0;       // of what was looked at
        bool through = false;  // a triangle passes through the base
    };

    /// Lowers an apex until none of some triangles, of which those that rise over the base may, block it. Returns
    /// whether the cost allowed to look at all.
    static bool lower(ApexView& view, const PlacedBlock& block, uint32_t rising, size_t most_cost, Lowering& at) {
        uint32_t blocked = 0;
        float known_at = -1;  // the height at which they are blocked
        const auto find_blocked = [&] {
            if (known_at != at.height) blocked = view.blocked_by(block, rising, at.height);
            known_at = at.height;
        };
        if (!(at.height > 0)) rising = 0;
        const size_t whole = size_t(block.count) + cost_of_test * size_t(std::popcount(rising));
        if (at.cost + whole <= most_cost) {
            if (rising != 0) find_blocked();
            if (blocked == 0) {
                at.cost += whole;
                return true;
            }
        }
        for (int lane = 0; lane < block.count; ++lane) {
            if (at.cost >= most_cost) return false;
            ++at.cost;
            if (!(at.height > 0) || !(rising >> lane & 1)) continue;
            at.cost += cost_of_test;
            find_blocked();
            if (!(blocked >> lane & 1)) continue;
            // A triangle that passes through the base blocks every apex; no height is better than the one that the
            // other neighbors allow.
            float lower = at.height;
            int more = 0;
            bool free = false;
            while (!free && at.halvings + more < most_halvings) {
                lower /= 2;
                ++more;
                at.cost += cost_of_test;
                free = view.blocked_by(block, 1u << lane, lower) == 0;
            }
            at.through |= !free;
            if (!free) continue;
            at.height = lower;
            at.halvings += more;
        }
        return true;
    }

    const NormalizedMesh& mesh_;
    const Groups& groups_;
    const Tree& tree_;
    ApexHeights& heights_;
    std::vector<NeighborBlock> around_;
    bool all_around_ = true;         // they are all in around_
    std::vector<PlacedBlock> near_;  // of the triangle that is checked
};

}  // namespace

ApexFaults check_apexes(const NormalizedMesh& mesh, const Groups& groups, const Tree& tree, ApexHeights& heights,
                        StopSignal stop) {
    // First every side may take an equal share of the work. Groups that need more, if they are few, share as much
    // again.
    const size_t most_work = 800 * std::max<size_t>(mesh.size(), 100'000);
    const size_t equal_share = most_work / (2 * std::max<size_t>(mesh.size(), 1));
    const ApexLimits first_limits{equal_share, equal_share};
    const ApexHeights initial = heights;
    std::vector<ApexFaults> faults(groups.size());
    const auto check = [&](uint32_t first, uint32_t end, const ApexLimits& limits) {
        stop.check();
        ApexCheck checker(mesh, groups, tree, heights);
        for (uint32_t g = first; g != end; ++g) faults[g] = checker.check(g, limits);
    };
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, groups.size(), 64),
                      [&](const auto& range) { check(range.begin(), range.end(), first_limits); });

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
        tbb::parallel_for(size_t(0), rest.size(), [&](size_t i) { check(rest[i], rest[i] + 1, limits); });
    }
    ApexFaults sum;
    for (const ApexFaults& f : faults) {
        sum.crossed += f.crossed;
        sum.unchecked += f.unchecked;
    }
    return sum;
}

}  // namespace cistula
