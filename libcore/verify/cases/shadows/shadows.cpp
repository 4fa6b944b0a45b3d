// Cases on the light that reaches a point: self-shadowing of faces, shadows of closed bodies and of glass, lights in
// contact with these.
#include <fmt/format.h>

#include <algorithm>

#include "verify/cases/pictures.h"
#include "verify/cases/shadows/local_light.h"
#include "verify/cases/shadows/scenes.h"

namespace cistula::verify {
namespace shadows {

void add_lights(Cases& cases);  // lights.cpp

namespace {

// ---- no face and no convex body shadows itself

/// Eight lights around a body, four far ones, and twelve that graze its faces: in the frame the lowest is 2^-18 of the
/// radius over the plane of a face.
void add_lights_around(SceneDescription& scene, const SolidObject& body) {
    const Polyhedron& shape = platonic_shape(body.solid);
    const Rotation turned(body.rotation);
    for (uint32_t k = 0; k < 12; ++k) {
        const double z = (2.0 * k + 1) / 12 - 1;
        const double r = std::sqrt(1 - z * z);
        const double a = 2.4 * k;
        add_light(scene, body.center +
                             glm::dvec3(r * std::cos(a), r * std::sin(a), z) * (body.radius * (k % 3 ? 3.0 : 100.0)));
    }
    for (uint32_t k = 0; k < 12; ++k) {
        const auto& face = shape.faces[k % shape.faces.size()];
        const glm::dvec3 along_face = shape.vertices[face.vertices[k % 3]] - face.normal * shape.inradius;
        const double height = shape.inradius + std::ldexp(1.0, int(k % 4) * 5 - 18);
        add_light(scene, body.center + turned(face.normal * height + along_face * (k % 2 ? 0.5 : 3.0)) * body.radius);
    }
}

void plan_acne(Plan& plan, Body body, const std::vector<double>& offsets, bool far_from_the_middle) {
    const uint64_t rays = plan.rays(400'000, 2000);
    const auto tilts = {glm::dvec3(0), glm::dvec3(0x1p-10, 0, 0), glm::dvec3(45, 0, 0), glm::dvec3(17, 41, 73),
                        glm::dvec3(89.99, 0, 45)};
    for (const double offset : offsets)
        for (const glm::dvec3& tilt : tilts)
            for (const PlatonicSolid kind : {PlatonicSolid::cube, PlatonicSolid::dodecahedron}) {
                const SolidObject solid = solid_object(kind, glm::dvec3(1, -0.7, 0.3) * offset, 1, tilt);
                SceneDescription scene = dark_scene();
                if (body == Body::sheet) {
                    const uint32_t cells = kind == PlatonicSolid::cube ? 1 : 8;
                    add_object(scene, square(0.8, platonic_shape(kind).inradius, cells, false, tilt, solid.center));
                } else {
                    add_solid(scene, body == Body::planes ? Shape::planes : Shape::triangles, solid);
                }
                // Something at the other end makes the scene as large as the offset.
                if (far_from_the_middle) add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube));
                add_lights_around(scene, solid);
                const std::string label =
                    fmt::format("{}, offset {}, tilts {} {} {}", platonic_name(kind), offset, tilt.x, tilt.y, tilt.z);
                plan.add(label, std::move(scene), LitInFull{0}, {}, rays).frame_numbers =
                    ball_numbers(solid.center, solid.radius);
            }
}

/// The facets of a coarse sphere that the light just reaches are fully lit, those that it just misses are dark: facets
/// cast no jagged shadows on one another.
void plan_terminator(Plan& plan) {
    for (const uint32_t triangles : {24u, 80u, 360u, 1500u})
        for (const glm::dvec3& rotation : turns) {
            SceneDescription scene = dark_scene();
            TrianglesObject sphere = bumpy_sphere(triangles, 0);
            const Rotation turned(rotation);
            for (glm::dvec3& p : sphere.vertices) p = turned(p);
            add_object(scene, sphere);
            for (uint32_t k = 0; k < 16; ++k) {
                const double a = 0.39 * k;
                const double far = k % 4 == 3 ? 1000 : 1.25 + k;
                add_light(scene, glm::dvec3(std::cos(a), std::sin(a), k % 2 ? 0.1 * k : 0.0) * far);
            }
            plan.add(std::to_string(triangles) + " triangles", std::move(scene), LitInFull{0}, {},
                     plan.rays(500'000, 8000))
                .frame_numbers = ball_numbers(glm::dvec3(0), 1);
        }
}

void plan_falloff(Plan& plan) {
    for (const double scale : {1.0, 0x1p40, 0x1p-40})
        for (const double height : {0.5, 1.0, 3.0})
            for (const int body : {0, 1, 2}) {
                SceneDescription scene = dark_scene();
                scene.materials[0].color = glm::dvec3(1);
                if (body == 2)
                    add_solid(scene, Shape::planes,
                              solid_object(PlatonicSolid::cube, {0, 0, -scale}, 1.7320508075688772 * scale));
                else
                    add_object(scene, square(scale, 0, body ? 16 : 1, false));
                scene.lights.push_back({.position = glm::dvec3(0.25, -0.125, height) * scale,
                                        .color = glm::dvec3(scale * scale),
                                        .radius = 0x1p-6 * scale,
                                        .falloff = true});
                plan.add(body == 2 ? "cube"
                         : body    ? "square of 512"
                                   : "square",
                         scene, Falloff(), {}, plan.rays(1'000'000, 2000))
                    .frame_numbers = ball_numbers(glm::dvec3(0), scale);
            }
}

// ---- no light leaves a closed opaque solid, not through its edges and corners either; glass transmits its exact share

/// Lights inside a solid: in the middle, near its faces, edges and corners.
void add_lights_inside(SceneDescription& scene, const SolidObject& solid) {
    const Polyhedron& shape = platonic_shape(solid.solid);
    const Rotation turned(solid.rotation);
    const auto add = [&](const glm::dvec3& p) { add_light(scene, solid.center + turned(p) * solid.radius); };
    const auto& edge = shape.edges.back();
    add({0, 0, 0});
    add(shape.faces.front().normal * (shape.inradius * (1 - 0x1p-10)));
    add(shape.vertices.front() * (1 - 0x1p-8));
    add((shape.vertices[edge.vertices[0]] * 0.75 + shape.vertices[edge.vertices[1]] * 0.25) * (1 - 0x1p-8));
}

/// Adds the parts. `tiny`: only the solid that is a few floating-point numbers wide; else all others.
void plan_boxes(Plan& plan, Shape shape, int halvings, bool tiny) {
    for (const PlatonicSolid kind : platonic_solids)
        for (const Placement& placement : placements())
            for (const glm::dvec3& rotation : turns) {
                if (placement.beside_unit != tiny) continue;
                PlacedSolid placed = placed_solid(kind, shape, placement, rotation);
                placed.scene.materials[0].transmission = halvings < 0 ? 0 : std::ldexp(1.0, -halvings);
                add_lights_inside(placed.scene, placed.solid);
                Part& part = plan.add(placed.label, placed.scene, FromOutside{placed.number, halvings},
                                      edge_points(placed.solid), plan.rays(200'000, 1000));
                part.frame_numbers = [solid = placed.solid](const PartFrame& frame, Numbers& numbers) {
                    numbers = {solid.radius * frame.factor,
                               0x1p-51 * (length(solid.center) + solid.radius) * frame.factor};
                    add_planes(solid, frame, numbers);
                };
            }
}

/// A floor around opaque solids with lights inside, rendered.
void box_pixels(Stage& stage, Tally& tally) {
    const int width = stage.quick ? 40 : 320;
    const int height = stage.quick ? 30 : 240;
    for (int k = 0; k < 6; ++k) {
        SceneDescription scene = dark_scene();
        scene.camera.position = {0.3, -6, 3};
        scene.camera.target = {0, 0, -0.5};
        add_object(scene, square(8, -1.25, 4, false));
        const SolidObject solid = solid_object(platonic_solids[k % 5], {0.1, 0.2, 0}, 1.2, {17, 41, 73});
        if (k < 5)
            add_solid(scene, k % 2 ? Shape::planes : Shape::triangles, solid);
        else
            add_object(scene, torus(1.2, 0.5, 24, 12));
        if (k < 5)
            add_lights_inside(scene, solid);
        else
            for (const double a : {0.1, 2.0, 4.0}) add_light(scene, {1.2 * std::cos(a), 1.2 * std::sin(a), 0.3});
        Film film = stage.render(scene, width, height);
        for (const PixelRecord& pixel : film.pixels) {
            ++tally.place;
            tally.expect(pixel.radiance[0] == 0 && pixel.radiance[1] == 0 && pixel.radiance[2] == 0);
        }
        // The picture with a light outside is not dark, so nothing else darkens it.
        add_light(scene, {0.5, -3, 4});
        film = stage.render(scene, width, height);
        int lit = 0;
        for (const PixelRecord& pixel : film.pixels) lit += pixel.radiance[0] != 0;
        tally.expect(lit > width * height / 4);
        tally.witness(lit > 0);
    }
}

// ---- a shadow through faces of transmission 2^-k is 2^-(sum of k), also where triangles meet

void plan_sheets(Plan& plan) {
    for (const uint32_t sheets : {1u, 2u, 5u, 20u})
        for (const bool stopped : {false, true})
            for (const glm::dvec3& rotation : turns) {
                SceneDescription scene = dark_scene();
                ThroughSheets functor{{0, 0, 0}};
                std::vector<glm::dvec3> points;
                for (uint32_t s = 0; s < sheets; ++s) {
                    const int all = int((s * 5 + sheets) % 4);
                    const int green = int(s % 3);
                    MaterialDescription glass = scene.materials[0];
                    glass.transmission = std::ldexp(1.0, -all);
                    glass.tint = {1, std::ldexp(1.0, -green), stopped && s == sheets / 2 ? 0 : 0.5};
                    functor.loss[0] += all, functor.loss[1] += all + green, functor.loss[2] += all + 1;
                    const TrianglesObject sheet = square(4, 0.04 * s - 0.4, 16, s % 2 != 0, rotation);
                    add_object(scene, sheet, add_material(scene, glass));
                    for (const uint32_t x : {6u, 7u, 8u, 9u, 10u})
                        for (const uint32_t y : {6u, 8u, 9u}) {
                            const glm::dvec3 &a = sheet.vertices[17 * y + x], &b = sheet.vertices[17 * y + x + 1],
                                             &c = sheet.vertices[17 * y + x + 17];
                            points.insert(points.end(), {a, a + 0.5 * (b - a), a + 0.3125 * (c - a), 0.5 * (b + c)});
                        }
                }
                if (stopped) functor.loss[2] = -1;
                const Rotation turned(rotation);
                for (const glm::dvec3& light :
                     {glm::dvec3(0, 0, 2), glm::dvec3(0.5, -0.5, 2), glm::dvec3(0.37, 0.11, 1.5)})
                    add_light(scene, turned(light));
                Part& part = plan.add(std::to_string(sheets) + (stopped ? " sheets, blue stopped" : " sheets"), scene,
                                      functor, points, plan.rays(400'000, 1000));
                part.frame_numbers = [axis = turned(glm::dvec3(0, 0, 1))](const PartFrame& frame, Numbers& numbers) {
                    numbers = {axis.x, axis.y, axis.z, (-0.6 - dot(axis, frame.center)) * frame.factor};
                };
            }
}

void plan_solids(Plan& plan) {
    for (const bool first_of_triangles : {false, true})
        for (const double scale : {1.0, 0x1p40, 0x1p-40}) {
            SceneDescription scene = dark_scene();
            std::vector<SolidObject> all;
            std::vector<glm::dvec3> points;
            for (uint32_t s = 0; s < ThroughSolids::solids; ++s) {
                const SolidObject solid = solid_object(platonic_solids[s], glm::dvec3(0.35 * s - 0.7, 0, 0) * scale,
                                                       0.16 * scale, s % 2 ? glm::dvec3(0) : glm::dvec3(31, 47, 11));
                MaterialDescription glass = scene.materials[0];
                glass.transmission = std::ldexp(1.0, -(1 << s));
                add_solid(scene, (s % 2 == 0) == first_of_triangles ? Shape::triangles : Shape::planes, solid,
                          add_material(scene, glass));
                all.push_back(solid);
                const std::vector<glm::dvec3> its = edge_points(solid);
                points.insert(points.end(), its.begin(), its.end());
            }
            for (const glm::dvec3& light :
                 {glm::dvec3(1.5, 0, 0), glm::dvec3(1.25, 0.0625, -0.03), glm::dvec3(-1.5, 0.1, 1)})
                add_light(scene, light * scale);
            Part& part = plan.add(first_of_triangles ? "triangles first" : "planes first", scene, ThroughSolids(),
                                  points, plan.rays(1'000'000, 4000));
            part.frame_numbers = [all](const PartFrame& frame, Numbers& numbers) {
                Numbers planes;
                for (const SolidObject& solid : all) {
                    const size_t before = planes.size();
                    add_planes(solid, frame, planes);
                    numbers.push_back(double(planes.size() - before));
                }
                numbers.insert(numbers.end(), planes.begin(), planes.end());
            };
        }
}

// ---- the order of triangles and lights in a file does not change any integer of a film

/// Glass and mirrors of triangles and of planes in a room with many lights, in a frame with the bound pinned: the sum
/// of the lights' intensities, of which the bound is made, is rounded in their order.
SceneDescription glass_room() {
    SceneDescription scene = dark_scene();
    scene.ambient = glm::dvec3(0.125);
    scene.frame = FrameOfReference{glm::dvec3(0), -3, 4096.0};
    scene.camera.position = {0.4, -5, 2.5};
    scene.camera.target = {0, 0, 0.2};
    scene.materials[0].specular = 0.5;
    scene.materials[0].exponent = 20;
    MaterialDescription glass = scene.materials[0];
    glass.transmission = 0.6, glass.reflection = 0.2, glass.index = 1.3;
    glass.tint = {0.9, 0.7, 0.5};
    glass.absorption = {0.1, 0.2, 0.05};
    const int tinted = add_material(scene, glass);
    glass.transmission = 0.47, glass.tint = {0.6, 0.8, 1};
    const int bluish = add_material(scene, glass);
    glass.transmission = 0.71;
    const int clearer = add_material(scene, glass);
    add_object(scene, square(6, -1.1, 3, false));
    add_object(scene, moved(star(0.6, 1.1), {-1, 0.3, 0}), tinted);
    add_object(scene, moved(torus(0.7, 0.25, 12, 8), {1, 0.5, 0.3}), bluish);
    add_solid(scene, Shape::planes, solid_object(PlatonicSolid::icosahedron, {0.2, -1.2, -0.2}, 0.6, {17, 41, 73}),
              clearer);
    for (uint32_t k = 0; k < 24; ++k) {
        const double a = 0.61 * k;
        LightDescription& light = add_light(scene, {2.7 * std::cos(a), 2.3 * std::sin(a), 1.3 + 0.1 * k});
        light.color = glm::dvec3(0.1 + 0.013 * k, 0.3 - 0.007 * k, 0.2) * (k % 3 ? 1.0 : 1.7);
        light.radius = k % 4 ? 0 : 0.05;
        light.falloff = k % 8 == 0;
    }
    return scene;
}

/// A permutation of the numbers below n: the reverse, or a random one.
std::vector<uint32_t> permutation(size_t n, uint64_t which) {
    std::vector<uint32_t> order(n);
    for (size_t i = 0; i < n; ++i) order[i] = uint32_t(n - 1 - i);
    if (which != 0)
        std::sort(order.begin(), order.end(),
                  [&](uint32_t a, uint32_t b) { return mixed(a + (which << 32)) < mixed(b + (which << 32)); });
    return order;
}
template <class T>
void permute(std::vector<T>& items, uint64_t which) {
    const std::vector<T> before = items;
    const std::vector<uint32_t> order = permutation(items.size(), which);
    for (size_t i = 0; i < items.size(); ++i) items[i] = before[order[i]];
}

/// The id of a pixel in a scene whose lights are permuted, in the original order of lights.
int32_t id_before(const SceneDescription& scene, int32_t id, uint64_t which) {
    const auto solids = int32_t(scene.objects.size());
    if (id <= solids) return id;
    std::vector<uint32_t> visible;  // the lights with a radius, in their new order
    for (const uint32_t light : permutation(scene.lights.size(), which))
        if (scene.lights[light].shown()) visible.push_back(light);
    const uint32_t light = visible[size_t(id - solids - 1)];
    int32_t before = solids + 1;
    for (uint32_t i = 0; i < light; ++i) before += scene.lights[i].shown();
    return before;
}

/// Glass and mirrors whose lights or triangles come in another order.
auto permuted(bool lights) {
    return [=](Stage& stage, Tally& tally) {
        const int width = stage.quick ? 40 : 240;
        const int height = stage.quick ? 30 : 180;
        const SceneDescription scene = glass_room();
        const Film expected = stage.render(scene, width, height);
        for (uint64_t which = 0; which < (stage.quick ? 2 : 4); ++which) {
            SceneDescription other = scene;
            if (lights) permute(other.lights, which);
            for (ObjectDescription& object : other.objects)
                if (auto* mesh = std::get_if<TrianglesObject>(&object.shape); mesh && !lights)
                    permute(mesh->triangles, which);
            const Film found = stage.render(other, width, height);
            tally.expect(found.radiance_exponent == expected.radiance_exponent &&
                         found.fixed_shift == expected.fixed_shift);
            for (size_t i = 0; i < expected.pixels.size(); ++i) {
                const PixelRecord &a = expected.pixels[i], &b = found.pixels[i];
                ++tally.place;
                for (int c = 0; c < 3; ++c) {
                    tally.expect(a.radiance[c] == b.radiance[c]);
                    tally.expect(a.pruned[c] == b.pruned[c] && a.cut[c] == b.cut[c]);
                }
                const int32_t id = lights ? id_before(scene, b.id, which) : b.id;
                tally.expect(a.hits == b.hits && a.rays == b.rays && a.id == id && a.z == b.z);
                tally.witness(a.id > 1 && a.radiance[0] > 0);
            }
        }
    };
}

}  // namespace
}  // namespace shadows

void add_shadows(Cases& cases) {
    using namespace shadows;
    const Bound pixels = no_failures("pixels");
    const Bound lit_pixels = no_failures("pixels", needs_witness);
    const auto acne = [&](const std::string& name, const char* exact, const Bound& bound, Body body,
                          const std::vector<double>& offsets, bool far_from_the_middle) {
        cases.rays<LitInFull>("acne/" + name, exact, bound,
                              [=](Plan& plan) { plan_acne(plan, body, offsets, far_from_the_middle); });
    };
    // Offsets of solids in scene units, which scene coordinates take away.
    const std::vector<double> offsets = {0, 1, 1e3, 1e6};
    acne("planes", "a convex solid lights up in full, tilts x offsets 0 to 1e6", lit_pixels, Body::planes, offsets,
         false);
    acne("triangles", "a convex mesh lights up in full, tilts x offsets 0 to 1e6", lit_pixels, Body::triangles, offsets,
         false);
    acne("sheets", "a square lights up in full, tilts x offsets 0 to 1e6", lit_pixels, Body::sheet, offsets, false);
    // So far from the middle of its scene, whose size is that distance, that the body is 2^-10 to 2^-20 of it.
    acne("far-from-the-middle/planes", "the same of a solid 1e3 to 1e6 radii from the middle of its scene", pixels,
         Body::planes, {1e3, 1e4, 1e5, 1e6}, true);
    acne("far-from-the-middle/triangles", "the same of a mesh 1e3 to 1e5 radii from the middle of its scene",
         no_failures("pixels", float_warns), Body::triangles, {1e3, 1e4, 1e5}, true);
    // A mesh of a dozen ulps of its coordinates.
    acne("far-from-the-middle/tiny-triangles", "the same of a mesh 1e6 radii from the middle of its scene",
         no_failures("pixels", float_warns), Body::triangles, {1e6}, true);
    cases.rays<LitInFull>("terminator", "facets of a coarse sphere are lit by their own half-space alone", lit_pixels,
                          plan_terminator);

    const auto box = [&](const std::string& name, const char* exact, int halvings, bool tiny,
                         const std::vector<Shape>& shapes) {
        cases.rays<FromOutside>(name, exact, no_failures("shadow rays", tiny ? uint32_t(float_warns) : 0),
                                [=](Plan& plan) {
                                    for (const Shape shape : shapes) plan_boxes(plan, shape, halvings, tiny);
                                });
    };
    const Shape planes = Shape::planes;
    const Shape triangles = Shape::triangles;
    box("closed-box/planes", "0 light outside closed opaque solids, aimed through edges and corners", -1, false,
        {planes});
    box("closed-box/triangles", "0 light outside closed opaque meshes, aimed through edges and corners", -1, false,
        {triangles});
    // A solid of 8 to 16 ulps of its coordinates: no light in it is farther from its faces than what counts as on them.
    box("closed-box/tiny", "the same of a solid of radius 2^-20 beside a unit one", -1, true, {planes, triangles});
    cases.images("closed-box/pixels", "every pixel of a floor around opaque solids with lights in them is 0",
                 lit_pixels, box_pixels);
    box("light-inside/planes", "a light inside a glass solid: one face's share outside", 3, false, {planes});
    box("light-inside/triangles", "a light inside a glass mesh: one face's share outside", 3, false, {triangles});

    add_lights(cases);
    // In u, relative. The way to the light: 1 a component. Its square: 2 + 1 a product, 2 for two sums of positive
    // terms, 5; its root 2.5 + 1 = 3.5, the reciprocal 4.5; N.L = h times that: 1 + 4.5 + 1 = 6.5, the normal being
    // exact. kd N.L, C times it and I times it: 1 each where the factor is no power of two, but all are: 0. r^2: 7 + 1,
    // 1/r^2 9, the product 10. 16.5 in all; the sums' truncation 0.5 at what is tried. 17 u are 8.5 ulps of 2 u.
    cases.rays<Falloff>("falloff", "light on a plane under a lamp is I h/(h^2+x^2)^(3/2)",
                        at_most(8.5, "ulps", needs_witness), plan_falloff);
    cases.rays<ThroughSheets>("exact-product/sheets",
                              "through m sheets of transmission 2^-k exactly 2^-sum, at shared edges too",
                              no_failures("shadow rays"), plan_sheets);
    cases.rays<ThroughSolids>("exact-product/solids",
                              "through closed solids exactly 2^-sum over two faces each, aimed at their edges",
                              no_failures("shadow rays", needs_witness), plan_solids);
    cases.images("permuted-triangles", "0 differing integers of films of meshes in another order",
                 no_failures("integers", needs_witness), permuted(false));
    cases.images("permuted-lights", "0 differing integers of films with their lights in another order",
                 no_failures("integers", needs_witness), permuted(true));
}

}  // namespace cistula::verify
