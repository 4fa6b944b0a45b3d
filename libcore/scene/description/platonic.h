// The five Platonic solids with circumradius 1 about the origin, by formula.
#pragma once

#include "scene/description/polyhedron.h"

namespace cistula {

/// Octahedron: vertices on the axes. Cube: faces across the axes. Dodecahedron and icosahedron: golden-ratio
/// coordinates.
const Polyhedron& platonic_shape(PlatonicSolid solid);
const char* platonic_name(PlatonicSolid solid);

}  // namespace cistula
