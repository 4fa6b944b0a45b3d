#include "scene/compile/mesh_topology.h"

#include <algorithm>
#include <atomic>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

namespace cistula {
namespace {

using glm::dvec3;
constexpr uint32_t no_vertex = 0xffffffffu;

/// For every vertex the lowest-numbered one at its position; no_vertex if it is not finite.
std::vector<uint32_t> weld(const MeshSource& mesh) {
    const auto& v = mesh.vertices;
    std::vector<uint32_t> order, welded(v.size(), no_vertex);
    order.reserve(v.size());
    for (uint32_t i = 0; i < v.size(); ++i)
        if (is_finite(v[i])) order.push_back(i);
    tbb::parallel_sort(order.begin(), order.end(), [&v](uint32_t a, uint32_t b) {
        if (v[a].x != v[b].x) return v[a].x < v[b].x;
        if (v[a].y != v[b].y) return v[a].y < v[b].y;
        if (v[a].z != v[b].z) return v[a].z < v[b].z;
        return a < b;
    });
    uint32_t first = no_vertex;
    for (const uint32_t i : order) {
        if (first == no_vertex || v[i] != v[first]) first = i;
        welded[i] = first;
    }
    return welded;
}

bool has_zero_area(const MeshSource& mesh, const std::array<uint32_t, 3>& t) {
    const dvec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const dvec3 normal = cross(b - a, c - a);
    return normal.x == 0 && normal.y == 0 && normal.z == 0;
}

/// Fills the list of kept triangles and counts those left out.
void keep_triangles(const MeshSource& mesh, const std::vector<uint32_t>& welded, bool drop_zero_area,
                    MeshTopology& topology) {
    topology.kept.clear();
    topology.all_kept = true;
    topology.not_finite = topology.repeated_vertex = topology.zero_area = 0;
    const auto total = static_cast<uint32_t>(mesh.triangles.size());
    for (uint32_t i = 0; i < total; ++i) {
        const auto& t = mesh.triangles[i];
        const uint32_t a = welded[t[0]], b = welded[t[1]], c = welded[t[2]];
        uint32_t* reason = nullptr;
        if (a == no_vertex || b == no_vertex || c == no_vertex) {
            reason = &topology.not_finite;
        } else if (a == b || b == c || c == a) {
            reason = &topology.repeated_vertex;
        } else if (drop_zero_area && has_zero_area(mesh, t)) {
            reason = &topology.zero_area;
        }
        if (reason) ++*reason;
        if (reason && topology.all_kept) {
            topology.all_kept = false;
            topology.kept.reserve(total - 1);
            for (uint32_t k = 0; k < i; ++k) topology.kept.push_back(k);
        } else if (!reason && !topology.all_kept) {
            topology.kept.push_back(i);
        }
    }
    topology.count = topology.all_kept ? total : static_cast<uint32_t>(topology.kept.size());
}

/// A half-edge, stored in the bucket of its lower vertex. Only eight bytes, since there are three per triangle.
struct HalfEdge {
    uint32_t high_vertex, number;
};

/// Links the half-edges of every edge in a ring and counts the edges that are not two half-edges in opposite
/// directions.
void link_edges(const MeshSource& mesh, const std::vector<uint32_t>& welded, MeshTopology& topology) {
    const uint32_t count = topology.count;
    const auto vertex = [&](uint32_t half_edge) {
        return welded[mesh.triangles[topology.source_triangle(half_edge / 3)][half_edge % 3]];
    };
    const auto end = [&](uint32_t half_edge) { return vertex(half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1); };

    std::vector<uint32_t> first(mesh.vertices.size() + 1, 0);
    for (uint32_t h = 0; h < 3 * count; ++h) ++first[std::min(vertex(h), end(h))];
    uint32_t sum = 0;
    for (uint32_t& f : first) sum += f, f = sum;
    std::vector<HalfEdge> edges(3 * static_cast<size_t>(count));
    for (uint32_t h = 3 * count; h-- > 0;) {
        const uint32_t a = vertex(h), b = end(h);
        edges[--first[std::min(a, b)]] = {std::max(a, b), h};
    }

    topology.next_along_edge.assign(3 * static_cast<size_t>(count), 0);
    std::atomic<uint32_t> open{0};
    tbb::parallel_for(tbb::blocked_range<size_t>(0, mesh.vertices.size(), 4096), [&](const auto& range) {
        uint32_t open_here = 0;
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
                    topology.next_along_edge[e->number] = (e + 1 == group_end ? group : e + 1)->number;
                const bool two = group_end - group == 2;
                if (!two || (vertex(group[0].number) == v) == (vertex(group[1].number) == v)) ++open_here;
                group = group_end;
            }
        }
        open += open_here;
    });
    topology.open_edges = open;
}

/// Six times the signed volume about the first vertex; 0 if its sign could be due to rounding.
double signed_volume(const MeshSource& mesh, const MeshTopology& topology) {
    const dvec3 origin = mesh.vertices[mesh.triangles[topology.source_triangle(0)][0]];
    double sum = 0, magnitudes = 0;
    for (uint32_t i = 0; i < topology.count; ++i) {
        const auto& t = mesh.triangles[topology.source_triangle(i)];
        const double term =
            dot(mesh.vertices[t[0]] - origin, cross(mesh.vertices[t[1]] - origin, mesh.vertices[t[2]] - origin));
        sum += term;
        magnitudes += magnitude(term);
    }
    return magnitude(sum) > 0x1p-40 * magnitudes ? sum : 0;
}

}  // namespace

std::string MeshTopology::left_out() const {
    std::string text;
    const auto add = [&text](uint32_t number, const char* what) {
        if (number == 0) return;
        text += text.empty() ? "left out " : " and ";
        text += std::to_string(number) + (number == 1 ? " triangle " : " triangles ") + what;
    };
    add(repeated_vertex, "with a repeated vertex");
    add(not_finite, "with a vertex that is not finite");
    add(zero_area, "of zero area");
    return text;
}

MeshTopology find_topology(const MeshSource& mesh) {
    MeshTopology topology;
    const std::vector<uint32_t> welded = weld(mesh);
    keep_triangles(mesh, welded, true, topology);
    link_edges(mesh, welded, topology);
    if (topology.open_edges > 0 && topology.zero_area > 0) {
        // Zero-area triangles may close a mesh along edges that their neighbors subdivide.
        MeshTopology sealed;
        keep_triangles(mesh, welded, false, sealed);
        link_edges(mesh, welded, sealed);
        if (sealed.open_edges == 0) topology = std::move(sealed);
    }
    if (topology.count > 0 && topology.open_edges == 0) {
        const double volume = signed_volume(mesh, topology);
        topology.closed = volume != 0;
        topology.flipped = volume < 0;
    }
    return topology;
}

}  // namespace cistula
