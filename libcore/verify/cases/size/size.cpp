// What is small beside the extent of its scene: bodies of radius 1 on a floor, as they look whatever else is there.
#include "verify/cases/pictures.h"
#include "verify/cases/scenes.h"

namespace cistula::verify {
namespace size {
namespace {

using Kinds = std::vector<PlatonicSolid>;

/// What a view shows beside the body's shadow.
enum class Look { shadow, reflection, mirror, glass, texture };

/// A body over a floor of this half-size, without lights, seen from above at a slant; no horizon is in view.
SceneDescription view(Look look, Shape shape, PlatonicSolid kind, double half_size) {
    SceneDescription scene = empty_scene();
    scene.film.width = 48;
    scene.film.height = 36;
    scene.depth = 5;
    scene.ambient = glm::dvec3(0.2);
    scene.background = {0.3, 0.4, 0.55};
    scene.camera.position = {0, -6, 3};
    scene.camera.target = {0, 0, 0.6};
    scene.camera.field_of_view = 50;
    MaterialDescription& floor = scene.materials[0];
    if (look == Look::mirror) floor.reflection = 0.5;
    if (look == Look::texture) add_checker(scene, glm::dvec2(0.5));
    MaterialDescription body;
    body.color = {0.8, 0.3, 0.2};
    if (look == Look::reflection) body.reflection = 0.6;
    if (look == Look::glass) {
        body.reflection = 0.1, body.transmission = 0.8, body.index = 1.5;
        // A line that leaves the glass all but level meets a large floor and misses a small one: one color.
        scene.background = scene.ambient * floor.color;
    }
    const int material = add_material(scene, body);
    add_object(scene, floor_of_half(half_size));
    add_solid(scene, shape, solid_object(kind, {0, 0, 1.2}, 1, {10, 20, 30}), material);
    return scene;
}

SceneDescription lamp_lit(Look look, Shape shape, PlatonicSolid kind, double half_size) {
    SceneDescription scene = view(look, shape, kind, half_size);
    add_light(scene, {3, -3, 8});
    return scene;
}

/// Expects scenes to look like the first of them, which is small, but for those that float warns of.
void expect_alike(Stage& stage, Tally& tally, const std::vector<SceneDescription>& scenes) {
    Film expected;
    for (const SceneDescription& scene : scenes) {
        if (stage.warns_of(scene)) continue;
        const Film film = stage.render(scene, scene.film.width, scene.film.height);
        if (&scene == &scenes.front())
            expected = film;
        else
            expect_one_of(tally, film, {&expected}, 0);
    }
}

/// Floors up to 1e9 times the size of what stands on them.
Render on_floor(Look look, Shape shape, const Kinds& kinds) {
    return [=](Stage& stage, Tally& tally) {
        for (const PlatonicSolid kind : kinds) {
            std::vector<SceneDescription> scenes;
            for (const double half_size : {512.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9})
                scenes.push_back(lamp_lit(look, shape, kind, half_size));
            expect_alike(stage, tally, scenes);
        }
    };
}
/// What float would show where it warns.
void float_on_floor(Stage& stage, Tally& tally) {
    const auto film = [&](double half_size) {
        const SceneDescription scene = lamp_lit(Look::shadow, Shape::planes, PlatonicSolid::dodecahedron, half_size);
        return stage.render(scene, scene.film.width, scene.film.height);
    };
    const Film expected = film(512);
    expect_one_of(tally, film(1e6), {&expected}, 0);
}

/// A solid at 1e7, in one direction and of one angular size with one at 1e5.
Render far_solid(Look look) {
    return [=](Stage& stage, Tally& tally) {
        std::vector<SceneDescription> scenes;
        for (const double far : {1e5, 1e7}) {
            scenes.push_back(lamp_lit(look, Shape::planes, PlatonicSolid::icosahedron, 20));
            add_object(scenes.back(), solid_object(PlatonicSolid::dodecahedron, {0, far, far / 100}, far / 100), 1);
        }
        expect_alike(stage, tally, scenes);
    };
}
/// A sun at 1e12, in one direction and of one angular size with one at 1e6.
Render sun(Look look, bool seen = false) {
    return [=](Stage& stage, Tally& tally) {
        std::vector<SceneDescription> scenes;
        for (const double far : {1e6, 1e12}) {
            SceneDescription scene = view(look, Shape::planes, PlatonicSolid::dodecahedron, 20);
            const glm::dvec3 way = glm::dvec3(0.4, -0.5, 0.75) * far;
            add_light(scene, way).radius = 0.05 * far;
            if (seen) scene.camera.target = scene.camera.position + way;
            scenes.push_back(scene);
        }
        expect_alike(stage, tally, scenes);
    };
}
/// A scene at 1e7 from the origin of its coordinates: no part of it is small beside its extent.
Render at_offset(Look look) {
    return [=](Stage& stage, Tally& tally) {
        std::vector<SceneDescription> scenes;
        for (const double offset : {0.0, 1e7, -1e7}) {
            scenes.push_back(lamp_lit(look, Shape::planes, PlatonicSolid::dodecahedron, 20));
            for_each_point(scenes.back(), [=](glm::dvec3& p) { p += glm::dvec3(offset, -0.7 * offset, 0.3 * offset); });
        }
        expect_alike(stage, tally, scenes);
    };
}

// ---- walls and coats that are thinner and thinner: each looks like the first

/// A glass cube with a hollow whose top is `wall` under its own, over a checker.
SceneDescription hollow_cube(double wall) {
    SceneDescription scene = empty_scene();
    scene.film.width = 48, scene.film.height = 36;
    scene.depth = 7;
    scene.background = {0.3, 0.4, 0.55};
    scene.ambient = glm::dvec3(0.3);
    scene.camera.position = {3, -5, 2.6};
    scene.camera.target = {0, 0, 0.4};
    scene.camera.field_of_view = 36;
    add_checker(scene, glm::dvec2(0.5));
    add_object(scene, DiskObject::plane({0, 0, 1}, -1));
    TrianglesObject shell = triangulated_solid(solid_object(PlatonicSolid::cube, glm::dvec3(0), std::sqrt(3.0)));
    TrianglesObject hollow = shell;
    for (glm::dvec3& p : hollow.vertices) p = {0.5 * p.x, 0.5 * p.y, p.z > 0 ? 1 - wall : -0.5};
    const auto outer = uint32_t(shell.vertices.size());
    shell.vertices.insert(shell.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
    for (const auto& t : hollow.triangles) shell.triangles.push_back({t[0] + outer, t[2] + outer, t[1] + outer});
    shell.uvs.clear();
    add_object(scene, shell, add_material(scene, glass(1.5, true)));
    return scene;
}
/// A red ball in a coat of glass.
SceneDescription coated_ball(double coat) {
    SceneDescription scene = empty_scene();
    scene.film.width = 48, scene.film.height = 36;
    scene.depth = 6;
    scene.ambient = glm::dvec3(0.5);
    scene.background = glm::dvec3(1);
    scene.camera.position = {0, -4, 0};
    scene.camera.target = {0, 0, 0};
    scene.camera.field_of_view = 40;
    add_object(scene, SphereObject{glm::dvec3(0), 1}, add_material(scene, paper({0.8, 0.05, 0.05})));
    add_object(scene, SphereObject{glm::dvec3(0), 1 + coat}, add_material(scene, glass(1.5, true)));
    return scene;
}

Render thinner(SceneDescription (*make)(double), const std::vector<double>& sizes) {
    return [=](Stage& stage, Tally& tally) {
        std::vector<SceneDescription> scenes;
        for (const double size : sizes) scenes.push_back(make(size));
        expect_alike(stage, tally, scenes);
    };
}
/// What float would show where it warns.
Render float_of_thin(SceneDescription (*make)(double), double first, double thin) {
    return [=](Stage& stage, Tally& tally) {
        const auto film = [&](double size) {
            const SceneDescription scene = make(size);
            return stage.render(scene, 4 * scene.film.width, 4 * scene.film.height);
        };
        const Film expected = film(first);
        expect_one_of(tally, film(thin), {&expected}, 0);
    };
}

}  // namespace
}  // namespace size

void add_size(Cases& cases) {
    using namespace size;
    const Bound warns = no_failures("pixels", float_warns);
    constexpr PlatonicSolid tetrahedron = PlatonicSolid::tetrahedron;
    constexpr PlatonicSolid cube = PlatonicSolid::cube;
    constexpr PlatonicSolid octahedron = PlatonicSolid::octahedron;
    constexpr PlatonicSolid dodecahedron = PlatonicSolid::dodecahedron;
    constexpr PlatonicSolid icosahedron = PlatonicSolid::icosahedron;
    const auto floors = [&](const std::string& name, Look look, Shape shape, const Kinds& kinds) {
        cases.images("floor/" + name, "floors of half-size 1e3 to 1e9: the picture of one of 512", warns,
                     on_floor(look, shape, kinds));
    };
    floors("shadow/planes", Look::shadow, Shape::planes, {dodecahedron, tetrahedron});
    floors("shadow/triangles", Look::shadow, Shape::triangles, {icosahedron, cube});
    floors("reflection/planes", Look::reflection, Shape::planes, {dodecahedron, cube});
    floors("reflection/triangles", Look::reflection, Shape::triangles, {octahedron});
    floors("mirror", Look::mirror, Shape::planes, {icosahedron});
    floors("glass/planes", Look::glass, Shape::planes, {cube, octahedron});
    floors("glass/triangles", Look::glass, Shape::triangles, {cube});
    floors("texture", Look::texture, Shape::planes, {dodecahedron});
    cases.images("broken/float-on-a-floor-of-1e6", "without the warning: in float the shadow of a unit body is cut",
                 {Measure::failures, true, {20, 0}, "pixels"}, float_on_floor);
    const std::pair<const char*, Look> looks[] = {
        {"shadow", Look::shadow}, {"reflection", Look::reflection}, {"texture", Look::texture}};
    const char* as_near = "a seen light of 5e10 at 1e12: the picture with one of 5e4 at 1e6";
    for (const auto& [name, look] : looks) {
        cases.images(std::string("far-solid/") + name, "a solid of 1e5 at 1e7: the picture with one of 1e3 at 1e5",
                     warns, far_solid(look));
        cases.images(std::string("sun/") + name, as_near, warns, sun(look));
        cases.images(std::string("offset/") + name, "a scene at 1e7 and -1e7: the picture of the one at the origin",
                     no_failures("pixels"), at_offset(look));
    }
    cases.images("sun/seen", as_near, warns, sun(Look::shadow, true));
    const Bound float_fails{Measure::failures, true, {20, 0}, "pixels"};
    cases.images("wall", "a hollow under a wall of 4e-4 to 1e-8: the picture of one of 1e-3", warns,
                 thinner(hollow_cube, {1e-3, 4e-4, 1e-4, 1e-5, 1e-6, 1e-8}));
    cases.images("coat", "a coat of 1e-5 to 1e-10 on a ball of 1: the picture of one of 1e-4", warns,
                 thinner(coated_ball, {1e-4, 1e-5, 3e-6, 3e-7, 1e-8, 1e-10}));
    cases.images("broken/float-of-a-thin-wall", "without the warning: in float rays are lost in the wall", float_fails,
                 float_of_thin(hollow_cube, 1e-3, 1e-5));
    cases.images("broken/float-of-a-coat", "without the warning: in float there is no coat", float_fails,
                 float_of_thin(coated_ball, 1e-4, 3e-7));
}

}  // namespace cistula::verify
