#include "scene/description/mesh_source.h"

#include <bit>

#include <tbb/parallel_sort.h>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

/// The vertices by a table of their positions: of few, several times as fast as to sort them.
std::vector<uint32_t> weld_few(std::span<const glm::dvec3> v) {
    std::vector<uint32_t> welded(v.size(), no_vertex);
    const int bits = std::bit_width(2 * v.size());
    std::vector<uint32_t> table(size_t(1) << bits, no_vertex);
    for (uint32_t i = 0; i < v.size(); ++i) {
        if (!is_finite(v[i])) continue;
        uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis)
            hash = (std::rotl(hash, 23) ^ std::bit_cast<uint64_t>(v[i][axis] + 0.0)) * 0x9e3779b97f4a7c15u;  // of -0, 0
        size_t at = size_t((hash ^ hash << 32) >> (64 - bits));
        while (table[at] != no_vertex && v[table[at]] != v[i]) at = (at + 1) & (table.size() - 1);
        if (table[at] == no_vertex) table[at] = i;
        welded[i] = table[at];
    }
    return welded;
}

}  // namespace

std::vector<uint32_t> weld(std::span<const glm::dvec3> v) {
    if (v.size() < 0x10000) return weld_few(v);
    struct Key {  // with one coordinate at hand: the others are seldom needed, and lie anywhere in memory
        double x;
        uint32_t number;
    };
    std::vector<uint32_t> welded(v.size(), no_vertex);
    std::vector<Key> order;
    order.reserve(v.size());
    for (uint32_t i = 0; i < v.size(); ++i)
        if (is_finite(v[i])) order.push_back({v[i].x, i});
    tbb::parallel_sort(order.begin(), order.end(), [&v](const Key& p, const Key& q) {
        if (p.x != q.x) return p.x < q.x;
        const uint32_t a = p.number;
        const uint32_t b = q.number;
        if (v[a].y != v[b].y) return v[a].y < v[b].y;
        if (v[a].z != v[b].z) return v[a].z < v[b].z;
        return a < b;
    });
    uint32_t first = no_vertex;
    for (const auto& [x, i] : order) {
        if (first == no_vertex || v[i] != v[first]) first = i;
        welded[i] = first;
    }
    return welded;
}

}  // namespace cistula
