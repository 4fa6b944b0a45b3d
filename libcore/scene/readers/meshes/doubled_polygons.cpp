#include <algorithm>

#include "scene/description/mesh_source.h"
#include "scene/readers/meshes/polygon.h"

namespace cistula {
namespace {

/// Start of the least rotation of a cyclic sequence, in linear time (Shiloach 1981): of two candidates the larger, and
/// all that begin where they agree, are no candidates.
size_t least_start(const std::vector<uint32_t>& corners) {
    const size_t n = corners.size();
    size_t a = 0;
    size_t b = 1;
    size_t same = 0;
    while (a < n && b < n && same < n) {
        const uint32_t at_a = corners[(a + same) % n];
        const uint32_t at_b = corners[(b + same) % n];
        if (at_a == at_b) {
            ++same;
            continue;
        }
        (at_a > at_b ? a : b) += same + 1;
        if (a == b) ++b;
        same = 0;
    }
    return a < b ? a : b;
}

/// The least of all rotations of a cyclic sequence and of its reverse.
std::vector<uint32_t> least_rotation(std::vector<uint32_t> corners) {
    std::vector<uint32_t> reversed(corners.rbegin(), corners.rend());
    for (auto* c : {&corners, &reversed})
        std::rotate(c->begin(), c->begin() + static_cast<ptrdiff_t>(least_start(*c)), c->end());
    return corners < reversed ? corners : reversed;
}

}  // namespace

std::vector<bool> doubled_polygons(std::span<const glm::dvec3> vertices, const PolygonMesh& mesh) {
    std::vector<bool> doubled(mesh.size(), false);
    uint32_t i = 0;
    while (i < mesh.size() && mesh.polygon(i).size() < 4) ++i;
    if (i == mesh.size()) return doubled;
    const std::vector<uint32_t> welded = weld(vertices);
    std::vector<uint32_t> compared, corners;  // numbers of polygons; corners of all of these, one after another
    std::vector<size_t> first(mesh.size());   // of each polygon's corners
    for (; i < mesh.size(); ++i) {
        std::vector<uint32_t> at;
        for (const uint32_t corner : mesh.polygon(i)) at.push_back(welded[corner]);
        if (at.size() < 4 || std::find(at.begin(), at.end(), no_vertex) != at.end()) continue;
        at = least_rotation(std::move(at));
        compared.push_back(i);
        first[i] = corners.size();
        corners.insert(corners.end(), at.begin(), at.end());
    }
    const auto corners_of = [&](uint32_t n) { return std::span(corners).subspan(first[n], mesh.polygon(n).size()); };
    const auto compare = [&](uint32_t a, uint32_t b) {
        const auto p = corners_of(a);
        const auto q = corners_of(b);
        return std::lexicographical_compare_three_way(p.begin(), p.end(), q.begin(), q.end());
    };
    std::stable_sort(compared.begin(), compared.end(), [&](uint32_t a, uint32_t b) { return compare(a, b) < 0; });
    for (size_t n = 1; n < compared.size(); ++n) doubled[compared[n]] = compare(compared[n - 1], compared[n]) == 0;
    return doubled;
}

}  // namespace cistula
