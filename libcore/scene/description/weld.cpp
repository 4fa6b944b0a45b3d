#include "scene/description/mesh_source.h"

#include <tbb/parallel_sort.h>

#include "cistula/numerics/vec.h"

namespace cistula {

std::vector<uint32_t> weld(std::span<const glm::dvec3> v) {
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
