// Meshes by formula, for tests and benchmarks.
#pragma once

#include <cstdint>

#include "scene/description/description.h"

namespace cistula {

/// A closed sphere of about `triangles` triangles about the origin, radius 1 to within `bump`, smoothly uneven.
TrianglesObject bumpy_sphere(uint32_t triangles, double bump = 0.1);

/// About the z axis; `around` and `across` segments, at least 3 each; closed.
TrianglesObject torus(double radius, double tube, uint32_t around, uint32_t across);

/// A closed star: spikes over every face of an icosahedron, so that edges between spikes are reflex.
TrianglesObject star(double inner = 0.5, double outer = 1);

/// Open, random triangles in [-1, 1]^3 with corners within `size` / 4 of a random point, axis by axis; the same for the
/// same seed.
TrianglesObject triangle_soup(uint32_t triangles, double size, uint64_t seed);

/// A Platonic solid as triangles, placed like the object.
TrianglesObject triangulated_solid(const SolidObject& solid);

}  // namespace cistula
