// Lights on faces, edges and corners of bodies, and many lights that are seen.
#include <algorithm>

#include "verify/cases/shadows/local_light.h"
#include "verify/cases/shadows/scenes.h"

namespace cistula::verify::shadows {
namespace {

// ---- half-spaces decide, no comparison of nearly equal distances

/// A light on a corner, an edge or a face of a solid, with the faces on which it lies as bits, by construction.
struct OnSolid {
    glm::dvec3 place;  // for the solid at the origin with radius 1, not rotated
    uint32_t faces;
};

/// The faces of a solid that a test holds of, as bits.
template <class Holds>
uint32_t face_bits(const Polyhedron& shape, const Holds& holds) {
    uint32_t bits = 0;
    for (uint32_t f = 0; f < shape.faces.size(); ++f) bits |= uint32_t(holds(shape.faces[f])) << f;
    return bits;
}

std::vector<OnSolid> places_on(const Polyhedron& shape) {
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
    const Polyhedron& shape = platonic_shape(PlatonicSolid::cube);
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
    const int width = stage.quick ? 40 : 320;
    const int height = stage.quick ? 30 : 240;
    const SolidObject solid = solid_object(PlatonicSolid::octahedron, {0.5, -1.5, 0.25}, 0.5, {17, 41, 73});
    SceneDescription scene = dark_scene();
    scene.camera.position = {0, -4, 0};
    scene.camera.target = {0, 0, 0};
    scene.camera.field_of_view = 60;
    scene.background = glm::dvec3(0.03125, 0, 0);
    add_solid(scene, Shape::planes, solid);
    for (uint32_t k = 0; k < 4096; ++k) {
        const uint32_t row = k / 64;
        LightDescription& light = add_light(scene, {(k % 64) / 16.0 - 2, k % 3 * 0.125, row / 16.0 - 2});
        light.color = glm::dvec3(0);
        light.radius = 0.025;
        light.glow = glm::dvec3(0.125 + (k % 64) / 64.0, 0.125 + row / 64.0, 0.25);
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

void add_lights(Cases& cases) {
    const Bound lit_pixels = no_failures("pixels", needs_witness);
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
    cases.rays<VisibleLightTree>("seen-lights/tree",
                                 "(t, light) of trees over seen lights, anywhere or on edges, equals a plain loop's",
                                 no_failures("rays", needs_witness), plan_visible_lights);
    cases.images("seen-lights/pixels", "a picture of 4,096 seen lights: the glow of the nearest, every digit",
                 lit_pixels, visible_light_pixels);
}

}  // namespace cistula::verify::shadows
