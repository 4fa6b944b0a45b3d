// Smooth meshes: sides, energy, and how near they come to the surfaces that they stand for.
#include "image/reader/picture_reader.h"
#include "verify/cases/pictures.h"
#include "verify/cases/scenes.h"
#include "verify/cases/smooth/round_mesh.h"
#include "verify/cases/smooth/sides.h"

namespace cistula::verify {
namespace smooth {
namespace {

double one(const glm::dvec3&) {
    return 1;
}
double bumpy(const glm::dvec3& d) {
    return 0.9 + 0.16 * std::sin(5 * d.x + 1) * std::sin(4 * d.y + 2) * std::cos(3 * d.z);
}

/// Neighbors of up to 160 degrees apart.
TrianglesObject spread(TrianglesObject mesh) {
    for (size_t i = 0; i < mesh.normals.size(); ++i) {
        const glm::dvec3 n = mesh.normals[i];
        const glm::dvec3 beside = normalized(cross(n, glm::dvec3(0.6, i % 3 == 0 ? 0.8 : -0.7, 0.1)));
        mesh.normals[i] = normalized((i % 5 == 0 ? 1.0 : 0.16) * n + (i % 2 == 0 ? 1.0 : -1.0) * beside);
    }
    return mesh;
}

auto on_sides(bool raw) {
    return [=](Plan& plan) {
        for (const TrianglesObject& mesh : {round_mesh(2, one), round_mesh(3, bumpy), spread(round_mesh(2, bumpy))}) {
            SceneDescription scene = empty_scene();
            add_object(scene, mesh, add_material(scene, glass(1.5, true)));
            plan.add(std::to_string(plan.parts.size()), scene, Sides{raw}, {}, plan.rays(1'000'000, 20000));
        }
    };
}

/// A ball before a sky that varies smoothly, on a sphere around it.
template <class Shape>
SceneDescription under_sky(const Shape& shape, const MaterialDescription& material, int side = 60) {
    SceneDescription scene = empty_scene();
    scene.film.width = scene.film.height = side;
    scene.depth = 12;
    scene.ambient = glm::dvec3(1);
    scene.camera.position = {0, -4, 0.5};
    scene.camera.field_of_view = 33;
    auto texels = std::make_shared<TexelArray>();
    texels->width = 512;
    texels->height = 256;
    texels->channels = 1;
    std::vector<float> values;
    for (uint32_t y = 0; y < texels->height; ++y)
        for (uint32_t x = 0; x < texels->width; ++x) {
            const double a = 6.283185307179586 * (x + 0.5) / texels->width;
            const double z = std::cos(3.141592653589793 * (y + 0.5) / texels->height);
            const double r = std::sqrt(1 - z * z);
            values.push_back(
                float(0.5 + 0.2 * std::sin(7 * r * std::cos(a) + 1) + 0.2 * std::sin(6 * r * std::sin(a) + 4 * z)));
        }
    texels->values = std::move(values);
    scene.textures.push_back({.name = "sky", .texels = texels});
    scene.materials[0].texture = 0;
    SphereObject around;
    around.radius = 30;
    add_object(scene, around);
    add_object(scene, shape, add_material(scene, material));
    return scene;
}

/// The root of the mean square by which pixels differ that show the second object in both films.
double rms_of(const Film& found, const Film& expected) {
    const ColorPicture a = to_color(found);
    const ColorPicture b = to_color(expected);
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < a.texels.size(); ++i)
        if (found.pixels[i].id == 2 && expected.pixels[i].id == 2) {
            const double off = double(a.texels[i].x) - double(b.texels[i].x);
            sum += off * off;
            ++count;
        }
    return found.flags == 0 && count > 500 ? std::sqrt(sum / double(count)) : INFINITY;
}

/// Measures how far a mesh with 20,480 triangles is from the sphere, as a mirror and as glass.
void as_the_sphere(Stage& stage, Tally& tally) {
    const TrianglesObject mesh = round_mesh(5, one);
    const int side = stage.quick ? 30 : 60;  // of a loop over all triangles
    for (const MaterialDescription& material : {paper(glm::dvec3(0), 1), glass(1.5, true)}) {
        tally.place = place_of_scene(material.fresnel);
        tally.measure(
            rms_of(stage.film(under_sky(mesh, material, side)), stage.film(under_sky(SphereObject(), material, side))));
    }
}

/// A glass body in uniform light is invisible, but for what the depth cuts off.
void furnace(Stage& stage, Tally& tally) {
    uint64_t number = 0;
    for (const TrianglesObject& mesh :
         {round_mesh(2, bumpy), spread(round_mesh(2, one)), ring_mesh(24, 12, 0.7, 0.3)}) {
        SceneDescription scene = empty_scene();
        scene.film.width = scene.film.height = 48;
        scene.depth = 40;
        scene.background = glm::dvec3(1);
        scene.camera.position = {0, -3, 1.5};
        scene.camera.field_of_view = 40;
        add_object(scene, mesh, add_material(scene, glass(1.5, true)));
        const Film film = stage.film(scene);
        const double whole = std::ldexp(1.0, film.fixed_shift - film.radiance_exponent);
        for_each_pixel(film, [&](size_t pixel, int, int) {
            tally.place = place_of(number, 0, pixel);
            const PixelRecord& record = film.pixels[pixel];
            const double missing = whole - double(record.radiance[0]);
            tally.expect(film.flags == 0 && missing >= -whole * 256 * stage.unit() &&
                         missing <= double(record.cut[0]) + double(record.pruned[0]) + whole * 0x1p-12);
        });
        ++number;
    }
}

/// A coarse ball, lit from the side, is dark where the sphere is, and nowhere black where that is bright.
void terminator(Stage& stage, Tally& tally, bool flat) {
    const auto scene_of = [](const auto& shape) {
        SceneDescription scene = empty_scene();
        scene.film.width = scene.film.height = 60;
        scene.ambient = glm::dvec3(0);
        scene.camera.position = {0, 0, 4};
        scene.camera.up = {0, 1, 0};
        scene.camera.field_of_view = 33;
        add_object(scene, shape, add_material(scene, paper(glm::dvec3(1))));
        add_light(scene, {100, 30, 15});
        return scene;
    };
    TrianglesObject mesh = round_mesh(3, one);
    if (flat) mesh.smooth = 0;
    const Film found = stage.film(scene_of(mesh));
    const Film expected = stage.film(scene_of(SphereObject()));
    for_each_pixel(found, [&](size_t pixel, int, int) {
        if (found.pixels[pixel].id != 1 || expected.pixels[pixel].id != 1) return;
        tally.place = pixel;
        const double light = radiance(found, pixel);
        const double wanted = radiance(expected, pixel);
        tally.expect(magnitude(light - wanted) < 0.05 && (light > 0 || wanted < 0.02));
    });
}

/// Nothing of a coarse ball that a floor cuts is lit from below the floor.
void under_a_floor(Stage& stage, Tally& tally) {
    for (const double height : {-0.98, -0.95, -0.9}) {
        SceneDescription scene = empty_scene();
        scene.film.width = scene.film.height = 60;
        scene.ambient = glm::dvec3(0);
        scene.camera.position = {0, -4, height + 1};
        scene.camera.target = {0, 0, height + 0.2};
        scene.camera.field_of_view = 33;
        add_object(scene, round_mesh(2, one), add_material(scene, paper(glm::dvec3(1))));
        add_object(scene, floor_of_half(20, height), add_material(scene, paper(glm::dvec3(1))));
        add_light(scene, {3, -9, height - 0.7});
        add_light(scene, {-6, -4, height - 0.05});
        const Film film = stage.film(scene);
        for_each_pixel(film, [&](size_t pixel, int, int) {
            tally.place = place_of(uint64_t(-100 * height), 0, pixel);
            tally.expect(radiance(film, pixel) == 0);
        });
    }
}

/// A liquid in a smooth cup looks as one that reaches into the wall, where no face is shared, but for lines that meet
/// edges. `lean`: by how much its normals differ from the wall's.
void contact(Stage& stage, Tally& tally, double lean) {
    for (const bool is_ring : {false, true}) {
        const TrianglesObject liquid = is_ring ? ring_mesh(16, 8, 0.7, 0.25) : round_mesh(1, one);
        TrianglesObject leaning = liquid;
        for (glm::dvec3& n : leaning.normals) n = normalized(normalized(n) + lean * glm::dvec3(0.6, 0, 0.8));
        const auto film_of = [&](const TrianglesObject& filling, double hole) {
            TrianglesObject cup = is_ring ? ring_mesh(16, 8, 0.7, 0.3) : moved(liquid, glm::dvec3(0), glm::dvec3(1.2));
            const auto first = uint32_t(cup.vertices.size());
            for (size_t i = 0; i < liquid.vertices.size(); ++i) {
                const glm::dvec3 n = normalized(liquid.normals[i]);
                cup.vertices.push_back(liquid.vertices[i] - hole * n);
                cup.normals.push_back(-n);
            }
            for (const auto& t : liquid.triangles) cup.triangles.push_back({t[0] + first, t[2] + first, t[1] + first});
            SceneDescription scene = under_sky(cup, glass(1.5, true));
            scene.film.width = scene.film.height = 32;
            scene.depth = 5;
            add_object(scene, filling, add_material(scene, glass(1.33, true)));
            return stage.film(scene);
        };
        const Film film = film_of(leaning, 0);
        const Film expected = film_of(liquid, 0.03);
        size_t differing = 0;
        for_each_pixel(film, [&](size_t pixel, int, int) {
            differing += !(magnitude(radiance(film, pixel) - radiance(expected, pixel)) <= 0.01);
        });
        tally.place = is_ring;
        tally.expect(differing <= film.pixels.size() / 100);
    }
}

}  // namespace
}  // namespace smooth

