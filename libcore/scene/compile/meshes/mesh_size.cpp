#include "scene/compile/meshes/normalized_mesh.h"

#include <cmath>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

/// Calls `use(a, b, c, n)` for the triangles with finite corners and an area; n is twice the area vector.
template <class Use>
void for_each_triangle(const MeshSource& mesh, const SceneNormalization& normalization, const Use& use) {
    for (const auto& corners : mesh.triangles) {
        const dvec3 a = normalization.point(mesh.vertices[corners[0]]);
        const dvec3 b = normalization.point(mesh.vertices[corners[1]]);
        const dvec3 c = normalization.point(mesh.vertices[corners[2]]);
        const dvec3 n = cross(b - a, c - a);
        if (is_finite(n) && dot(n, n) > 0) use(a, b, c, n);
    }
}

}  // namespace

MeshSize mesh_size(const MeshSource& mesh, const SceneNormalization& normalization, double least_height) {
    MeshSize size;
    double area = 0, least_square = INFINITY;  // twice the area
    const double no_area = least_height * least_height;
    for_each_triangle(mesh, normalization, [&](const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& n) {
        ++size.triangles;
        for (const dvec3& p : {a, b, c}) size.box.add(p);
        const double square = dot(n, n);
        area += square_root(square);
        const dvec3 ab = b - a;
        const dvec3 bc = c - b;
        const dvec3 ca = a - c;
        const double longest = max_or_second(dot(ab, ab), max_or_second(dot(bc, bc), dot(ca, ca)));
        if (square > no_area * longest) least_square = min_or_second(square / longest, least_square);
    });
    if (size.triangles == 0) return size;
    size.least_height = square_root(least_square);
    size.half_width = area / (4 * length(size.box.high - size.box.low));
    return size;
}

double distance_to_triangles(const MeshSource& mesh, const SceneNormalization& normalization, const dvec3& point,
                             double least, double most) {
    double nearest = INFINITY;
    for_each_triangle(mesh, normalization, [&](const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& n) {
        const double height = magnitude(dot(point - a, n));
        const double size = length(n);
        if (!(height < most * size) || !(height > least * size) || !(height < nearest * size)) return;
        const auto within = [&](const dvec3& p, const dvec3& q) { return dot(cross(q - p, point - p), n) >= 0; };
        if (within(a, b) && within(b, c) && within(c, a)) nearest = height / size;
    });
    return nearest;
}

}  // namespace cistula
