#include "scene/readers/meshes/polygon.h"

#include <fmt/format.h>

#include <cmath>
#include <queue>

#include "cistula/numerics/vec.h"
#include "scene/description/coordinate_rounding.h"
#include "scene/readers/meshes/corner_tree.h"
#include "scene/readers/scene_keys.h"

namespace cistula {
namespace {

using glm::dvec2;
using glm::dvec3;

/// Newell's normal, of length twice the area; valid for convex and concave polygons.
dvec3 polygon_normal(std::span<const dvec3> vertices, std::span<const uint32_t> corners) {
    dvec3 sum{0};
    for (size_t i = 0; i < corners.size(); ++i) {
        const dvec3 &a = vertices[corners[i]], &b = vertices[corners[(i + 1) % corners.size()]];
        sum += cross(a - vertices[corners[0]], b - vertices[corners[0]]);
    }
    return sum;
}

/// Clips the ears of a polygon whose normal is finite and not 0.
class EarClipper {
  public:
    EarClipper(std::span<const dvec3> vertices, std::span<const uint32_t> corners, const dvec3& normal)
        : vertices_(vertices),
          corners_(corners),
          normal_(normal),
          in_plane_(points_in_plane()),
          tree_(in_plane_, corners.size() > most_corners_in_order ? 16 : most_corners_in_order),
          state_(corners.size()),
          tests_left_(16 * corners.size()) {
        const auto count = static_cast<uint32_t>(corners.size());
        for (uint32_t i = 0; i < count; ++i) {
            state_[i].before = (i + count - 1) % count;
            state_[i].after = (i + 1) % count;
        }
    }

    void clip(std::vector<std::array<uint32_t, 3>>& triangles) {
        for (uint32_t i = 0; i < corners_.size(); ++i)  // before any is tested, all must be known
            if (is_convex(i)) {
                state_[i].convex = true;
                tree_.remove(i);
            }
        test_all();
        for (size_t left = corners_.size(); left > 3; --left) {
            uint32_t ear = next_ear();
            if (ear == none && tests_left_ > left) {  // a polygon that touches itself may have new ones
                test_all();
                ear = next_ear();
            }
            const uint32_t i = ear == none ? state_[first_].after : ear;
            const uint32_t before = state_[i].before;
            const uint32_t after = state_[i].after;
            triangles.push_back({corners_[before], corners_[i], corners_[after]});
            state_[before].after = after;
            state_[after].before = before;
            state_[i].removed = true;
            if (!state_[i].convex) tree_.remove(i);
            if (i == first_) first_ = after;
            test(before);
            test(after);
        }
        const uint32_t second = state_[first_].after;
        triangles.push_back({corners_[first_], corners_[second], corners_[state_[second].after]});
    }

  private:
    static constexpr uint32_t none = UINT32_MAX;

    struct Corner {
        uint32_t before = 0;
        uint32_t after = 0;
        uint32_t version = 0;  // counts tests: of the entries in the queue the last one holds
        bool removed = false;
        bool convex = false;
    };
    struct Ear {
        double order;
        uint32_t corner, version;
        bool operator<(const Ear& other) const {  // the queue's top is the largest
            return order != other.order ? order > other.order : corner > other.corner;
        }
    };

    /// The corners' places in the plane, with two axes of equal length.
    std::vector<dvec2> points_in_plane() const {
        const dvec3 n = normalized(normal_);
        const dvec3 off = magnitude(n.x) < 0.6 ? dvec3{1, 0, 0} : dvec3{0, 1, 0};
        const dvec3 u = normalized(cross(n, off));
        const dvec3 v = cross(n, u);
        std::vector<dvec2> points;
        points.reserve(corners_.size());
        for (const uint32_t corner : corners_) {
            const dvec3 p = vertices_[corner] - vertices_[corners_[0]];
            points.push_back({dot(p, u), dot(p, v)});
        }
        return points;
    }

    void test_all() {
        uint32_t i = first_;
        do {
            test(i);
            i = state_[i].after;
        } while (i != first_);
    }

    /// Puts a corner into the queue if it is an ear. Only corners that are not convex can lie in one.
    void test(uint32_t i) {
        Corner& corner = state_[i];
        ++corner.version;
        if (tests_left_ > 0) --tests_left_;
        if (!is_convex(i)) return;
        if (!corner.convex) tree_.remove(i);
        corner.convex = true;
        if (is_blocked(i)) return;
        double order = i == first_ ? static_cast<double>(corners_.size()) : i;
        if (corners_.size() > most_corners_in_order) {
            const dvec3 diagonal = at(corner.after) - at(corner.before);
            order = dot(diagonal, diagonal);
        }
        ears_.push({order, i, corner.version});
    }

    uint32_t next_ear() {
        while (!ears_.empty()) {
            const Ear ear = ears_.top();
            ears_.pop();
            if (!state_[ear.corner].removed && state_[ear.corner].version == ear.version) return ear.corner;
        }
        return none;
    }

    bool is_convex(uint32_t i) const { return turn(at(state_[i].before), at(i), at(state_[i].after)) > 0; }

