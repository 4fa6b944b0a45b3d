#include "scene/compile/meshes/mesh_edges.h"

#include <algorithm>

#include "cistula/numerics/vec.h"
#include "scene/compile/meshes/union_find.h"

namespace cistula {
namespace {

using glm::dvec3;

// Angles as of pseudo_angle.
constexpr double one_angle = 1e-6;  // what is less apart is rounding: faces at one angle
constexpr double tie = 1e-3;        // what is less apart may coincide

/// A half-edge at a crowded edge.
struct Wing {
    uint32_t half_edge;
    double angle;  // of its triangle about the edge
    bool opens;    // as wound, an inside begins there for one who turns about the edge
    uint32_t group = 0;
};

class EdgePairing {
  public:
    EdgePairing(std::span<const dvec3> vertices, std::span<const TriangleCorners> triangles)
        : vertices_(vertices), triangles_(triangles) {}

    EdgePairs run(AtCrowdedEdges crowded) {
        MeshEdges edges = link_edges(triangles_, 2 * vertices_.size());
        pairs_.open = edges.open;
        pairs_.crowded = edges.crowded;
        std::swap(pairs_.mate, edges.next);
        if (pairs_.complete() || pairs_.open > 0 || crowded == AtCrowdedEdges::none) return std::move(pairs_);
        pairs_.crowded = 0;
        pair_crowded();
        return std::move(pairs_);
    }

  private:
    uint32_t vertex(uint32_t half_edge) const { return triangles_[half_edge / 3][half_edge % 3]; }
    dvec3 position(uint32_t vertex) const { return vertices_[vertex % vertices_.size()]; }

    /// Takes the rings of crowded edges apart into pairs; `mate` holds rings before.
    void pair_crowded() {
        const std::vector<uint32_t> next = pairs_.mate;
        UnionFind sets(triangles_.size());
        std::vector<uint32_t> crowded;  // the least half-edge of each such edge
        for (uint32_t h = 0; h < next.size(); ++h) {
            if (next[next[h]] == h)
                sets.merge(h / 3, next[h] / 3);
            else if (next[h] < h)  // rings ascend
                crowded.push_back(next[h]);
        }
        std::vector<uint32_t> ring;
        for (const uint32_t first : crowded) {
            ring = {first};
            for (uint32_t h = next[first]; h != first; h = next[h]) ring.push_back(h);
            if (!pair_sets(ring, sets) && !pair_wings(ring)) ++pairs_.crowded;
        }
    }

    /// Pairs the half-edges of an edge by sets, if each has two there.
    bool pair_sets(const std::vector<uint32_t>& ring, UnionFind& sets) {
        std::vector<std::pair<uint32_t, uint32_t>> by_set;
        for (const uint32_t h : ring) by_set.emplace_back(sets.root(h / 3), h);
        std::sort(by_set.begin(), by_set.end());
        if (by_set.size() % 2 != 0) return false;
        for (size_t i = 0; i < by_set.size(); i += 2) {
            const bool third = i + 2 < by_set.size() && by_set[i + 2].first == by_set[i].first;
            if (by_set[i + 1].first != by_set[i].first || third) return false;
        }
        for (size_t i = 0; i < by_set.size(); i += 2) join(by_set[i].second, by_set[i + 1].second);
        return true;
    }

    /// Pairs them as brackets about the edge: what opens an inside with what closes it. False if they do not match, or
    /// coincide in a way that leaves a choice.
    bool pair_wings(const std::vector<uint32_t>& ring) {
        std::vector<Wing> wings = wings_of(ring);
        const auto opening = std::count_if(wings.begin(), wings.end(), [](const Wing& w) { return w.opens; });
        if (wings.size() != ring.size() || 2 * opening != static_cast<ptrdiff_t>(ring.size())) return false;
        bool tied = false;
        for (size_t i = 0; i + 1 < wings.size(); ++i) {
            if (!(wings[i + 1].angle - wings[i].angle < tie)) continue;
            if (wings[i + 1].opens == wings[i].opens) return false;
            tied = true;
        }
        if (tied)
            for (const uint32_t h : ring) pairs_.tied.push_back(h / 3);
        for (const uint32_t h : ring) pairs_.mate[h] = EdgePairs::none;
        std::vector<uint32_t> open;
        for (const bool again : {false, true})  // the second time about closes what the first has left open
            for (const Wing& wing : wings) {
                if (pairs_.mate[wing.half_edge] != EdgePairs::none) continue;
                if (wing.opens) {
                    if (!again) open.push_back(wing.half_edge);
                } else if (!open.empty()) {
                    join(open.back(), wing.half_edge);
                    open.pop_back();
                }
            }
        return true;
    }

    /// The wings of an edge in the order of their angles; at one angle those that close come first. Fewer, if a
    /// triangle has no angle.
    std::vector<Wing> wings_of(const std::vector<uint32_t>& ring) const {
        const uint32_t low = std::min(vertex(ring[0]), end(ring[0]));
        const dvec3 start = position(low);
        const dvec3 edge = position(std::max(vertex(ring[0]), end(ring[0]))) - start;
        std::vector<Wing> wings;
        dvec3 u(0), v(0);
        for (const uint32_t h : ring) {
            const dvec3 to = position(triangles_[h / 3][(h % 3 + 2) % 3]) - start;
            const dvec3 off = to - edge * (dot(to, edge) / dot(edge, edge));
            if (!(dot(off, off) > 0)) return {};
            if (wings.empty()) u = normalized(off), v = normalized(cross(edge, off));
            const double angle = pseudo_angle(dot(off, u), dot(off, v));
            wings.push_back({h, angle > 4 - one_angle ? angle - 4 : angle, vertex(h) != low});
        }
        std::sort(wings.begin(), wings.end(), [](const Wing& a, const Wing& b) { return a.angle < b.angle; });
        for (size_t i = 1; i < wings.size(); ++i)
            wings[i].group = wings[i - 1].group + (wings[i].angle - wings[i - 1].angle > one_angle ? 1 : 0);
        std::sort(wings.begin(), wings.end(), [](const Wing& a, const Wing& b) {
            if (a.group != b.group) return a.group < b.group;
            if (a.opens != b.opens) return b.opens;
            return a.opens ? a.half_edge > b.half_edge : a.half_edge < b.half_edge;
        });
        return wings;
    }
    uint32_t end(uint32_t half_edge) const { return vertex(half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1); }

    void join(uint32_t a, uint32_t b) { pairs_.mate[a] = b, pairs_.mate[b] = a; }

    std::span<const dvec3> vertices_;
    std::span<const TriangleCorners> triangles_;
    EdgePairs pairs_;
};

}  // namespace

EdgePairs pair_edges(std::span<const dvec3> vertices, std::span<const TriangleCorners> triangles,
                     AtCrowdedEdges crowded) {
    return EdgePairing(vertices, triangles).run(crowded);
}

std::vector<uint8_t> closed_without_others(std::span<const TriangleCorners> triangles, size_t vertices) {
    const std::vector<uint32_t> next = link_edges(triangles, vertices).next;
    UnionFind sets(triangles.size());
    for (uint32_t h = 0; h < next.size(); ++h) sets.merge(h / 3, next[h] / 3);
    std::vector<uint8_t> broken(triangles.size(), 0), closed(triangles.size());
    for (uint32_t h = 0; h < next.size(); ++h)
        if (next[h] == h || next[next[h]] != h) broken[sets.root(h / 3)] = 1;
    for (uint32_t t = 0; t < triangles.size(); ++t) closed[t] = broken[sets.root(t)] == 0;
    return closed;
}

}  // namespace cistula
