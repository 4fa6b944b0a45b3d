// Meshes of pieces whose windings are drawn, against the same pieces wound as they should be, or objects of their own.
#pragma once

#include "apps/render_verify/given/writing.h"

namespace cistula::verify::pieces {

using namespace given;

/// A body of glass, or opaque, as pieces: the one that contains others first.
struct Pieces {
    std::vector<TrianglesObject> outward;  // each wound as if it were alone
    std::vector<bool> is_hole;
    bool objects = false;  // the pieces are bodies that meet: they look like objects of their own
    bool opaque = false;
};

using MakePieces = Pieces (*)(Draw&);

inline TrianglesObject polyhedron(Draw& draw, PlatonicSolid kind, const dvec3& center, double radius) {
    TrianglesObject mesh = triangulated_solid(solid_object(kind, center, radius, draw.in_cube<double>(180)));
    mesh.keep_triangles = false;
    return mesh;
}
/// A shell: an icosahedron in another, or a cube in an octahedron.
inline Pieces shell(Draw& draw) {
    const bool round = draw.one_in(2);
    const PlatonicSolid outer = round ? PlatonicSolid::icosahedron : PlatonicSolid::octahedron;
    const PlatonicSolid inner = round ? PlatonicSolid::icosahedron : PlatonicSolid::cube;
    const TrianglesObject around = polyhedron(draw, outer, {0, 0, 0.4}, 1.2);
    return {{around, polyhedron(draw, inner, {0, 0, 0.4}, round ? 0.9 : 0.65)}, {false, true}};
}
/// A shell with a body in it.
inline Pieces island(Draw& draw) {
    Pieces pieces = shell(draw);
    pieces.outward.push_back(polyhedron(draw, PlatonicSolid::cube, {0.05, 0, 0.4}, 0.3));
    pieces.is_hole.push_back(false);
    return pieces;
}
inline Pieces pair(Draw& draw) {
    const double size = 0.3 + 0.2 * draw.unit<double>();
    return {
        {box({-0.9, -0.4, 0.1}, {-0.1, 0.4, 0.9}), box({0.1, -size, 0.5 - size}, {0.1 + 2 * size, size, 0.5 + size})},
        {false, false}};
}
inline Pieces mirrored_pair(Draw& draw) {
    const double turn = draw.centered<double>(30);
    TrianglesObject one = triangulated_solid(solid_object(PlatonicSolid::cube, {-0.6, 0, 0.5}, 0.8, {0, turn, turn}));
    one.keep_triangles = false;
    TrianglesObject other = one;
    for (dvec3& vertex : other.vertices) vertex.x = -vertex.x;
    turn_inside_out(other);
    return {{one, other}, {false, false}};
}
inline Pieces opaque_pair(Draw& draw) {
    Pieces pieces = pair(draw);
    pieces.opaque = true;
    return pieces;
}
inline Pieces touching(Draw& draw) {
    const double low = 0.3 * draw.unit<double>();
    return {{box({-0.9, -0.5, 0.1}, {0, 0.5, 0.9}), box({0, -0.4, low}, {0.8, 0.4, low + 0.6})}, {false, false}, true};
}
inline Pieces overlapping(Draw& draw) {
    const double low = 0.2 + 0.2 * draw.unit<double>();
    return {
        {box({-0.9, -0.5, 0.1}, {0.2, 0.5, 0.9}), box({-0.2, -0.3, low}, {0.9, 0.7, low + 0.7})}, {false, false}, true};
}

/// A scene with a floor under what is to come, and its material.
inline std::pair<SceneDescription, int> scene_for(const Pieces& pieces) {
    SceneDescription scene = lit_scene();
    add_object(scene, parallelogram({-3, -3, -0.9}, {6, 0, 0}, {0, 6, 0}), add_material(scene, stone({0.8, 0.6, 0.3})));
    const int material =
        add_material(scene, pieces.opaque ? stone({0.9, 0.3, 0.2}, 0.2) : contact::glass(1.5, {0.3, 0.5, 0.9}));
    return {scene, material};
}
inline SceneDescription wound_well(const Pieces& pieces) {
    auto [scene, material] = scene_for(pieces);
    std::vector<TrianglesObject> wound = pieces.outward;
    for (size_t k = 0; k < wound.size(); ++k)
        if (pieces.is_hole[k]) turn_inside_out(wound[k]);
    if (pieces.objects)
        for (const TrianglesObject& piece : wound) add_object(scene, piece, material);
    else
        add_object(scene, joined(wound), material);
    return scene;
}
/// One mesh; bit k of `inward` turns piece k. The pieces may be in any order.
inline SceneDescription wound_as_it_comes(const Pieces& pieces, uint64_t inward, Draw& draw) {
    auto [scene, material] = scene_for(pieces);
    std::vector<TrianglesObject> wound = pieces.outward;
    for (size_t k = 0; k < wound.size(); ++k) {
        if (inward >> k & 1) turn_inside_out(wound[k]);
        if (draw.one_in(4)) wind_at_random(wound[k], draw);
    }
    if (draw.one_in(2)) std::reverse(wound.begin(), wound.end());
    add_object(scene, joined(wound), material);
    return scene;
}

template <MakePieces make>
struct Wound {
    static constexpr const char* exact = "the picture of the pieces wound outward, holes inward, or of objects";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage, 8, 1); ++i) {
            Draw draw(i, 53);
            const Pieces pieces = make(draw);
            const Writing writing = random_writing(draw, 3, 3);
            const Film expected = contact::film_of(stage, written(wound_well(pieces), writing));
            const uint64_t windings = uint64_t(1) << pieces.outward.size();
            for (uint64_t inward = 0; inward < windings; inward += stage.quick && windings > 4 ? 3 : 1)
                expect_same_picture(stage, tally, written(wound_as_it_comes(pieces, inward, draw), writing), expected,
                                    windings * i + inward);
        }
    }
};

