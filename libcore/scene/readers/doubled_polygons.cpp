#include "scene/readers/doubled_polygons.h"

#include <algorithm>

#include "scene/description/weld.h"

namespace cistula {
namespace {

/// The least of all rotations of a cyclic sequence and of its reverse.
std::vector<uint32_t> least_rotation(std::vector<uint32_t> corners) {
    const uint32_t least = *std::min_element(corners.begin(), corners.end());
    std::vector<uint32_t> best, rotated(corners.size());
    for (int direction = 0; direction < 2; ++direction) {
        for (auto first = corners.begin(); first != corners.end(); ++first) {
            if (*first != least) continue;
            std::rotate_copy(corners.begin(), first, corners.end(), rotated.begin());
            if (best.empty() || rotated < best) best = rotated;
        }
        std::reverse(corners.begin(), corners.end());
    }
    return best;
}

}  // namespace

std::vector<bool> doubled_polygons(std::span<const glm::dvec3> vertices,
                                   const std::vector<std::span<const uint32_t>>& polygons) {
    std::vector<bool> doubled(polygons.size(), false);
    if (std::all_of(polygons.begin(), polygons.end(), [](const auto& p) { return p.size() < 4; })) return doubled;
    const std::vector<uint32_t> welded = weld(vertices);
    std::vector<uint32_t> compared, corners;     // numbers of polygons; corners of all of these, one after another
    std::vector<size_t> first(polygons.size());  // of each polygon's corners
    for (uint32_t i = 0; i < polygons.size(); ++i) {
        std::vector<uint32_t> at;
        for (const uint32_t corner : polygons[i]) at.push_back(welded[corner]);
        if (at.size() < 4 || std::find(at.begin(), at.end(), no_vertex) != at.end()) continue;
        at = least_rotation(std::move(at));
        compared.push_back(i);
        first[i] = corners.size();
        corners.insert(corners.end(), at.begin(), at.end());
    }
    const auto corners_of = [&](uint32_t i) { return std::span(corners).subspan(first[i], polygons[i].size()); };
    const auto compare = [&](uint32_t a, uint32_t b) {
        const auto p = corners_of(a), q = corners_of(b);
        return std::lexicographical_compare_three_way(p.begin(), p.end(), q.begin(), q.end());
    };
    std::stable_sort(compared.begin(), compared.end(), [&](uint32_t a, uint32_t b) { return compare(a, b) < 0; });
    for (size_t i = 1; i < compared.size(); ++i) doubled[compared[i]] = compare(compared[i - 1], compared[i]) == 0;
    return doubled;
}

}  // namespace cistula
