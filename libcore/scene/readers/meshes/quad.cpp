#include "scene/readers/meshes/quad.h"

#include <fmt/format.h>

#include "cistula/numerics/vec.h"
#include "scene/description/coordinate_rounding.h"
#include "scene/readers/scene_keys.h"

namespace cistula {

std::optional<std::string> quad_problem(const std::array<glm::dvec3, 4>& corners) {
    const glm::dvec3 first = corners[2] - corners[0], second = corners[3] - corners[1];
    const double diagonal = max_or_second(length(first), length(second));
    if (!(diagonal > 0)) return "the four corners of the quad coincide";
    // Twice a quad's area is the length of the cross product of its diagonals.
    const glm::dvec3 a = first / diagonal, b = second / diagonal;
    const glm::dvec3 product = cross(a, b);
    if (!(length(product) > quad_tolerance))
        return "the quad has no area or crosses itself; give the corners in order around it";
    const glm::dvec3 normal = normalized(product);
    const double distance = magnitude(dot(normal, (corners[1] - corners[0]) / diagonal));
    const glm::dvec3 rounding = coordinate_rounding(corners).half_unit / diagonal;
    const double written = dot(glm::dvec3(magnitude(normal.x), magnitude(normal.y), magnitude(normal.z)), rounding);
    if (distance > max_or_second(quad_tolerance, 2 * written))
        return fmt::format(
            "the quad is not planar: its diagonals pass at {:.2g} of their length, at most {} is allowed", distance,
            number_text(quad_tolerance));
    for (size_t i = 0; i < 4; ++i) {
        const glm::dvec3 in = (corners[i] - corners[(i + 3) % 4]) / diagonal;
        const glm::dvec3 out = (corners[(i + 1) % 4] - corners[i]) / diagonal;
        if (!(dot(normal, cross(in, out)) > quad_tolerance))
            return fmt::format("the quad is not convex at corner {}; give the corners in order around it", i);
    }
    return std::nullopt;
}

TrianglesObject quad_triangles(const std::array<glm::dvec3, 4>& corners) {
    TrianglesObject quad;
    quad.vertices.assign(corners.begin(), corners.end());
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    quad.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return quad;
}

}  // namespace cistula
