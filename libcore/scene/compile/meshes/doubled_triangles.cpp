
#include <algorithm>
#include <tuple>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "cistula/numerics/vec.h"
#include "scene/compile/meshes/mesh_edges.h"

namespace cistula {
namespace {

using glm::dvec3;

/// A triangle, stored in the bucket of its lowest vertex.
struct BucketTriangle {
    uint32_t middle_vertex, high_vertex, number;
};

}  // namespace

std::vector<uint8_t> doubled_triangles(std::span<const TriangleCorners> of, size_t vertices) {
    const auto total = static_cast<uint32_t>(of.size());
    const auto sorted = [&](uint32_t triangle) {
        TriangleCorners corners = of[triangle];
        std::sort(corners.begin(), corners.end());
        return corners;
    };
    std::vector<uint32_t> first(vertices + 1, 0);
    for (uint32_t t = 0; t < total; ++t) ++first[sorted(t)[0]];
    uint32_t sum = 0;
    for (uint32_t& f : first) sum += f, f = sum;
    std::vector<BucketTriangle> triangles(sum);
    for (uint32_t t = total; t-- > 0;) {
        const TriangleCorners corners = sorted(t);
        triangles[--first[corners[0]]] = {corners[1], corners[2], t};
    }

    std::vector<uint8_t> doubled(total, 0);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, vertices, 4096), [&](const auto& range) {
        for (size_t v = range.begin(); v != range.end(); ++v) {
            const auto begin = triangles.begin() + first[v];
            const auto end = triangles.begin() + first[v + 1];
            std::sort(begin, end, [](const BucketTriangle& a, const BucketTriangle& b) {
                return std::tie(a.middle_vertex, a.high_vertex, a.number) <
                       std::tie(b.middle_vertex, b.high_vertex, b.number);
            });
            for (auto t = begin; t != end; ++t)
                doubled[t->number] =
                    t != begin && t->middle_vertex == (t - 1)->middle_vertex && t->high_vertex == (t - 1)->high_vertex;
        }
    });
    return doubled;
}

std::vector<uint8_t> crossed_halves(std::span<const dvec3> vertices, std::span<const TriangleCorners> triangles) {
    const std::vector<uint32_t> next = link_edges(triangles, vertices.size()).next;
    const auto corner = [&](uint32_t half_edge) { return triangles[half_edge / 3][half_edge % 3]; };
    const auto after = [](uint32_t half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; };
    const auto opposite = [&](uint32_t half_edge) { return corner(after(after(half_edge))); };
    // The other triangle at an edge whose third corner is `third`, if it is among the next few there: an edge may have
    // all triangles of a mesh.
    constexpr uint32_t none = 0xffffffffu;
    constexpr int most_tried = 16;
    const auto neighbor = [&](uint32_t half_edge, uint32_t third) {
        uint32_t h = next[half_edge];
        for (int tried = 0; h != half_edge && tried < most_tried; h = next[h], ++tried)
            if (opposite(h) == third) return h / 3;
        return none;
    };
    const auto is_flat_quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {  // in a cycle
        const dvec3 p = vertices[a];
        const dvec3 ac = vertices[c] - p;
        const dvec3 ab = vertices[b] - p;
        const dvec3 ad = vertices[d] - p;
        const dvec3 bd = ad - ab;
        const dvec3 normal = cross(ac, bd);
        const double size = length(normal);
        const double longest = max_or_second(length(ac), length(bd));
        if (!(size > 0) || magnitude(dot(normal, ab)) > 0x1p-20 * longest * size) return false;
        // The diagonals cross: each pair of corners lies on either side of the other pair's line.
        const auto side = [&](const dvec3& line, const dvec3& to) { return dot(cross(line, to), normal); };
        return side(ac, ab) * side(ac, ad) < 0 && side(bd, -ab) * side(bd, ac - ab) < 0;
    };
    std::vector<uint8_t> crossed(triangles.size(), 0);
    for (uint32_t h = 0; h < next.size(); ++h) {
        const uint32_t other = next[h];
        if (other <= h || next[other] != h) continue;
        const uint32_t a = corner(h);
        const uint32_t c = corner(after(h));
        const uint32_t b = opposite(h);
        const uint32_t d = opposite(other);
        if (b == d) continue;
        // at edges ba and cb
        const uint32_t third = neighbor(after(after(h)), d);
        const uint32_t fourth = neighbor(after(h), d);
        if (third == none || fourth == none || std::min(third, fourth) < std::min(h, other) / 3) continue;
        if (!is_flat_quad(a, b, c, d)) continue;
        for (const uint32_t half : {third, fourth}) crossed[half] = 1;
    }
    return crossed;
}

}  // namespace cistula
