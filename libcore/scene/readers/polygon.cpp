#include "scene/readers/polygon.h"

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

/// Newell's normal, of length twice the area; valid for convex and concave polygons.
dvec3 polygon_normal(std::span<const dvec3> vertices, const std::vector<uint32_t>& corners) {
    dvec3 sum{0};
    for (size_t i = 0; i < corners.size(); ++i) {
        const dvec3 &a = vertices[corners[i]], &b = vertices[corners[(i + 1) % corners.size()]];
        sum += cross(a - vertices[corners[0]], b - vertices[corners[0]]);
    }
    return sum;
}

class EarTest {
  public:
    EarTest(std::span<const dvec3> vertices, const std::vector<uint32_t>& corners)
        : vertices_(vertices), corners_(corners), normal_(polygon_normal(vertices, corners)) {}

    /// Whether corner i is an ear: convex, with no other corner in the triangle that it spans with its neighbors.
    bool is_ear(size_t i) const {
        const size_t n = corners_.size(), before = (i + n - 1) % n, after = (i + 1) % n;
        const dvec3 &a = at(before), &b = at(i), &c = at(after);
        if (!(turn(a, b, c) > 0)) return false;
        for (size_t k = 0; k < n; ++k) {
            if (k == before || k == i || k == after) continue;
            const dvec3& p = at(k);
            if (p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

  private:
    const dvec3& at(size_t i) const { return vertices_[corners_[i]]; }
    double turn(const dvec3& a, const dvec3& b, const dvec3& c) const { return dot(cross(b - a, c - a), normal_); }

    std::span<const dvec3> vertices_;
    const std::vector<uint32_t>& corners_;
    dvec3 normal_;
};

}  // namespace

void append_polygon(std::span<const dvec3> vertices, std::vector<uint32_t> corners,
                    std::vector<std::array<uint32_t, 3>>& triangles) {
    if (corners.size() < 3) return;
    const EarTest test(vertices, corners);
    // Always clipping right after the first corner makes a fan of a convex polygon.
    while (corners.size() > 3) {
        const size_t n = corners.size();
        size_t ear = 1;
        while (ear <= n && !test.is_ear(ear % n)) ++ear;
        if (ear > n) ear = 1;
        const size_t i = ear % n;
        triangles.push_back({corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]});
        corners.erase(corners.begin() + static_cast<ptrdiff_t>(i));
    }
    triangles.push_back({corners[0], corners[1], corners[2]});
}

}  // namespace cistula
