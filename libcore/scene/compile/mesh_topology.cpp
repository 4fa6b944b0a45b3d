#include "scene/compile/mesh_topology.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <tuple>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "scene/description/weld.h"

namespace cistula {
namespace {

using glm::dvec3;

/// A triangle, stored in the bucket of its lowest vertex.
struct BucketTriangle {
    uint32_t middle_vertex, high_vertex, number;
};

/// For every triangle 1 if an earlier one has the same three vertices in any order, else 0.
std::vector<uint8_t> doubled_triangles(const MeshSource& mesh, const std::vector<uint32_t>& welded) {
    const auto total = static_cast<uint32_t>(mesh.triangles.size());
    const auto sorted = [&](uint32_t triangle) {
        const auto& t = mesh.triangles[triangle];
        std::array<uint32_t, 3> corners{welded[t[0]], welded[t[1]], welded[t[2]]};
        std::sort(corners.begin(), corners.end());
        return corners;
    };
    std::vector<uint32_t> first(mesh.vertices.size() + 1, 0);
    for (uint32_t t = 0; t < total; ++t)
        if (const auto corners = sorted(t); corners[2] != no_vertex) ++first[corners[0]];
    uint32_t sum = 0;
    for (uint32_t& f : first) sum += f, f = sum;
    std::vector<BucketTriangle> triangles(sum);
    for (uint32_t t = total; t-- > 0;)
        if (const auto corners = sorted(t); corners[2] != no_vertex)
            triangles[--first[corners[0]]] = {corners[1], corners[2], t};

    std::vector<uint8_t> doubled(total, 0);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, mesh.vertices.size(), 4096), [&](const auto& range) {
        for (size_t v = range.begin(); v != range.end(); ++v) {
            const auto begin = triangles.begin() + first[v], end = triangles.begin() + first[v + 1];
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

bool has_zero_area(const MeshSource& mesh, const std::array<uint32_t, 3>& t) {
    const dvec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const dvec3 normal = cross(b - a, c - a);
    return normal.x == 0 && normal.y == 0 && normal.z == 0;
}

/// Fills the list of kept triangles and counts those left out.
void keep_triangles(const MeshSource& mesh, const std::vector<uint32_t>& welded, const std::vector<uint8_t>& doubled,
                    bool drop_zero_area, MeshTopology& topology) {
    topology.kept.clear();
    topology.doubles.clear();
    topology.all_kept = true;
    topology.not_finite = topology.repeated_vertex = topology.doubled = topology.zero_area = 0;
    const auto total = static_cast<uint32_t>(mesh.triangles.size());
    for (uint32_t i = 0; i < total; ++i) {
        const auto& t = mesh.triangles[i];
        const uint32_t a = welded[t[0]], b = welded[t[1]], c = welded[t[2]];
        uint32_t* reason = nullptr;
        if (a == no_vertex || b == no_vertex || c == no_vertex) {
            reason = &topology.not_finite;
        } else if (a == b || b == c || c == a) {
            reason = &topology.repeated_vertex;
        } else if (doubled[i]) {
            reason = &topology.doubled;
            topology.doubles.push_back(i);
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

/// Links the half-edges of every edge in a ring and counts, by kind, the edges that are not two half-edges in opposite
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
    std::atomic<uint32_t> open{0}, crowded{0}, turned{0};
    tbb::parallel_for(tbb::blocked_range<size_t>(0, mesh.vertices.size(), 4096), [&](const auto& range) {
        uint32_t open_here = 0, crowded_here = 0, turned_here = 0;
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
                const auto triangles = group_end - group;
                if (triangles == 1) ++open_here;
                if (triangles > 2) ++crowded_here;
                if (triangles == 2 && (vertex(group[0].number) == v) == (vertex(group[1].number) == v)) ++turned_here;
                group = group_end;
            }
        }
        open += open_here;
        crowded += crowded_here;
        turned += turned_here;
    });
    topology.open_edges = open;
    topology.crowded_edges = crowded;
    topology.turned_edges = turned;
}

/// The halves of flat quads that earlier halves cover, along the other diagonal; marks them in `doubled`. Flat: a
/// corner lies 2^-20 of the longest side at most from the plane of the others, as coordinates in single precision or
/// with seven digits do. Returns whether there are any.
bool find_crossed_halves(const MeshSource& mesh, const std::vector<uint32_t>& welded, const MeshTopology& topology,
                         std::vector<uint8_t>& doubled) {
    const auto corner = [&](uint32_t half_edge) {
        return welded[mesh.triangles[topology.source_triangle(half_edge / 3)][half_edge % 3]];
    };
    const auto after = [](uint32_t half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; };
    const auto opposite = [&](uint32_t half_edge) { return corner(after(after(half_edge))); };
    const auto& next = topology.next_along_edge;
    // The other triangle at an edge whose third corner is `third`, if it is among the next few there: an edge may have
    // all triangles of a mesh.
    constexpr int most_tried = 16;
    const auto neighbor = [&](uint32_t half_edge, uint32_t third) {
        uint32_t h = next[half_edge];
        for (int tried = 0; h != half_edge && tried < most_tried; h = next[h], ++tried)
            if (opposite(h) == third) return h / 3;
        return no_vertex;
    };
    const auto is_flat_quad = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {  // in a cycle
        const dvec3 p = mesh.vertices[a], ac = mesh.vertices[c] - p, ab = mesh.vertices[b] - p,
                    ad = mesh.vertices[d] - p, bd = ad - ab;
        const dvec3 normal = cross(ac, bd);
        const double size = length(normal), longest = max_or_second(length(ac), length(bd));
        if (!(size > 0) || magnitude(dot(normal, ab)) > 0x1p-20 * longest * size) return false;
        // The diagonals cross: each pair of corners lies on either side of the other pair's line.
        const auto side = [&](const dvec3& line, const dvec3& to) { return dot(cross(line, to), normal); };
        return side(ac, ab) * side(ac, ad) < 0 && side(bd, -ab) * side(bd, ac - ab) < 0;
    };
    bool any = false;
    for (uint32_t h = 0; h < next.size(); ++h) {
        const uint32_t other = next[h];
        if (other <= h || next[other] != h) continue;
        const uint32_t a = corner(h), c = corner(after(h)), b = opposite(h), d = opposite(other);
        if (b == d) continue;
        const uint32_t third = neighbor(after(after(h)), d), fourth = neighbor(after(h), d);  // at edges ba and cb
        if (third == no_vertex || fourth == no_vertex || std::min(third, fourth) < std::min(h, other) / 3) continue;
        if (!is_flat_quad(a, b, c, d)) continue;
        for (const uint32_t half : {third, fourth}) doubled[topology.source_triangle(half)] = 1;
        any = true;
    }
    return any;
}

/// Six times the volume under some kept triangles, seen from `origin`, and the sum of its terms' magnitudes.
struct Volume {
    double sum = 0, magnitudes = 0;

    Volume(const MeshSource& mesh, const MeshTopology& topology, const std::vector<uint32_t>& triangles,
           const dvec3& origin) {
        for (const uint32_t triangle : triangles) {
            auto t = mesh.triangles[topology.source_triangle(triangle)];
            if (topology.reverses(triangle)) std::swap(t[1], t[2]);
            const double term =
                dot(mesh.vertices[t[0]] - origin, cross(mesh.vertices[t[1]] - origin, mesh.vertices[t[2]] - origin));
            sum += term;
            magnitudes += magnitude(term);
        }
    }
};

/// Turns triangles of a mesh whose edges all have two of them so that all of a piece face alike, outward; leaves the
/// topology as it is where there is no such choice.
void turn_alike(const MeshSource& mesh, const std::vector<uint32_t>& welded, MeshTopology& topology) {
    const auto corner = [&](uint32_t half_edge) {
        return welded[mesh.triangles[topology.source_triangle(half_edge / 3)][half_edge % 3]];
    };
    constexpr uint8_t unknown = 2;
    std::vector<uint8_t>& turned = topology.turned;
    turned.assign(topology.count, unknown);
    for (uint32_t first = 0; first < topology.count; ++first) {
        if (turned[first] != unknown) continue;
        turned[first] = 0;
        std::vector<uint32_t> piece{first};
        for (size_t i = 0; i < piece.size(); ++i) {
            const uint32_t triangle = piece[i];
            for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
                const uint32_t other = topology.next_along_edge[h];
                const bool is_alike = corner(h) != corner(other);  // they run through the edge in opposite directions
                const auto wanted = static_cast<uint8_t>(is_alike ? turned[triangle] : 1 - turned[triangle]);
                uint8_t& known = turned[other / 3];
                if (known == unknown) {
                    known = wanted;
                    piece.push_back(other / 3);
                } else if (known != wanted) {
                    turned.clear();
                    return;  // it has one side, as a Klein bottle
                }
            }
        }
        const dvec3 origin = mesh.vertices[mesh.triangles[topology.source_triangle(first)][0]];
        if (Volume(mesh, topology, piece, origin).sum < 0)
            for (const uint32_t triangle : piece) turned[triangle] ^= 1;
    }
    topology.turned_edges = 0;
}

/// Six times the signed volume about the first vertex; 0 if its sign could be due to rounding.
double signed_volume(const MeshSource& mesh, const MeshTopology& topology) {
    const dvec3 origin = mesh.vertices[mesh.triangles[topology.source_triangle(0)][0]];
    std::vector<uint32_t> all(topology.count);
    std::iota(all.begin(), all.end(), 0u);
    const Volume volume(mesh, topology, all, origin);
    return magnitude(volume.sum) > 0x1p-40 * volume.magnitudes ? volume.sum : 0;
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

std::string MeshTopology::why_not_closed() const {
    std::string text;
    const auto add = [&text](uint32_t number, const char* before, const char* after) {
        if (number == 0) return;
        if (!text.empty()) text += " and ";
        text += std::to_string(number) + before + (number == 1 ? "edge" : "edges") + after;
    };
    add(open_edges, " open ", "");
    add(crowded_edges, " ", " of more than two faces");
    add(turned_edges, " ", " along which neighbors face opposite ways");
    return text.empty() ? "no volume" : text;
}

MeshTopology find_topology(const MeshSource& mesh) {
    MeshTopology topology;
    const std::vector<uint32_t> welded = weld(mesh.vertices);
    std::vector<uint8_t> doubled = doubled_triangles(mesh, welded);
    keep_triangles(mesh, welded, doubled, true, topology);
    link_edges(mesh, welded, topology);
    if (find_crossed_halves(mesh, welded, topology, doubled)) {
        keep_triangles(mesh, welded, doubled, true, topology);
        link_edges(mesh, welded, topology);
    }
    if (!topology.has_closed_edges() && topology.zero_area > 0) {
        // Zero-area triangles may close a mesh along edges that their neighbors subdivide.
        MeshTopology sealed;
        keep_triangles(mesh, welded, doubled, false, sealed);
        link_edges(mesh, welded, sealed);
        if (sealed.has_closed_edges()) topology = std::move(sealed);
    }
    const bool had_both_sides = mesh.doubled_polygons + topology.doubled > 0;
    if (had_both_sides && topology.turned_edges > 0 && topology.open_edges == 0 && topology.crowded_edges == 0)
        turn_alike(mesh, welded, topology);
    if (topology.count > 0 && topology.has_closed_edges()) {
        const double volume = signed_volume(mesh, topology);
        topology.closed = volume != 0;
        topology.flipped = volume < 0;
    }
    return topology;
}

}  // namespace cistula
