#include <algorithm>
#include <unordered_map>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "scene/compile/meshes/mesh_apex.h"

namespace cistula {
namespace {

using glm::dvec3;

/// min(1, tan(a / 2)), a the angle between a triangle and its neighbor at one edge, for both sides of the triangle.
struct AngleFactors {
    double inside = 1, outside = 1;
};

AngleFactors angle_factors(const dvec3& edge_start, const dvec3& edge, const dvec3& normal, const dvec3& opposite) {
    // In the plane perpendicular to the edge: x points into the triangle, y along its normal.
    const dvec3 inward = cross(normal, edge);
    const dvec3 to = opposite - edge_start;
    const double normal_length = length(normal);
    const double x = dot(to, inward) / (normal_length * length(edge));
    const double y = dot(to, normal) / normal_length;
    const double r = square_root(x * x + y * y);
    if (!(r > 0)) return {};  // a neighbor of zero area has no direction
    if (x > 0 && y == 0) return {0, 0};
    const auto half_tangent = [&](double s) { return s <= 0 || x <= 0 ? 1 : s / (r + x); };
    return {half_tangent(-y), half_tangent(y)};
}

void take_least(AngleFactors& least, const AngleFactors& f) {
    least.inside = min_or_second(f.inside, least.inside);
    least.outside = min_or_second(f.outside, least.outside);
}

/// A triangle's edge.
struct MeshEdge {
    MeshEdge(const NormalizedMesh& mesh, uint32_t half_edge) {
        const uint32_t e = half_edge % 3;
        const auto corner = mesh.triangle(half_edge / 3);
        start = corner[e];
        edge = corner[(e + 1) % 3] - corner[e];
        opposite = corner[(e + 2) % 3];
        normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    }
    dvec3 start, edge, opposite, normal;
};

/// The least factors of the triangles along edges that many share, by half-edge: there only neighbors in the order of
/// the angle about the edge are compared.
class CrowdedEdges {
  public:
    /// Most triangles of an edge that are compared each with each.
    static constexpr uint32_t most_pairs = 16;

    CrowdedEdges(const NormalizedMesh& mesh, const MeshEdges& edges) : mesh_(mesh), edges_(edges) {
        if (edges.crowded == 0) return;
        for (uint32_t h = 0; h < 3 * mesh.size(); ++h)
            if (is_crowded(h) && factors_.count(h) == 0) add(h);
    }

    /// Null: the half-edge's edge is not crowded.
    const AngleFactors* find(uint32_t half_edge) const {
        const auto found = factors_.find(half_edge);
        return found == factors_.end() ? nullptr : &found->second;
    }

  private:
    bool is_crowded(uint32_t half_edge) const {
        uint32_t count = 1;
        for (uint32_t h = next(half_edge); h != half_edge && count <= most_pairs; h = next(h)) ++count;
        return count > most_pairs;
    }

    uint32_t next(uint32_t half_edge) const { return edges_.next[half_edge]; }

    void add(uint32_t first) {
        const MeshEdge base(mesh_, first);
        const dvec3 size{magnitude(base.edge.x), magnitude(base.edge.y), magnitude(base.edge.z)};
        const dvec3 off = size.x <= size.y && size.x <= size.z ? dvec3{1, 0, 0}
                          : size.y <= size.z                   ? dvec3{0, 1, 0}
                                                               : dvec3{0, 0, 1};
        const dvec3 u = normalized(cross(base.edge, off));
        const dvec3 v = normalized(cross(base.edge, u));
        std::vector<std::pair<double, uint32_t>> order;
        uint32_t h = first;
        do {
            factors_[h] = {};
            const dvec3 to = MeshEdge(mesh_, h).opposite - base.start;
            const double x = dot(to, u);
            const double y = dot(to, v);
            if (x != 0 || y != 0) order.push_back({pseudo_angle(x, y), h});
            h = next(h);
        } while (h != first);
        std::sort(order.begin(), order.end());
        const size_t count = order.size();
        for (size_t i = 0; i < count; ++i) {
            const MeshEdge own(mesh_, order[i].second);
            // Two on each side, since angles that are nearly equal may be rounded into another order.
            for (const size_t other : {i + 1, i + 2, i + count - 1, i + count - 2})
                if (other % count != i)
                    take_least(factors_[order[i].second],
                               angle_factors(own.start, own.edge, own.normal,
                                             MeshEdge(mesh_, order[other % count].second).opposite));
        }
    }

    const NormalizedMesh& mesh_;
    const MeshEdges& edges_;
    std::unordered_map<uint32_t, AngleFactors> factors_;
};

}  // namespace

ApexHeights apex_heights(const NormalizedMesh& mesh, const MeshEdges& edges) {
    const std::vector<uint32_t>& next = edges.next;
    const CrowdedEdges crowded(mesh, edges);
    ApexHeights heights;
    for (auto& side : heights.side) side.resize(mesh.size());
    tbb::parallel_for(tbb::blocked_range<uint32_t>(0, mesh.size(), 1024), [&](const auto& range) {
        for (uint32_t t = range.begin(); t != range.end(); ++t) {
            AngleFactors least;
            double perimeter = 0, twice_area = 0;
            for (uint32_t e = 0; e < 3; ++e) {
                const uint32_t own = 3 * t + e;
                const MeshEdge edge(mesh, own);
                perimeter += length(edge.edge);
                twice_area = length(edge.normal);
                if (const AngleFactors* known = crowded.find(own)) {
                    take_least(least, *known);
                    continue;
                }
                for (uint32_t h = next[own]; h != own; h = next[h])
                    take_least(least, angle_factors(edge.start, edge.edge, edge.normal, MeshEdge(mesh, h).opposite));
            }
            const double inradius = perimeter > 0 ? twice_area / perimeter : 0;
            heights.side[0][t] = static_cast<float>(inradius / 8 * least.inside);
            heights.side[1][t] = static_cast<float>(inradius / 8 * least.outside);
        }
    });
    return heights;
}

}  // namespace cistula
