// Cases on the light that reaches a point: self-shadowing of faces, shadows of closed bodies and of glass, lights in
// contact with these.
#include <fmt/format.h>

#include <algorithm>

#include "apps/render_verify/pictures.h"
#include "apps/render_verify/scenes.h"
#include "apps/render_verify/shadows/local_light.h"

namespace cistula::verify {
namespace shadows {
namespace {

/// A scene of lights only, so that what is dark is in shadow.
SceneDescription dark_scene() {
    SceneDescription scene = empty_scene();
    scene.ambient = glm::dvec3(0);
    return scene;
}
/// The square [-half, half]^2 at height z, rotated; n x n cells of two triangles, cut along one diagonal or the other.
TrianglesObject square(double half, double z, uint32_t n, bool other_way, const glm::dvec3& rotation = glm::dvec3(0),
                       const glm::dvec3& center = glm::dvec3(0)) {
    const Rotation turned(rotation);
    TrianglesObject mesh;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x)
            mesh.vertices.push_back(center + turned(glm::dvec3(half * (2.0 * x / n - 1), half * (2.0 * y / n - 1), z)));
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            if (other_way) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({b, d, c});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({a, d, c});
            }
        }
    return mesh;
}

// ---- no face and no convex body shadows itself

/// Eight lights around a body, four far ones, and twelve that graze its faces: in the frame the lowest is 2^-18 of the
/// radius over the plane of a face.
void add_lights_around(SceneDescription& scene, const SolidObject& body) {
    const PlatonicShape& shape = platonic_shape(body.solid);
    const Rotation turned(body.rotation);
    for (uint32_t k = 0; k < 12; ++k) {
        const double z = (2.0 * k + 1) / 12 - 1, r = std::sqrt(1 - z * z), a = 2.4 * k;
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

/// The object at a placement: a solid of planes, its triangles, or a square that faces up before rotation.
enum class Body { planes, triangles, sheet };

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
                const double a = 0.39 * k, far = k % 4 == 3 ? 1000 : 1.25 + k;
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
    const PlatonicShape& shape = platonic_shape(solid.solid);
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
    const int width = stage.quick ? 40 : 320, height = stage.quick ? 30 : 240;
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
                    const int all = int((s * 5 + sheets) % 4), green = int(s % 3);
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

// ---- lights on faces, edges and corners: half-spaces decide, no comparison of nearly equal distances

/// A light on a corner, an edge or a face of a solid, with the faces on which it lies as bits, by construction.
struct OnSolid {
    glm::dvec3 place;  // for the solid at the origin with radius 1, not rotated
    uint32_t faces;
};

/// The faces of a solid that a test holds of, as bits.
template <class Holds>
uint32_t face_bits(const PlatonicShape& shape, const Holds& holds) {
    uint32_t bits = 0;
    for (uint32_t f = 0; f < shape.faces.size(); ++f) bits |= uint32_t(holds(shape.faces[f])) << f;
    return bits;
}

std::vector<OnSolid> places_on(const PlatonicShape& shape) {
    const auto faces_of = [&](uint32_t vertex) {
        return face_bits(shape, [=](const auto& face) {
            return std::count(face.vertices.begin(), face.vertices.end(), vertex) != 0;
        });
    };
    std::vector<OnSolid> places;
    for (uint32_t v = 0; v < shape.vertices.size(); v += 3) places.push_back({shape.vertices[v], faces_of(v)});
    for (uint32_t e = 0; e < shape.edges.size(); e += 3) {
        const auto& edge = shape.edges[e];
        const double s = (e % 15 + 1) / 16.0;
        const glm::dvec3 &a = shape.vertices[edge.vertices[0]], &b = shape.vertices[edge.vertices[1]];
        places.push_back({a + s * (b - a), faces_of(edge.vertices[0]) & faces_of(edge.vertices[1])});
    }
    for (uint32_t f = 0; f < shape.faces.size(); f += 3)
        places.push_back({shape.faces[f].normal * shape.inradius + 0.25 * (shape.vertices[shape.faces[f].vertices[1]] -
                                                                           shape.faces[f].normal * shape.inradius),
                          uint32_t(1) << f});
    return places;
}

/// Adds a part of rays at solids with lights on them: `on` has the lights' places for each solid.
template <class Functor = HalfSpaces>
Part& add_lights_on(Plan& plan, const std::string& label, const SceneDescription& scene,
                    const std::vector<SolidObject>& solids, const std::vector<std::vector<OnSolid>>& on, bool glass,
                    uint64_t rays) {
    Functor functor;
    static_cast<HalfSpaces&>(functor) = {
        uint32_t(solids.size()), uint32_t(platonic_shape(solids[0].solid).faces.size()), uint32_t(on[0].size()), glass};
    Part& part = plan.add(label + (glass ? ", glass" : ", opaque"), scene, functor, {}, rays);
    part.frame_numbers = [solids, on](const PartFrame& frame, Numbers& numbers) {
        for (size_t k = 0; k < on[0].size(); ++k)
            for (size_t s = 0; s < solids.size(); ++s) numbers.push_back(on[s][k].faces);
        for (const SolidObject& solid : solids) add_planes(solid, frame, numbers);
    };
    return part;
}
/// A material of glass or opaque, for lights on faces.
void make_glass(SceneDescription& scene, bool glass) {
    scene.materials[0].transmission = glass ? std::ldexp(1.0, -glass_halvings) : 0;
}

void plan_lights_on(Plan& plan, Shape shape) {
    const uint64_t rays = plan.rays(300'000, 1000);
    for (const PlatonicSolid kind : platonic_solids)
        for (const bool glass : {false, true})
            for (const glm::dvec3& rotation : turns)
                for (const Placement& placement : placements()) {
                    // A light given by scene units lies on a plane to within their rounding; where that is more than
                    // the frame's, only a solid's own edge lights are sure to.
                    if (placement.center != glm::dvec3(0)) continue;
                    PlacedSolid placed = placed_solid(kind, shape, placement, rotation);
                    make_glass(placed.scene, glass);
                    const std::vector<OnSolid> on = places_on(platonic_shape(kind));
                    const Rotation turned(rotation);
                    for (const OnSolid& light : on)
                        add_light(placed.scene, placed.solid.center + turned(placed.solid.radius * light.place));
                    add_lights_on(plan, placed.label, placed.scene, {placed.solid}, {on}, glass, rays);
                }
}

/// Edge lights of solids far from the origin of their scene units, at 1e6 and 1e-6.
void plan_edge_lights(Plan& plan) {
    for (const PlatonicSolid kind : platonic_solids)
        for (const bool glass : {false, true})
            for (const Placement& placement : {placements()[1], placements()[2]}) {
                PlacedSolid placed = placed_solid(kind, Shape::planes, placement, turns[1]);
                SceneDescription scene = empty_scene();
                make_glass(scene, glass);
                placed.solid.edge_lights.count = 3;
                add_object(scene, placed.solid);
                std::vector<OnSolid> on;
                for (const auto& edge : platonic_shape(kind).edges) {
                    const uint32_t faces = face_bits(platonic_shape(kind), [&](const auto& face) {
                        return face.id == edge.faces[0] || face.id == edge.faces[1];
                    });
                    on.insert(on.end(), 3, {glm::dvec3(0), faces});
                }
                add_lights_on(plan, placed.label + ", edge lights", scene, {placed.solid}, {on}, glass,
                              plan.rays(300'000, 1000));
            }
}

/// Lights between two touching cubes of planes or triangles, and at the border of the shared face.
void plan_lights_in_contact(Plan& plan) {
    const double half_diagonal = 0.86602540378443864676;  // half the diagonal of a cube of side 1
    const PlatonicShape& shape = platonic_shape(PlatonicSolid::cube);
    for (int shapes = 0; shapes < 4; ++shapes)
        for (const bool glass : {false, true}) {
            const std::vector<SolidObject> solids = {solid_object(PlatonicSolid::cube, {-0.5, 0, 0}, half_diagonal),
                                                     solid_object(PlatonicSolid::cube, {0.5, 0, 0}, half_diagonal)};
            SceneDescription scene = empty_scene();
            make_glass(scene, glass);
            std::vector<std::vector<OnSolid>> on(2);
            for (int s = 0; s < 2; ++s) add_solid(scene, shapes >> s & 1 ? Shape::triangles : Shape::planes, solids[s]);
            for (const glm::dvec3& light : {glm::dvec3(0, 0, 0), glm::dvec3(0, 0.1, 0.2), glm::dvec3(0, 0.5, 0.125),
                                            glm::dvec3(0, 0.5, -0.5), glm::dvec3(0, -0.25, 0.5)}) {
                add_light(scene, light);
                for (int s = 0; s < 2; ++s)
                    on[s].push_back({light, face_bits(shape, [&](const auto& face) {
                                         return magnitude(dot(face.normal, light - solids[s].center) - 0.5) < 1e-9;
                                     })});
            }
            add_lights_on(plan, "cubes", scene, solids, on, glass, plan.rays(300'000, 3000));
        }
}

void plan_star(Plan& plan) {
    for (const bool glass : {false, true})
        for (const double scale : {1.0, 0x1p40, 0x1p-40}) {
            TrianglesObject mesh = star(0.5, 1);
            for (glm::dvec3& p : mesh.vertices) p *= scale;
            SceneDescription scene = empty_scene();
            make_glass(scene, glass);
            add_object(scene, mesh);
            // At corners, along edges and on faces: a light lies on the triangles that have all its corners.
            std::vector<std::vector<uint32_t>> held;
            for (uint32_t v = 0; v < mesh.vertices.size(); v += 3) held.push_back({v});
            for (uint32_t t = 0; t < mesh.triangles.size(); t += 4) {
                const auto& c = mesh.triangles[t];
                held.push_back({c[0], c[1]});  // reflex
                held.push_back({c[1], c[2]});  // convex
                held.push_back({c[0], c[1], c[2]});
            }
            for (size_t k = 0; k < held.size(); ++k) {
                glm::dvec3 p = mesh.vertices[held[k][0]];
                const double s = (k % 7 + 1) / 16.0;
                for (size_t c = 1; c < held[k].size(); ++c)
                    p += s * (mesh.vertices[held[k][c]] - mesh.vertices[held[k][0]]);
                add_light(scene, p);
            }
            const uint32_t n = uint32_t(mesh.triangles.size());
            Part& part = plan.add(glass ? "glass" : "opaque", scene, LightsOnStar{n, uint32_t(held.size()), glass}, {},
                                  plan.rays(500'000, 6000));
            part.frame_numbers = [mesh, held](const PartFrame& frame, Numbers& numbers) {
                for (const auto& triangle : mesh.triangles)
                    for (const uint32_t v : triangle) add_vector(frame.point(mesh.vertices[v]), numbers);
                for (const auto& corners : held) {
                    uint64_t bits = 0;
                    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
                        size_t found = 0;
                        for (const uint32_t v : mesh.triangles[t])
                            found += size_t(std::count(corners.begin(), corners.end(), v));
                        bits |= uint64_t(found == corners.size()) << t;
                    }
                    numbers.insert(numbers.end(), {double(bits & 0x3fffffffu), double(bits >> 30)});
                }
            };
        }
}

void plan_own_light(Plan& plan, Shape shape) {
    for (const PlatonicSolid kind : platonic_solids)
        for (const glm::dvec3& rotation : turns)
            for (const bool glass : {false, true}) {
                SceneDescription scene = dark_scene();
                make_glass(scene, glass);
                scene.materials[0].specular = 1;
                const SolidObject solid = solid_object(kind, glm::dvec3(0), 1, rotation);
                add_solid(scene, shape, solid);
                const std::vector<OnSolid> on = places_on(platonic_shape(kind));
                const Rotation turned(rotation);
                for (const OnSolid& light : on) add_light(scene, turned(light.place));
                Part& part = add_lights_on<OwnLight>(plan, platonic_name(kind), scene, {solid}, {on}, glass,
                                                     plan.rays(300'000, 4000));
                part.frame_numbers = [first = part.frame_numbers, solid](const PartFrame& frame, Numbers& numbers) {
                    first(frame, numbers);
                    ball_numbers(solid.center, platonic_shape(solid.solid).inradius * solid.radius)(frame, numbers);
                };
            }
}

void plan_light_at_the_point(Plan& plan) {
    for (const glm::dvec3& rotation : turns)
        for (const Body body : {Body::planes, Body::triangles, Body::sheet})
            for (const bool falloff : {false, true}) {
                SceneDescription scene = dark_scene();
                scene.materials[0].specular = 1;
                const SolidObject solid =
                    solid_object(PlatonicSolid::cube, glm::dvec3(0), 1.7320508075688772, rotation);
                if (body == Body::sheet)
                    add_object(scene, square(1, 1, 4, false, rotation));
                else
                    add_solid(scene, body == Body::planes ? Shape::planes : Shape::triangles, solid);
                const Rotation turned(rotation);
                std::vector<glm::dvec3> points;
                for (const glm::dvec3& p : {glm::dvec3(0, 0, 1), glm::dvec3(0.5, 0.5, 1), glm::dvec3(0.3, -0.7, 1),
                                            glm::dvec3(-0.5, 0.25, 1), glm::dvec3(0.125, 0.125, 1)}) {
                    points.push_back(turned(p));
                    LightDescription& light = add_light(scene, points.back());
                    light.falloff = falloff;
                    light.radius = falloff ? 0x1p-16 : 0;
                }
                plan.add(body == Body::planes      ? "planes"
                         : body == Body::triangles ? "triangles"
                                                   : "a square",
                         scene, LightAtThePoint(), points, plan.rays(200'000, 4000));
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
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            return parity::mixed(a + (which << 32)) < parity::mixed(b + (which << 32));
        });
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
        const int width = stage.quick ? 40 : 240, height = stage.quick ? 30 : 180;
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

// ---- many visible lights: which one a ray hits, and how a picture shows them

void plan_visible_lights(Plan& plan) {
    for (const double radius : {0x1p-4, 0x1p-8, 0x1p-14}) {
        SceneDescription scene = dark_scene();
        add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube, glm::dvec3(0), 0.125));
        std::vector<glm::dvec3> points;
        for (uint32_t k = 0; k < 4096; ++k) {
            Draw draw(k, 77);
            glm::dvec3 p = draw.in_cube<double>(1.0);
            if (k % 16 == 1) p = points.back();  // two at one position
            if (k % 16 == 2) p = points.back() + glm::dvec3(radius, 0, 0);
            if (k % 16 == 3) p.z = 0;
            scene.lights.push_back(
                {.position = p, .color = glm::dvec3(0), .glow = glm::dvec3(1), .radius = radius * (k % 5 ? 1 : 0.5)});
            points.push_back(p);
        }
        plan.add("radius " + std::to_string(radius), scene, VisibleLightTree(), {}, plan.rays(100'000, 2500));
    }
    // On the edges of several solids.
    for (const double radius : {0x1p-4, 0x1p-8, 0x1p-14}) {
        SceneDescription scene = dark_scene();
        double k = 0;
        for (const PlatonicSolid shape : platonic_solids) {
            SolidObject solid = solid_object(shape, {k - 2, k * 0.25 - 0.5, 0.125 * k}, 0.5, {17 * k, 41, 73});
            solid.edge_lights = {6, glm::dvec3(0), glm::dvec3(1), radius, true, false, ""};
            add_solid(scene, Shape::planes, solid);
            ++k;
        }
        plan.add("on edges, radius " + std::to_string(radius), scene, VisibleLightTree(), {}, plan.rays(100'000, 2500));
    }
}

/// A wall of lights that are only visible, some in front of others, behind an octahedron that hides some of them.
void visible_light_pixels(Stage& stage, Tally& tally) {
    const int width = stage.quick ? 40 : 320, height = stage.quick ? 30 : 240;
    const SolidObject solid = solid_object(PlatonicSolid::octahedron, {0.5, -1.5, 0.25}, 0.5, {17, 41, 73});
    SceneDescription scene = dark_scene();
    scene.camera.position = {0, -4, 0};
    scene.camera.target = {0, 0, 0};
    scene.camera.field_of_view = 60;
    scene.background = glm::dvec3(0.03125, 0, 0);
    add_solid(scene, Shape::planes, solid);
    for (uint32_t k = 0; k < 4096; ++k) {
        LightDescription& light = add_light(scene, {(k % 64) / 16.0 - 2, k % 3 * 0.125, (k / 64) / 16.0 - 2});
        light.color = glm::dvec3(0);
        light.radius = 0.025;
        light.glow = glm::dvec3(0.125 + (k % 64) / 64.0, 0.125 + (k / 64) / 64.0, 0.25);
    }
    const Film film = stage.render(scene, width, height);
    Numbers planes;
    add_planes(solid, {scene.camera.position, 1}, planes);
    const double half = 0.57735026918962576451;  // tan 30 degrees
    // How near to a silhouette a pixel's ray may pass: the rounding of directions, centers and radii over a way of
    // 4 M, 2^-16 and less in float.
    const double doubt = 0x1p-14;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 way((2.0 * x + 1 - width) * half / width, 1, -(2.0 * y + 1 - height) * half / width);
            const glm::dvec3 direction = way / std::sqrt(dot(way, way));
            const Span<double> of{planes.data(), uint32_t(planes.size())};
            const bool hidden = chord(of, doubt, glm::dvec3(0), direction) > doubt;
            bool sure = hidden || chord(of, -doubt, glm::dvec3(0), direction) < -doubt;
            glm::dvec3 expected = hidden ? glm::dvec3(0) : scene.background;
            double nearest = 1e300;
            for (const LightDescription& light : scene.lights) {
                if (hidden) break;
                const glm::dvec3 to = light.position - scene.camera.position;
                const double along_way = dot(to, direction);
                const glm::dvec3 across = to - along_way * direction;
                const double beside = std::sqrt(dot(across, across)) - light.radius;
                sure &= std::fabs(beside) > doubt;
                if (beside > 0) continue;
                const double t = along_way - std::sqrt(light.radius * light.radius - dot(across, across));
                if (t < nearest) nearest = t, expected = *light.glow;
            }
            ++tally.place;
            if (!sure) continue;
            const PixelRecord& pixel = film.pixels[size_t(y) * size_t(width) + size_t(x)];
            bool equal = true;
            for (int c = 0; c < 3; ++c)
                equal &=
                    double(pixel.radiance[c]) == std::ldexp(expected[c], film.fixed_shift - film.radiance_exponent);
            tally.witness(!hidden && nearest < 1e300);
            tally.expect(equal);
        }
}

}  // namespace
}  // namespace shadows

void add_shadows(Cases& cases) {
    using namespace shadows;
    const Bound pixels = no_failures("pixels"), lit_pixels = no_failures("pixels", needs_witness);
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
    const Shape planes = Shape::planes, triangles = Shape::triangles;
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

    const Bound shadow_rays = no_failures("shadow rays", needs_witness);
    cases.rays<HalfSpaces>("lights-on-solids/planes",
                           "lights on corners, edges, faces of a solid: verdicts by half-spaces", shadow_rays,
                           [](Plan& plan) {
                               plan_lights_on(plan, Shape::planes);
                               plan_edge_lights(plan);
                           });
    cases.rays<HalfSpaces>("lights-on-solids/triangles",
                           "lights on corners, edges, faces of a mesh: verdicts by half-spaces", shadow_rays,
                           [](Plan& plan) { plan_lights_on(plan, Shape::triangles); });
    cases.rays<LightsOnStar>("lights-on-solids/star",
                             "lights on reflex and convex edges, corners and faces: the faces between, counted",
                             shadow_rays, plan_star);
    cases.rays<HalfSpaces>("lights-in-contact", "lights on the face that two solids share: each by its own half-spaces",
                           shadow_rays, plan_lights_in_contact);
    cases.rays<OwnLight>("own-lights/planes", "lights on a solid leave its outside black and reach all of its inside",
                         lit_pixels, [](Plan& plan) { plan_own_light(plan, Shape::planes); });
    cases.rays<OwnLight>("own-lights/triangles", "lights on a mesh leave its outside black and reach all of its inside",
                         lit_pixels, [](Plan& plan) { plan_own_light(plan, Shape::triangles); });
    cases.rays<LightAtThePoint>("light-at-the-point", "a light at the point that is shaded, in its face: 0, never NaN",
                                lit_pixels, plan_light_at_the_point);
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
                              shadow_rays, plan_solids);
    cases.images("permuted-triangles", "0 differing integers of films of meshes in another order",
                 no_failures("integers", needs_witness), permuted(false));
    cases.images("permuted-lights", "0 differing integers of films with their lights in another order",
                 no_failures("integers", needs_witness), permuted(true));
    cases.rays<VisibleLightTree>("seen-lights/tree",
                                 "(t, light) of trees over seen lights, anywhere or on edges, equals a plain loop's",
                                 no_failures("rays", needs_witness), plan_visible_lights);
    cases.images("seen-lights/pixels", "a picture of 4,096 seen lights: the glow of the nearest, every digit",
                 lit_pixels, visible_light_pixels);
}

}  // namespace cistula::verify
