#include "scene/description/platonic.h"

#include <algorithm>
#include <cmath>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

/// Adds (x, y, z), (z, x, y), (y, z, x) with all signs of their nonzero coordinates.
void add_cyclic(std::vector<dvec3>& points, double x, double y, double z) {
    for (int turn = 0; turn < 3; ++turn) {
        for (int signs = 0; signs < 8; ++signs) {
            const dvec3 p{signs & 1 ? -x : x, signs & 2 ? -y : y, signs & 4 ? -z : z};
            const bool negates_zero = (signs & 1 && x == 0) || (signs & 2 && y == 0) || (signs & 4 && z == 0);
            if (!negates_zero) points.push_back(p);
        }
        std::swap(x, y);
        std::swap(x, z);
    }
}

void add_signs(std::vector<dvec3>& points, double a) {
    for (int signs = 0; signs < 8; ++signs)
        points.push_back({signs & 1 ? -a : a, signs & 2 ? -a : a, signs & 4 ? -a : a});
}

std::vector<dvec3> axes() {
    return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

std::vector<dvec3> cube_points() {
    std::vector<dvec3> points;
    add_signs(points, 1 / std::sqrt(3.0));
    return points;
}

const double golden = (1 + std::sqrt(5.0)) / 2;

// Cyclic permutations of (0, 1, golden ratio): an icosahedron. `turned`: its mirror image, whose vertices are the face
// normals of our dodecahedron.
std::vector<dvec3> icosahedron_points(bool turned) {
    const double r = std::sqrt(1 + golden * golden);
    std::vector<dvec3> points;
    add_cyclic(points, 0, (turned ? golden : 1) / r, (turned ? 1 : golden) / r);
    return points;
}

std::vector<dvec3> dodecahedron_points(bool turned) {
    const double a = 1 / std::sqrt(3.0);
    std::vector<dvec3> points;
    add_signs(points, a);
    add_cyclic(points, 0, (turned ? golden : 1 / golden) * a, (turned ? 1 / golden : golden) * a);
    return points;
}

bool first_coordinate_positive(const dvec3& n) {
    return n.x != 0 ? n.x > 0 : (n.y != 0 ? n.y > 0 : n.z > 0);
}

dvec3 plain_cross(const dvec3& a, const dvec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Polyhedron::Face face_across(const Polyhedron& shape, uint32_t id, const dvec3& normal) {
    Polyhedron::Face face{id, normal, {}};
    std::vector<uint32_t> on;
    for (uint32_t i = 0; i < shape.vertices.size(); ++i)
        if (dot(normal, shape.vertices[i]) > shape.inradius - 1e-9) on.push_back(i);
    // Walk around the face: the next vertex is the one with all others to the left of the line to it.
    uint32_t at = on[0];
    do {
        face.vertices.push_back(at);
        for (const uint32_t next : on) {
            if (next == at) continue;
            const dvec3 side = plain_cross(normal, shape.vertices[next] - shape.vertices[at]);
            const bool all_left = std::all_of(on.begin(), on.end(), [&](uint32_t other) {
                return dot(side, shape.vertices[other] - shape.vertices[at]) > -1e-9;
            });
            if (all_left) {
                at = next;
                break;
            }
        }
    } while (at != on[0]);
    return face;
}

Polyhedron make_shape(PlatonicSolid solid) {
    Polyhedron shape;
    shape.name = platonic_name(solid);
    std::vector<dvec3> normals;
    const double third = 1 / std::sqrt(3.0);
    switch (solid) {
        case PlatonicSolid::tetrahedron:
            for (const dvec3& p : {dvec3{1, 1, 1}, dvec3{1, -1, -1}, dvec3{-1, 1, -1}, dvec3{-1, -1, 1}}) {
                shape.vertices.push_back(third * p);
                normals.push_back(-third * p);
            }
            shape.inradius = 1.0 / 3;
            break;
        case PlatonicSolid::cube:
            shape.vertices = cube_points();
            normals = axes();
            shape.inradius = third;
            break;
        case PlatonicSolid::octahedron:
            shape.vertices = axes();
            normals = cube_points();
            shape.inradius = third;
            break;
        case PlatonicSolid::dodecahedron:
            shape.vertices = dodecahedron_points(false);
            normals = icosahedron_points(true);
            break;
        case PlatonicSolid::icosahedron:
            shape.vertices = icosahedron_points(false);
            normals = dodecahedron_points(true);
            break;
    }
    if (solid == PlatonicSolid::dodecahedron || solid == PlatonicSolid::icosahedron)
        shape.inradius = golden * golden / std::sqrt(3 * (1 + golden * golden));
    const bool single = solid == PlatonicSolid::tetrahedron;
    for (const dvec3& n : normals) {
        if (!single && !first_coordinate_positive(n)) continue;
        const uint32_t low = 2 * static_cast<uint32_t>(shape.planes.size());
        shape.planes.push_back({n, single ? -INFINITY : -shape.inradius, shape.inradius});
        if (!single) shape.faces.push_back(face_across(shape, low, -n));
        shape.faces.push_back(face_across(shape, low + 1, n));
    }
    find_edges(shape);
    return shape;
}

}  // namespace

const Polyhedron& platonic_shape(PlatonicSolid solid) {
    static const std::array<Polyhedron, 5> shapes = {
        make_shape(PlatonicSolid::tetrahedron), make_shape(PlatonicSolid::cube), make_shape(PlatonicSolid::octahedron),
        make_shape(PlatonicSolid::dodecahedron), make_shape(PlatonicSolid::icosahedron)};
    return shapes[static_cast<size_t>(solid)];
}

const char* platonic_name(PlatonicSolid solid) {
    static constexpr const char* names[] = {"tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron"};
    return names[static_cast<size_t>(solid)];
}

}  // namespace cistula
