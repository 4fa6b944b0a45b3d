// Rotations given in degrees, exact for whole right angles.
#pragma once

#include <glm/vec3.hpp>

#include "cistula/numerics/trigonometry.h"

namespace cistula {

struct SineCosine {
    double sine, cosine;
};

/// Sine and cosine of an angle in degrees; exactly 0 or +-1 for multiples of 90.
inline SineCosine sine_cosine_of_degrees(double degrees) {
    const double turned = degrees - 360 * floor_of(degrees / 360);
    const double quarter = floor_of(turned / 90 + 0.5);
    const double radians = (turned - 90 * quarter) * (3.14159265358979323846 / 180);
    const double s = elementary::sin(radians);
    const double c = elementary::cos(radians);
    switch (static_cast<int>(quarter) & 3) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s};
        case 2:
            return {-s, -c};
        default:
            return {-c, s};
    }
}

/// A rotation about x, then y, then z, by angles in degrees, counter-clockwise seen from the axis' tip.
class Rotation {
  public:
    explicit Rotation(const glm::dvec3& degrees)
        : x_(sine_cosine_of_degrees(degrees.x)),
          y_(sine_cosine_of_degrees(degrees.y)),
          z_(sine_cosine_of_degrees(degrees.z)) {}

    glm::dvec3 operator()(glm::dvec3 p) const {
        p = {p.x, x_.cosine * p.y - x_.sine * p.z, x_.sine * p.y + x_.cosine * p.z};
        p = {y_.cosine * p.x + y_.sine * p.z, p.y, y_.cosine * p.z - y_.sine * p.x};
        return {z_.cosine * p.x - z_.sine * p.y, z_.sine * p.x + z_.cosine * p.y, p.z};
    }

  private:
    SineCosine x_, y_, z_;
};

}  // namespace cistula
