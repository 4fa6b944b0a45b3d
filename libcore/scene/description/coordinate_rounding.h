// How coarsely a file writes coordinates: which half unit of the last place may have been rounded away.
#pragma once

#include <span>

#include <glm/vec3.hpp>

namespace cistula {

/// What rounding may have moved the points of a body by, and how they are written.
struct CoordinateRounding {
    glm::dvec3 half_unit{0};  // the largest along each axis, in the points' own units
    int digits = 0;           // significant decimal digits, 6 to 12; 24: the numbers are floats; 0: doubles
};

/// How far a body's faces reach for what touches them, in the frame (docs/rules.md, 11).
struct ContactReach {
    double most = 0;              // 2^-10 of its thickness: no contact is farther
    double own = 0;               // of faces of the body itself
    bool given = false;           // by the scene: what files may have rounded away does not count
    CoordinateRounding rounding;  // of its coordinates
};

/// The rounding of points as a file has them. They are floats if all their numbers are, need more than 6 digits and do
/// not lie on one grid, as corners of modular bodies do. They are exact if half of them end before the last bits of a
/// double. They have D digits, 6 to 12, if no number needs more and half of them need all. Else they are doubles,
/// rounded to an ulp. Looks at some thousand of them at most.
CoordinateRounding coordinate_rounding(std::span<const glm::dvec3> points);

/// The half unit of a single number, along the same lines.
double half_unit_of(double number);

}  // namespace cistula
