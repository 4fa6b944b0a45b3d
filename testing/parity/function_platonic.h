// The Platonic solids in code for host and device, for inputs of the function parity check.
#pragma once

#include "cistula/model/scene_view.h"
#include "testing/parity/function_case.h"

namespace cistula::parity {

inline constexpr uint32_t solid_kinds = 5;
inline constexpr uint32_t most_slabs = 10;

struct PlatonicTables {
    uint32_t corners, slabs;
    double inradius;  // of circumradius 1
};

/// Counts and inradius of a solid: tetrahedron, cube, octahedron, dodecahedron, icosahedron.
CISTULA_HD inline PlatonicTables platonic_tables(uint32_t kind) {
    constexpr double root = 0x1.279a74590331cp-1, golden = 0.7946544722917661;
    if (kind == 0) return {4, 4, 1.0 / 3.0};
    if (kind == 1) return {8, 3, root};
    if (kind == 2) return {6, 4, root};
    if (kind == 3) return {20, 6, golden};
    return {12, 10, golden};
}

/// Corner i of a cube, (+-1, +-1, +-1) / sqrt(3), with signs by the bits of i.
CISTULA_HD inline Vec3<double> cube_corner(uint32_t i) {
    constexpr double k = 0x1.279a74590331cp-1;
    return {i & 1u ? k : -k, i & 2u ? k : -k, i & 4u ? k : -k};
}
/// Corner i among (0, +-a, +-b) and its cyclic permutations.
CISTULA_HD inline Vec3<double> rectangle_corner(uint32_t i, double a, double b) {
    const int axis = int(i / 4);
    Vec3<double> v(0.0);
    v[(axis + 1) % 3] = i & 1u ? a : -a;
    v[(axis + 2) % 3] = i & 2u ? b : -b;
    return v;
}
CISTULA_HD inline Vec3<double> icosahedron_corner(uint32_t i) {
    return rectangle_corner(i, 0.8506508083520400, 0.5257311121191336);
}
CISTULA_HD inline Vec3<double> dodecahedron_corner(uint32_t i) {
    return i < 8 ? cube_corner(i) : rectangle_corner(i - 8, 0.3568220897730899, 0.9341723589627157);
}
CISTULA_HD inline Vec3<double> axis_vector(uint32_t i) {
    Vec3<double> v(0.0);
    v[int(i / 2)] = i & 1u ? 1.0 : -1.0;
    return v;
}
/// Corner i of a tetrahedron: those corners of a cube of which every edge has one.
CISTULA_HD inline Vec3<double> tetrahedron_corner(uint32_t i) {
    const uint32_t corner[] = {0, 3, 5, 6};
    return cube_corner(corner[i]);
}

CISTULA_HD inline Vec3<double> platonic_corner(uint32_t kind, uint32_t i) {
    if (kind == 0) return tetrahedron_corner(i);
    if (kind == 1) return cube_corner(i);
    if (kind == 2) return axis_vector(i);
    if (kind == 3) return dodecahedron_corner(i);
    return icosahedron_corner(i);
}

/// The normal of slab i: one of each two opposite corners of the dual solid.
CISTULA_HD inline Vec3<double> platonic_normal(uint32_t kind, uint32_t i) {
    if (kind == 0) return -tetrahedron_corner(i);
    if (kind == 1) return axis_vector(2 * i + 1);
    if (kind == 2) return cube_corner(i);
    if (kind == 3) return icosahedron_corner(4 * (i / 2) + i % 2);
    return i < 4 ? cube_corner(i) : dodecahedron_corner(8 + 4 * ((i - 4) / 2) + i % 2);
}

/// A rotation by a unit quaternion.
struct Turn {
    double w = 1;
    Vec3<double> v = Vec3<double>(0.0);

    CISTULA_HD Vec3<double> operator()(const Vec3<double>& a) const {
        const Vec3<double> t = cross(v, a) * 2.0;
        return a + t * w + cross(v, t);
    }
};

}  // namespace cistula::parity
