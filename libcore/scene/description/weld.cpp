#include "scene/description/weld.h"

#include <tbb/parallel_sort.h>

#include "cistula/numerics/vec.h"

namespace cistula {

std::vector<uint32_t> weld(std::span<const glm::dvec3> v) {
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

}  // namespace cistula