void add_smooth(Cases& cases) {
    using namespace smooth;
    cases.rays<Sides>("sides", "mirrored rays stay on their side of a face, bent ones do not, and F + (1 - F) = 1",
                      no_failures("rays", needs_witness), on_sides(false));
    cases.rays<Sides>("broken/raw-normals", "normals between corners, as they are, mirror into the face",
                      must_fail(100, "rays"), on_sides(true));
    cases.images("as-the-sphere", "20,480 triangles and the sphere, mirror and glass", at_most(0.002, "rms"),
                 as_the_sphere);
    cases.images("furnace", "the background's color, whatever the normals", no_failures("pixels"), furnace);
    cases.images("terminator", "a coarse ball is lit as the sphere", no_failures("pixels"),
                 [](Stage& stage, Tally& tally) { terminator(stage, tally, false); });
    cases.images("broken/flat-terminator", "flat faces are not lit as the sphere", must_fail(50, "pixels"),
                 [](Stage& stage, Tally& tally) { terminator(stage, tally, true); });
    cases.images("contact", "a liquid that reaches into the wall of its cup", no_failures("pictures"),
                 [](Stage& stage, Tally& tally) { contact(stage, tally, 0); });
    cases.images("broken/leaning-contact", "faces whose normals disagree are flat", must_fail(2, "pictures"),
                 [](Stage& stage, Tally& tally) { contact(stage, tally, 0x1p-4); });
    cases.images("under-a-floor", "no light from below a floor", no_failures("pixels"), under_a_floor);
}

}  // namespace cistula::verify
