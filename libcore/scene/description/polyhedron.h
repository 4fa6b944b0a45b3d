// Convex bodies with flat faces: corners, planes, faces and edges, in coordinates of their own.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "cistula/numerics/vec.h"
#include "scene/description/description.h"

namespace cistula {

struct Polyhedron {
    /// A pair of parallel faces' planes: low <= normal.x <= high. A single one has low = -infinity.
    struct Planes {
        glm::dvec3 normal;  // unit
        double low, high;
    };
    struct Face {
        uint32_t id;                     // 2 * index into planes + (0: the low side, 1: the high side)
        glm::dvec3 normal;               // outward
        std::vector<uint32_t> vertices;  // counter-clockwise seen from outside, the lowest number first
    };
    struct Edge {
        std::array<uint32_t, 2> vertices;  // ascending
        std::array<uint32_t, 2> faces;     // ids of the two faces that meet there, ascending
    };

    std::string name;  // "cube"
    std::vector<glm::dvec3> vertices;
    std::vector<Planes> planes;
    std::vector<Face> faces;  // by ascending id
    std::vector<Edge> edges;  // by ascending vertices
    double inradius = 0;      // 3 volume / area; of a Platonic solid the distance of its faces from the center
    double flatness = 0;      // how far corners lie from their faces, at most, beyond rounding
    double reach = 1;         // largest distance of a vertex from the origin
    double half_unit = 0;     // how far rounding may have moved vertices along an axis: of the numbers that gave them
    std::string warning;      // of what was left out; empty: nothing
};

/// The half-space normal.x <= offset.
struct BodyPlane {
    glm::dvec3 normal;
    double offset;
};

/// What half-spaces leave of the line in which the planes of two of them meet.
struct PlaneEdge {
    size_t planes[2];
    glm::dvec3 ends[2];
};

/// The edges of what half-spaces with unit normals enclose, which may be open: its corners are their ends. A plane that
/// holds an edge to within `slack` takes nothing from it.
std::vector<PlaneEdge> edges_of(std::span<const BodyPlane> planes, double slack);

/// A face of a body that is being made: its plane, which faces outward, and numbers of vertices.
struct BodyFace {
    BodyPlane plane;
    std::vector<uint32_t> corners;
};

/// What lies no farther apart, in half the largest extent of a body along an axis, is one corner or one face: digits
/// make no more of it, and boxes are grown by more (docs/rules.md, 1).
inline constexpr double in_one_place = 0x1p-20;

/// The most faces of a body.
inline constexpr size_t most_faces = 256;

[[noreturn]] void refuse_flat_body();

/// The shape of a described solid.
const Polyhedron& polyhedron_of(const SolidObject& solid);

/// The distance of a face's plane from the origin, along its normal.
inline double offset_of(const Polyhedron& body, const Polyhedron::Face& face) {
    const Polyhedron::Planes& pair = body.planes[face.id / 2];
    return face.id % 2 == 1 ? pair.high : -pair.low;
}

/// Finds a body's edges from its faces. False if these do not close it.
bool find_edges(Polyhedron& body);

/// The faces as triangles, counter-clockwise seen from outside; each face is a fan about its first vertex.
std::vector<std::array<uint32_t, 3>> triangulated(const Polyhedron& body);

/// Sorts the corners of a convex face counter-clockwise around its normal, from the first one on; at(corner) is where
/// one lies.
template <class Corner, class At>
void sort_around(const glm::dvec3& normal, std::vector<Corner>& corners, const At& at) {
    glm::dvec3 middle(0);
    for (const Corner& c : corners) middle += at(c) / double(corners.size());
    const glm::dvec3 right = corners.empty() ? glm::dvec3(0) : at(corners[0]) - middle;
    const glm::dvec3 up = cross(normal, right);
    const auto angle = [&](const Corner& c) {  // not in radians, but in the same order: from -2 to 2
        const double x = dot(right, at(c) - middle);
        const double y = dot(up, at(c) - middle);
        const double sum = magnitude(x) + magnitude(y);
        return x >= 0 ? y / sum : y >= 0 ? 2 - y / sum : -2 - y / sum;
    };
    std::sort(corners.begin(), corners.end(), [&](const Corner& a, const Corner& b) { return angle(a) < angle(b); });
}

/// Puts the corners of a face in order around it, the lowest number first.
void put_in_order(const std::vector<glm::dvec3>& vertices, BodyFace& face);

/// Twice the area of a flat face, along its normal. Corners are in order around it.
glm::dvec3 twice_area(const std::vector<glm::dvec3>& vertices, const std::vector<uint32_t>& corners);

/// The face through corners that are in order around it: with the direction of its area, halfway between them.
BodyFace face_through(const std::vector<glm::dvec3>& vertices, std::vector<uint32_t> corners);

/// The body of these vertices and faces, each with all its corners, in any order. Vertices with fewer than three faces
/// are left out. Throws Error (scene), without a place, as all that make bodies do.
Polyhedron body_of_faces(std::string_view name, std::vector<glm::dvec3> vertices, std::vector<BodyFace> faces);

/// What lies on the inner side of all planes, whose normals have any length. Planes that bound nothing are left out,
/// with a warning.
Polyhedron body_of_planes(std::string_view name, std::span<const BodyPlane> planes);

/// The convex hull of points, with faces as flat as the digits of the points make them.
Polyhedron hull_of(std::string_view name, const std::vector<glm::dvec3>& points);

/// A box about the origin, with its edges along the axes.
Polyhedron box_body(const glm::dvec3& size);

enum class PolygonBody { prism, antiprism, pyramid };

/// A body about the z axis, from -height / 2 to height / 2, over a regular polygon whose corners are at `radius`, the
/// first at positive x. The upper polygon of an antiprism is turned by half a side.
Polyhedron body_over_polygon(PolygonBody kind, int sides, double radius, double height);

/// An Archimedean solid with circumradius 1 about the origin, by its name in scene files: "truncated-cube".
std::shared_ptr<const Polyhedron> archimedean_body(std::string_view name);

}  // namespace cistula