struct Shell : Wound<shell> {
    static constexpr const char* name = "pieces/shell";
};
struct Island : Wound<island> {
    static constexpr const char* name = "pieces/island";
};
struct Pair : Wound<pair> {
    static constexpr const char* name = "pieces/pair";
};
struct MirroredPair : Wound<mirrored_pair> {
    static constexpr const char* name = "pieces/mirrored-pair";
};
struct OpaquePair : Wound<opaque_pair> {
    static constexpr const char* name = "pieces/opaque-pair";
};
struct Touching : Wound<touching> {
    static constexpr const char* name = "pieces/touching";
};
struct Overlapping : Wound<overlapping> {
    static constexpr const char* name = "pieces/overlapping";
};

/// A star, a torus and an uneven sphere, each triangle wound as it comes.
struct TrianglesAtRandom {
    static constexpr const char* name = "pieces/triangles-at-random";
    static constexpr const char* exact = "the picture of the same mesh wound outward";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        const TrianglesObject meshes[] = {star(0.5, 1.1), torus(0.8, 0.3, 16, 8), bumpy_sphere(200)};
        for (uint64_t i = 0; i < 3; ++i) {
            Draw draw(i, 53);
            Pieces one{{meshes[i]}, {false}};
            const Writing writing = random_writing(draw, 3, 3);
            const Film expected = contact::film_of(stage, written(wound_well(one), writing));
            wind_at_random(one.outward[0], draw);
            expect_same_picture(stage, tally, written(wound_as_it_comes(one, 0, draw), writing), expected, i);
        }
    }
};

/// Pieces of which the last is left out.
template <MakePieces make>
struct Missing {
    static constexpr const char* exact = "without one of the pieces the case fails";
    static constexpr Bound bound = must_fail(5, "pixels");

    static void render(Stage& stage, Tally& tally) {
        Draw draw(0, 53);
        Pieces pieces = make(draw);
        const Film expected = contact::film_of(stage, wound_well(pieces));
        pieces.outward.pop_back();
        expect_same_picture(stage, tally, wound_well(pieces), expected, 0);
    }
};
struct BrokenShell : Missing<shell> {
    static constexpr const char* name = "pieces/broken/shell";
};
struct BrokenPair : Missing<pair> {
    static constexpr const char* name = "pieces/broken/pair";
};

}  // namespace cistula::verify::pieces
