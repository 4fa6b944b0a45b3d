#include "scene/compile/meshes/mesh_edges.h"

#include <algorithm>
#include <atomic>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "cistula/numerics/vec.h"
#include "scene/description/mesh_source.h"

namespace cistula {
namespace {

/// A half-edge, stored in the bucket of its lower vertex. Only eight bytes, since there are three per triangle.
struct HalfEdge {
    uint32_t high_vertex, number;
};

}  // namespace

MeshEdges link_edges(std::span<const TriangleCorners> triangles, size_t vertices) {
    const auto count = static_cast<uint32_t>(3 * triangles.size());
    const auto vertex = [&](uint32_t half_edge) { return triangles[half_edge / 3][half_edge % 3]; };
    const auto end = [&](uint32_t half_edge) { return vertex(half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1); };

    std::vector<uint32_t> first(vertices + 1, 0);
    for (uint32_t h = 0; h < count; ++h) ++first[std::min(vertex(h), end(h))];
    uint32_t sum = 0;
    for (uint32_t& f : first) sum += f, f = sum;
    std::vector<HalfEdge> edges(count);
    for (uint32_t h = count; h-- > 0;) {
        const uint32_t a = vertex(h);
        const uint32_t b = end(h);
        edges[--first[std::min(a, b)]] = {std::max(a, b), h};
    }

    MeshEdges linked;
    linked.next.resize(count);
    std::atomic<uint32_t> open{0}, crowded{0};
    tbb::parallel_for(tbb::blocked_range<size_t>(0, vertices, 4096), [&](const auto& range) {
        uint32_t open_here = 0;
        uint32_t crowded_here = 0;
        for (size_t v = range.begin(); v != range.end(); ++v) {
            HalfEdge* const bucket_end = edges.data() + first[v + 1];
            HalfEdge* group = edges.data() + first[v];
            std::sort(group, bucket_end, [](const HalfEdge& a, const HalfEdge& b) {
                return a.high_vertex != b.high_vertex ? a.high_vertex < b.high_vertex : a.number < b.number;
            });
            while (group != bucket_end) {
                HalfEdge* group_end = group + 1;
                while (group_end != bucket_end && group_end->high_vertex == group->high_vertex) ++group_end;
                for (HalfEdge* e = group; e != group_end; ++e)
                    linked.next[e->number] = (e + 1 == group_end ? group : e + 1)->number;
                const auto size = group_end - group;
                if (size == 1) ++open_here;
                if (size > 2) ++crowded_here;
                group = group_end;
            }
        }
        open += open_here;
        crowded += crowded_here;
    });
    linked.open = open;
    linked.crowded = crowded;
    return linked;
}

MeshEdges link_edges(const MeshSource& mesh) {
    const std::vector<uint32_t> welded = weld(mesh.vertices);
    std::vector<TriangleCorners> triangles(mesh.triangles.begin(), mesh.triangles.end());
    for (TriangleCorners& corners : triangles)
        for (uint32_t& corner : corners) corner = welded[corner];
    return link_edges(triangles, mesh.vertices.size());
}

double pseudo_angle(double x, double y) {
    const double part = magnitude(y) / (magnitude(x) + magnitude(y));
    return y >= 0 ? (x >= 0 ? part : 2 - part) : (x < 0 ? 2 + part : 4 - part);
}

}  // namespace cistula
