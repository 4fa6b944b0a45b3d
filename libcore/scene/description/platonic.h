// The five Platonic solids with circumradius 1 about the origin, by formula.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/description/description.h"

namespace cistula {

/// Vertices, faces and edges of a Platonic solid. Octahedron: vertices on the axes. Cube: faces across the axes.
/// Dodecahedron and icosahedron: golden-ratio coordinates.
struct PlatonicShape {
    /// A pair of opposite faces' planes: -distance <= normal.x <= distance. The tetrahedron has single ones: normal.x
    /// <= distance.
    struct Planes {
        glm::dvec3 normal;  // unit
        bool single;
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

    std::vector<glm::dvec3> vertices;
    std::vector<Planes> planes;
    std::vector<Face> faces;  // by ascending id
    std::vector<Edge> edges;  // by ascending vertices
    double inradius;          // distance of the faces from the origin
};

const PlatonicShape& platonic_shape(PlatonicSolid solid);
const char* platonic_name(PlatonicSolid solid);

/// The faces as triangles, counter-clockwise seen from outside; each face is a fan about its first vertex.
std::vector<std::array<uint32_t, 3>> triangulated(const PlatonicShape& shape);

}  // namespace cistula
