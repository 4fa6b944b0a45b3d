// Convex bodies of 4 to 256 faces that are given by planes, by points or by name: lines at their edges, and pictures
// against those of their triangles.
#include "verify/cases/geometry/edges.h"
#include "verify/cases/pictures.h"
#include "verify/cases/scenes.h"
#include "verify/cases/writing.h"

namespace cistula::verify {
namespace bodies {
namespace {

/// Planes at distances of 0.8 to 1 from the origin, with normals all around it.
std::vector<BodyPlane> planes_around(uint32_t count) {
    std::vector<BodyPlane> planes;
    Draw draw(count, 71);
    for (uint32_t i = 0; i < count; ++i) {
        const dvec3 normal = on_sphere(draw);
        planes.push_back({(1 + draw.unit<double>()) * normal, 0});
        planes.back().offset = length(planes.back().normal) * (0.8 + 0.2 * draw.unit<double>());
    }
    return planes;
}
Polyhedron hull_around(uint32_t count) {
    std::vector<dvec3> points;
    Draw draw(count, 72);
    for (uint32_t i = 0; i < count; ++i) points.push_back(on_sphere(draw));
    return hull_of("hull", points);
}

/// The bodies, each about the origin, from few faces to the most.
std::vector<SolidObject> all_bodies() {
    std::vector<SolidObject> all;
    const auto add = [&](Polyhedron body) { all.push_back({.body = std::make_shared<Polyhedron>(std::move(body))}); };
    const std::vector<BodyPlane> wedge = {{{0, 0, -1}, 0.5}, {{2, 0, 1}, 1}, {{-1, 1, 1}, 0.7}, {{-1, -2, 1}, 0.9}};
    add(body_of_planes("wedge", wedge));
    add(box_body({2, 1.2, 0.7}));
    add(body_over_polygon(PolygonBody::pyramid, 5, 1, 1.5));
    add(body_over_polygon(PolygonBody::prism, 7, 1, 1));
    add(body_over_polygon(PolygonBody::antiprism, 4, 1, 1.2));
    for (const char* name : {"truncated-tetrahedron", "cuboctahedron", "snub-dodecahedron"})
        all.push_back({.body = archimedean_body(name)});
    add(hull_around(20));
    add(body_of_planes("planes", planes_around(64)));
    add(body_over_polygon(PolygonBody::antiprism, 127, 1, 0.8));
    add(body_of_planes("planes", planes_around(256)));
    return all;
}

/// The distance of the nearest face from the origin.
double nearest_face(const Polyhedron& body) {
    double nearest = INFINITY;
    for (const auto& face : body.faces) nearest = min_or_second(offset_of(body, face), nearest);
    return nearest;
}

/// Adds rays for targets on the edges of every body at every placement, upright and turned (geometry::AtEdges).
template <class Functor>
void plan_edges(Plan& plan) {
    for (const SolidObject& body : all_bodies())
        for (const Placement& placement : placements())
            for (const dvec3& turn : turns) {
                const PlacedSolid placed = placed_solid(body, Shape::planes, placement, turn);
                Part& part = plan.add(placed.label, placed.scene, Functor{{placed.number, placement.beside_unit}},
                                      edge_points(placed.solid), plan.rays(100'000, 1'500));
                part.frame_numbers = [solid = placed.solid](const PartFrame& frame, Numbers& numbers) {
                    const Polyhedron& shape = polyhedron_of(solid);
                    ball_numbers(solid.center, solid.radius * nearest_face(shape))(frame, numbers);
                    numbers.push_back(0x1p-51 * (length(solid.center) + shape.reach * solid.radius) * frame.factor);
                    add_planes(solid, frame, numbers);
                };
            }
}

/// A floor with a body on it, mirroring, opaque or of glass.
SceneDescription scene_of(const SolidObject& body, Shape shape, uint64_t number) {
    SceneDescription scene = lit_scene();
    add_object(scene, parallelogram({-3, -3, -1.1}, {6, 0, 0}, {0, 6, 0}), add_material(scene, paper({0.8, 0.6, 0.3})));
    const MaterialDescription materials[] = {glass(1.5, true, {0.3, 0.5, 0.9}), paper({0.7, 0.7, 0.8}, 0.4), glass(1.3),
                                             clear({0.8, 0.9, 1})};
    add_solid(scene, shape, body, add_material(scene, materials[number % std::size(materials)]));
    return scene;
}
void against_triangles(Stage& stage, Tally& tally) {
    const std::vector<SolidObject> all = all_bodies();
    for (uint64_t i = 0; i < all.size(); ++i) {
        SolidObject body = all[i];
        Draw draw(i, 73);
        body.rotation = draw.in_cube<double>(180);
        expect_same_picture(stage, tally, scene_of(body, Shape::planes, i), scene_of(body, Shape::triangles, i), i);
    }
}
/// The plane that bounds most of what the camera sees of a body is missing.
void without_a_plane(Stage& stage, Tally& tally) {
    std::vector<BodyPlane> planes = planes_around(64);
    const SolidObject body{.body = std::make_shared<Polyhedron>(body_of_planes("planes", planes))};
    const dvec3 eye = lit_scene().camera.position;
    std::erase_if(planes,
                  [&](const BodyPlane& p) { return dot(p.normal, eye) > 0.8 * length(p.normal) * length(eye); });
    const SolidObject open{.body = std::make_shared<Polyhedron>(body_of_planes("planes", planes))};
    expect_same_picture(stage, tally, scene_of(open, Shape::planes, 1), scene_of(body, Shape::triangles, 1), 0);
}

}  // namespace
}  // namespace bodies

void add_bodies(Cases& cases) {
    using namespace bodies;
    using namespace geometry;
    cases.rays<EdgesFromInside>("edges-from-inside",
                                "4 to 256 planes: one way out at every vertex and k/16 of every edge",
                                no_failures("rays"), plan_edges<EdgesFromInside>);
    cases.rays<EdgesFromOutside>("edges-from-outside", "as many ways in as out; one each where the line is inside",
                                 no_failures("rays", needs_witness), plan_edges<EdgesFromOutside>);
    cases.rays<OriginsOnPlanes>("origins-on-faces",
                                "inward or along it: one way out, by a neighbor where that is near; outward: nothing",
                                no_failures("rays", needs_witness), plan_edges<OriginsOnPlanes>);
    cases.images("against-triangles", "the pictures of the same bodies as meshes that keep their triangles",
                 no_failures("pixels"), against_triangles);
    cases.images("broken/without-a-plane", "a body that lacks planes looks otherwise", must_fail(1, "pixels"),
                 without_a_plane);
}

}  // namespace cistula::verify
