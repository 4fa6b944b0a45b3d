// Mirrored cubes and parallel mirrors against the closed form of folded_path.h.
#pragma once

#include <algorithm>

#include "apps/render_verify/mirrors/folded_path.h"

namespace cistula::verify::mirrors {

inline SceneDescription cube_scene(Shape shape, double radius) {
    SceneDescription scene = empty_scene();
    add_solid(scene, shape, solid_object(PlatonicSolid::cube, glm::dvec3(0), radius));
    return scene;
}

template <class Case>
void plan_cubes(Plan& plan, Walls walls, uint32_t bounces) {
    const Shape shape = walls == Walls::cube_of_planes ? Shape::planes : Shape::triangles;
    const auto add = [&](const char* label, double radius) {
        const auto corners = triangulated_solid(solid_object(PlatonicSolid::cube, glm::dvec3(0), radius)).vertices;
        glm::dvec3 high(0);
        for (const glm::dvec3& p : corners)
            for (int axis = 0; axis < 3; ++axis) high[axis] = std::max(high[axis], p[axis]);
        plan.add(label, cube_scene(shape, radius), Case{{walls, bounces}}, {-high, high}, plan.rays(4096, 64));
    };
    add("radius 1", 1);
    add("radius 1e-5", 1e-5);
    add("radius 2^40", 0x1p40);
}

struct CubeFoldPlanes : FoldedPath {
    static constexpr const char* name = "mirrors/cube-fold/planes";
    static constexpr const char* exact =
        "position after n bounces: triangle wave of o + T d; direction: +-d, bit for bit";
    // The path is unfolded, so that errors of bounces add up. Half an edge is M. t has three roundings, so that the hit
    // is 3 u of at most 2 M off the wall; the closed form turns at the wall itself, which makes it twice as much; the
    // point is rounded by u M: (2 * 6 + 1) u M a bounce, or 6.5 ulps of M.
    static constexpr Bound bound = at_most(6.5, "ulps of M a bounce");
    static void plan(Plan& plan) { plan_cubes<CubeFoldPlanes>(plan, Walls::cube_of_planes, 1000); }
};

struct CubeFoldTriangles : FoldedPath {
    static constexpr const char* name = "mirrors/cube-fold/triangles";
    static constexpr const char* exact = CubeFoldPlanes::exact;
    // Components of d lie in [0.33, 0.82]; all in u M. Differences to corners (up to 2 M) are off by 2, shears by 4,
    // what is sheared by 14. Weights of corners are off by 6 u, so that a point is off by 26, across the ray by 52 + 14
    // at most, and on a face at a slant of 1/2 and more by three times that: 198. t is off by 198 / 0.577 + 24, and the
    // point at t by 0.82 of that: 301. The way toward the apex is 8 u M / height, 163 of which 146 along an axis, to a
    // height of 0.0732 M over a centroid that is at most 1.49 M away. Together 646 u M, or 323 ulps.
    static constexpr Bound bound = at_most(323, "ulps of M a bounce");
    static void plan(Plan& plan) { plan_cubes<CubeFoldTriangles>(plan, Walls::cube_of_triangles, 1000); }
};

/// Distance of the mirrors, which are 1 wide.
inline constexpr double gap = 0x1p-8;

struct ParallelPlanes : FoldedPath {
    static constexpr const char* name = "mirrors/parallel/planes";
    static constexpr const char* exact =
        "500 bounces between faces of two cubes: triangle wave across, straight along them";
    // The bound of the cube, except that the distance of the walls is 2^-8 M: 2 * 3 u * 2^-8 M off the walls. Along
    // them at most u / 2 M, for coordinates up to M / 2: 0.53 u M, or 0.27 ulps.
    static constexpr Bound bound = at_most(0.27, "ulps of M a bounce");
    static void plan(Plan& plan) {
        SceneDescription scene = empty_scene();
        const double radius = std::sqrt(0.75), y = 0.5 + gap / 2;
        for (const double side : {-y, y})
            add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube, {0, side, 0}, radius));
        plan.add("two cubes", scene, ParallelPlanes{{Walls::two_cubes, 500}}, {}, plan.rays(16384, 256));
    }
};

/// A square perpendicular to the y axis, of two triangles.
inline TrianglesObject square_across_y(double y, double half) {
    TrianglesObject square;
    square.vertices = {{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    return square;
}

struct ParallelSheets : FoldedPath {
    static constexpr const char* name = "mirrors/parallel/sheets";
    static constexpr const char* exact = "500 bounces between two sheets: triangle wave across, straight along them";
    // The bound of the cube of triangles, all in u M, for slopes of 0.3 at most and distances across of 2^-7: sheared
    // corners are off by 5, points by 26 + 5, the start by 146 along the sheet and 8 across it, which counts at the
    // slope too: 31 + 146 + 8 * 1.3, or 94 ulps.
    static constexpr Bound bound = at_most(94, "ulps of M a bounce");
    static void plan(Plan& plan) {
        SceneDescription scene = empty_scene();
        for (const double y : {-gap / 2, gap / 2}) add_object(scene, square_across_y(y, 0.5));
        plan.add("two sheets", scene, ParallelSheets{{Walls::two_sheets, 500}},
                 {{-0.5, -gap / 2, -0.5}, {0.5, gap / 2, 0.5}}, plan.rays(16384, 256));
    }
};

}  // namespace cistula::verify::mirrors
