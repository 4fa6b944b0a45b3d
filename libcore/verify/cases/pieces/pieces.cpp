// Closed meshes of several pieces: what is inside does not depend on how a file winds them. The pictures are those of
// the same pieces wound as they should be, or of objects of their own.
#include "verify/cases/writing.h"

namespace cistula::verify {
namespace pieces {
namespace {

/// A body of glass, or opaque, as pieces: the one that contains others first.
struct Pieces {
    std::vector<TrianglesObject> outward;  // each wound as if it were alone
    std::vector<bool> is_hole;
    bool objects = false;  // the pieces are bodies that meet: they look like objects of their own
    bool opaque = false;
};

using MakePieces = Pieces (*)(Draw&);

TrianglesObject polyhedron(Draw& draw, PlatonicSolid kind, const dvec3& center, double radius) {
    TrianglesObject mesh = triangulated_solid(solid_object(kind, center, radius, draw.in_cube<double>(180)));
    mesh.keep_triangles = false;
    return mesh;
}
/// A shell: an icosahedron in another, or a cube in an octahedron.
Pieces shell(Draw& draw) {
    const bool round = draw.one_in(2);
    const PlatonicSolid outer = round ? PlatonicSolid::icosahedron : PlatonicSolid::octahedron;
    const PlatonicSolid inner = round ? PlatonicSolid::icosahedron : PlatonicSolid::cube;
    const TrianglesObject around = polyhedron(draw, outer, {0, 0, 0.4}, 1.2);
    return {{around, polyhedron(draw, inner, {0, 0, 0.4}, round ? 0.9 : 0.65)}, {false, true}};
}
/// A shell with a body in it.
Pieces island(Draw& draw) {
    Pieces pieces = shell(draw);
    pieces.outward.push_back(polyhedron(draw, PlatonicSolid::cube, {0.05, 0, 0.4}, 0.3));
    pieces.is_hole.push_back(false);
    return pieces;
}
Pieces pair(Draw& draw) {
    const double size = 0.3 + 0.2 * draw.unit<double>();
    return {
        {box({-0.9, -0.4, 0.1}, {-0.1, 0.4, 0.9}), box({0.1, -size, 0.5 - size}, {0.1 + 2 * size, size, 0.5 + size})},
        {false, false}};
}
Pieces mirrored_pair(Draw& draw) {
    const double turn = draw.centered<double>(30);
    TrianglesObject one = triangulated_solid(solid_object(PlatonicSolid::cube, {-0.6, 0, 0.5}, 0.8, {0, turn, turn}));
    one.keep_triangles = false;
    TrianglesObject other = one;
    for (dvec3& vertex : other.vertices) vertex.x = -vertex.x;
    turn_inside_out(other);
    return {{one, other}, {false, false}};
}
Pieces opaque_pair(Draw& draw) {
    Pieces pieces = pair(draw);
    pieces.opaque = true;
    return pieces;
}
Pieces touching(Draw& draw) {
    const double low = 0.3 * draw.unit<double>();
    return {{box({-0.9, -0.5, 0.1}, {0, 0.5, 0.9}), box({0, -0.4, low}, {0.8, 0.4, low + 0.6})}, {false, false}, true};
}
Pieces overlapping(Draw& draw) {
    const double low = 0.2 + 0.2 * draw.unit<double>();
    return {
        {box({-0.9, -0.5, 0.1}, {0.2, 0.5, 0.9}), box({-0.2, -0.3, low}, {0.9, 0.7, low + 0.7})}, {false, false}, true};
}

/// A scene with a floor under what is to come, and its material.
std::pair<SceneDescription, int> scene_for(const Pieces& pieces) {
    SceneDescription scene = lit_scene();
    add_object(scene, parallelogram({-3, -3, -0.9}, {6, 0, 0}, {0, 6, 0}), add_material(scene, paper({0.8, 0.6, 0.3})));
    const int material =
        add_material(scene, pieces.opaque ? paper({0.9, 0.3, 0.2}, 0.2) : glass(1.5, true, {0.3, 0.5, 0.9}));
    return {scene, material};
}
SceneDescription wound_well(const Pieces& pieces) {
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
SceneDescription wound_as_it_comes(const Pieces& pieces, uint64_t inward, Draw& draw) {
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

Render wound(MakePieces make) {
    return [=](Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage, 8, 1); ++i) {
            Draw draw(i, 53);
            const Pieces pieces = make(draw);
            const Writing writing = random_writing(draw, 3, 3);
            const Film expected = stage.film(written(wound_well(pieces), writing));
            const uint64_t windings = uint64_t(1) << pieces.outward.size();
            for (uint64_t inward = 0; inward < windings; inward += stage.quick && windings > 4 ? 3 : 1)
                expect_same_picture(stage, tally, written(wound_as_it_comes(pieces, inward, draw), writing), expected,
                                    windings * i + inward);
        }
    };
}
/// A star, a torus and an uneven sphere, each triangle wound as it comes.
void triangles_at_random(Stage& stage, Tally& tally) {
    const TrianglesObject meshes[] = {star(0.5, 1.1), torus(0.8, 0.3, 16, 8), bumpy_sphere(200)};
    for (uint64_t i = 0; i < 3; ++i) {
        Draw draw(i, 53);
        Pieces one{{meshes[i]}, {false}};
        const Writing writing = random_writing(draw, 3, 3);
        const Film expected = stage.film(written(wound_well(one), writing));
        wind_at_random(one.outward[0], draw);
        expect_same_picture(stage, tally, written(wound_as_it_comes(one, 0, draw), writing), expected, i);
    }
}
Render without_the_last(MakePieces make) {
    return [=](Stage& stage, Tally& tally) {
        Draw draw(0, 53);
        Pieces pieces = make(draw);
        const Film expected = stage.film(wound_well(pieces));
        pieces.outward.pop_back();
        expect_same_picture(stage, tally, wound_well(pieces), expected, 0);
    };
}

// ---- light through slabs that are pieces of one mesh, one of them a shell with a body in it: exp(-sigma d) of the way
// d inside. In shadow: the camera is under the slabs and sees a floor that a lamp over them lights.

/// Slabs over one another around the z axis, in one mesh; `thickness` of all that is inside.
struct Slabs {
    static constexpr double sigma = 0.7;
    std::vector<TrianglesObject> outward;
    double thickness = 0;