    /// Whether another corner lies in the triangle that corner i spans with its neighbors.
    bool is_blocked(uint32_t i) const {
        const uint32_t before = state_[i].before;
        const uint32_t after = state_[i].after;
        const dvec3 &a = at(before), &b = at(i), &c = at(after);
        const dvec2 pa = in_plane_[before];
        const dvec2 pb = in_plane_[i];
        const dvec2 pc = in_plane_[after];
        const dvec2 low = min_of(pa, min_of(pb, pc));
        const dvec2 high = max_of(pa, max_of(pb, pc));
        // Boxes are compared with slack for rounding; only `turn` decides.
        const dvec2 slack = (max_of(high, -low) + (high - low)) * 0x1p-40;
        const auto touches = [&](const dvec2& box_low, const dvec2& box_high) {
            if (box_low.x > high.x + slack.x || box_low.y > high.y + slack.y || box_high.x < low.x - slack.x ||
                box_high.y < low.y - slack.y)
                return false;
            return !(beyond(pa, pb, box_low, box_high) || beyond(pb, pc, box_low, box_high) ||
                     beyond(pc, pa, box_low, box_high));
        };
        return tree_.any(touches, [&](uint32_t k) {
            if (k == before || k == i || k == after) return false;
            const dvec3& p = at(k);
            if (p == a || p == b || p == c) return false;
            return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
        });
    }

    /// Whether a box lies to the right of the line from p to q, whose triangle lies to the left.
    static bool beyond(const dvec2& p, const dvec2& q, const dvec2& low, const dvec2& high) {
        const dvec2 inward{p.y - q.y, q.x - p.x};
        const dvec2 nearest{inward.x > 0 ? high.x : low.x, inward.y > 0 ? high.y : low.y};
        const dvec2 to = nearest - p;
        const double size = (magnitude(inward.x) + magnitude(inward.y)) * (magnitude(to.x) + magnitude(to.y));
        return inward.x * to.x + inward.y * to.y < -0x1p-40 * size;
    }

    static dvec2 min_of(const dvec2& a, const dvec2& b) { return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y}; }
    static dvec2 max_of(const dvec2& a, const dvec2& b) { return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y}; }

    const dvec3& at(uint32_t i) const { return vertices_[corners_[i]]; }
    double turn(const dvec3& a, const dvec3& b, const dvec3& c) const { return dot(cross(b - a, c - a), normal_); }

    std::span<const dvec3> vertices_;
    std::span<const uint32_t> corners_;
    dvec3 normal_;
    std::vector<dvec2> in_plane_;
    CornerTree tree_;
    std::vector<Corner> state_;
    uint32_t first_ = 0;  // the first corner that is left
    std::priority_queue<Ear> ears_;
    size_t tests_left_;
};

}  // namespace

void append_polygon(std::span<const dvec3> vertices, std::span<const uint32_t> corners,
                    std::vector<std::array<uint32_t, 3>>& triangles) {
    if (corners.size() < 3) return;
    const dvec3 normal = polygon_normal(vertices, corners);
    if (corners.size() > 3 && is_finite(normal) && is_finite(dot(normal, normal)) && dot(normal, normal) > 0)
        return EarClipper(vertices, corners, normal).clip(triangles);
    for (size_t i = 1; i + 1 < corners.size(); ++i) triangles.push_back({corners[0], corners[i], corners[i + 1]});
}

std::optional<std::string> quad_problem(const std::array<glm::dvec3, 4>& corners) {
    const glm::dvec3 first = corners[2] - corners[0];
    const glm::dvec3 second = corners[3] - corners[1];
    const double diagonal = max_or_second(length(first), length(second));
    if (!(diagonal > 0)) return "the four corners of the quad coincide";
    // Twice a quad's area is the length of the cross product of its diagonals.
    const glm::dvec3 a = first / diagonal;
    const glm::dvec3 b = second / diagonal;
    const glm::dvec3 product = cross(a, b);
    if (!(length(product) > quad_tolerance))
        return "the quad has no area or crosses itself; give the corners in order around it";
    const glm::dvec3 normal = normalized(product);
    const double distance = magnitude(dot(normal, (corners[1] - corners[0]) / diagonal));
    const glm::dvec3 rounding = coordinate_rounding(corners).half_unit / diagonal;
    const double written = dot(glm::dvec3(magnitude(normal.x), magnitude(normal.y), magnitude(normal.z)), rounding);
    if (distance > max_or_second(quad_tolerance, 2 * written))
        return fmt::format(
            "the quad is not planar: its diagonals pass at {:.2g} of their length, at most {} is allowed", distance,
            number_text(quad_tolerance));
    for (size_t i = 0; i < 4; ++i) {
        const glm::dvec3 in = (corners[i] - corners[(i + 3) % 4]) / diagonal;
        const glm::dvec3 out = (corners[(i + 1) % 4] - corners[i]) / diagonal;
        if (!(dot(normal, cross(in, out)) > quad_tolerance))
            return fmt::format("the quad is not convex at corner {}; give the corners in order around it", i);
    }
    return std::nullopt;
}

TrianglesObject quad_triangles(const std::array<glm::dvec3, 4>& corners) {
    TrianglesObject quad;
    quad.vertices.assign(corners.begin(), corners.end());
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    quad.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return quad;
}

}  // namespace cistula