    explicit Slabs(Draw& draw) {
        add(draw, 1, 0.4, 2);
        const double shell = add(draw, 2, 0.9, 2);
        add(draw, shell + 0.1, 0.6, 1.9, -1);
        add(draw, shell + 0.2, 0.3, 1.8);
        add(draw, 3.2, 0.4, 2);
    }
    TrianglesObject wound(Draw& draw) const {
        std::vector<TrianglesObject> pieces = outward;
        for (TrianglesObject& piece : pieces) {
            if (draw.one_in(2)) turn_inside_out(piece);
            if (draw.one_in(4)) wind_at_random(piece, draw);
        }
        return joined(pieces);
    }

  private:
    double add(Draw& draw, double low, double height, double half, double sign = 1) {
        const double high = low + height * (sign < 0 ? 1 : 0.7 + 0.3 * draw.unit<double>());
        outward.push_back(box({-half, -half, low}, {half, half, high}));
        thickness += sign * (high - low);
        return low;
    }
};

SceneDescription scene_of(const Slabs& slabs, Draw& draw, bool in_shadow) {
    SceneDescription scene = lit_scene();
    scene.ambient = dvec3(0);
    scene.background = dvec3(in_shadow ? 0 : 1);
    scene.camera.position = {0.1, -0.2, in_shadow ? 0.8 : 5};
    scene.camera.target = {0.15, 0.05, 0};
    scene.camera.field_of_view = 16;
    scene.lights[0].position = {0.2, 0.3, 5};
    scene.lights[0].color = dvec3(1);
    MaterialDescription absorbing = clear();
    absorbing.absorption = dvec3(Slabs::sigma);
    add_object(scene, slabs.wound(draw), add_material(scene, absorbing));
    if (in_shadow)
        add_object(scene, parallelogram({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), add_material(scene, paper(dvec3(1))));
    return scene;
}
double light_through(const SceneDescription& scene, const Slabs& slabs, const dvec3& direction, bool in_shadow) {
    if (!in_shadow) return std::exp(-Slabs::sigma * slabs.thickness / magnitude(direction.z));
    const dvec3 point = scene.camera.position - direction * (scene.camera.position.z / direction.z);
    const double cosine = normalized(scene.lights[0].position - point).z;
    return cosine * std::exp(-Slabs::sigma * slabs.thickness / cosine);
}
// 10 faces whose t are off by some 8 u M each, M being up to 2, and sigma times the scene's size, 8, is below 8: 2^10
// u. Each is rounded to 2^-32 (rules 6).
constexpr Bound bound_of_absorption = at_most(0x1p-14, 0x1p-28, "of 1");

Render absorption(bool in_shadow) {
    return [=](Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage); ++i) {
            Draw draw(i, 53);
            const Slabs slabs(draw);
            const Writing writing = random_writing(draw, 3, 3);
            const SceneDescription scene = scene_of(slabs, draw, in_shadow);
            const Film film = stage.film(written(scene, writing));
            for_each_view(film, scene, [&](size_t pixel, const dvec3& direction) {
                tally.place = place_of_scene(i) + pixel;
                tally.measure(magnitude(radiance(film, pixel) - light_through(scene, slabs, direction, in_shadow)));
            });
        }
    };
}

}  // namespace
}  // namespace pieces

void add_pieces(Cases& cases) {
    using namespace pieces;
    const std::pair<const char*, MakePieces> rows[] = {{"shell", shell},
                                                       {"island", island},
                                                       {"pair", pair},
                                                       {"mirrored-pair", mirrored_pair},
                                                       {"opaque-pair", opaque_pair},
                                                       {"touching", touching},
                                                       {"overlapping", overlapping}};
    for (const auto& [name, make] : rows)
        cases.images(name, "the picture of the pieces wound outward, holes inward, or of objects",
                     no_failures("pixels"), wound(make));
    cases.images("triangles-at-random", "the picture of the same mesh wound outward", no_failures("pixels"),
                 triangles_at_random);
    cases.images("absorption/seen", "a white background through slabs is exp(-sigma d)", bound_of_absorption,
                 absorption(false));
    cases.images("absorption/in-shadow", "a floor under slabs is cos a exp(-sigma d)", bound_of_absorption,
                 absorption(true));
    for (const auto& [name, make] : {std::pair("shell", &shell), std::pair("pair", &pair)})
        cases.images(std::string("broken/") + name, "without one of the pieces the case fails", must_fail(5, "pixels"),
                     without_the_last(make));
}

}  // namespace cistula::verify
