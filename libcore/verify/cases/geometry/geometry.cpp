// Cases on hits: edges, vertices, planes, scales, distances, and degenerate triangles.
#include <limits>

#include "verify/cases/geometry/edges.h"
#include "verify/cases/geometry/special_rays.h"
#include "verify/cases/scenes.h"

namespace cistula::verify {
namespace geometry {
namespace {

// ---- Platonic solids

/// Adds rays for every target of every placement of the five solids; what numbers there are stands at AtEdges.
template <class Functor>
void plan_solids(Plan& plan, Shape shape) {
    for (const PlatonicSolid kind : platonic_solids)
        for (const Placement& placement : placements())
            for (const glm::dvec3& turn : turns) {
                const PlacedSolid placed = placed_solid(kind, shape, placement, turn);
                const std::vector<glm::dvec3> points = edge_points(placed.solid);
                Part& part = plan.add(placed.label, placed.scene, Functor{{placed.number, placement.beside_unit}},
                                      points, points.size() * plan.rays(512, 8));
                part.frame_numbers = [solid = placed.solid](const PartFrame& frame, Numbers& numbers) {
                    ball_numbers(solid.center, solid.radius * platonic_shape(solid.solid).inradius)(frame, numbers);
                    numbers.push_back(0x1p-51 * (length(solid.center) + solid.radius) * frame.factor);
                    add_planes(solid, frame, numbers);
                };
            }
}
template <class Functor>
auto solids(Shape shape) {
    return [=](Plan& plan) { plan_solids<Functor>(plan, shape); };
}
/// Solids of triangles, of which those beside a unit one are tiny.
auto solids_of_size(bool tiny) {
    return [=](Plan& plan) {
        plan_solids<OriginsOnTriangles>(plan, Shape::triangles);
        std::erase_if(plan.parts, [=](const Part& part) { return (part.scene.objects.size() > 1) != tiny; });
    };
}

/// Adds parts with the five solids about the origin, as planes and as triangles, upright and turned.
template <class Functor>
auto upright(uint64_t in_full, uint64_t in_quick) {
    return [=](Plan& plan) {
        for (const PlatonicSolid kind : platonic_solids)
            for (const Shape shape : {Shape::planes, Shape::triangles})
                for (const glm::dvec3& turn : turns) {
                    const PlacedSolid placed = placed_solid(kind, shape, placements()[0], turn);
                    Part& part = plan.add(placed.label, placed.scene, Functor{}, edge_points(placed.solid),
                                          plan.rays(in_full, in_quick));
                    part.frame_numbers = [solid = placed.solid](const PartFrame& frame, Numbers& numbers) {
                        add_planes(solid, frame, numbers);
                    };
                }
    };
}

template <Flaw flaw>
void plan_flawed(Plan& plan) {
    for (const PlatonicSolid kind : platonic_solids)
        for (const glm::dvec3& turn : turns) {
            const PlacedSolid placed = placed_solid(kind, Shape::triangles, placements()[0], turn);
            const std::vector<glm::dvec3> points = edge_points(placed.solid);
            Part& part =
                plan.add(placed.label, placed.scene, Flawed<flaw>{}, points, points.size() * plan.rays(512, 32));
            part.frame_numbers = ball_numbers(placed.solid.center, placed.solid.radius * platonic_shape(kind).inradius);
        }
}

/// A scene with a cube about the origin.
SceneDescription cube_scene(Shape shape) {
    SceneDescription scene = empty_scene();
    add_solid(scene, shape, solid_object(PlatonicSolid::cube));
    return scene;
}
void plan_face_planes(Plan& plan) {
    using Kind = FacePlanes::Kind;
    const uint64_t rays = plan.rays(1'000'000, 20000);
    SceneDescription sheet = empty_scene();
    const TrianglesObject square = parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    add_object(sheet, square);
    plan.add("sheet", sheet, FacePlanes{Kind::sheet}, square.vertices, rays);
    for (const auto& [shape, kind] : {std::pair(Shape::planes, Kind::planes), {Shape::triangles, Kind::triangles}})
        plan.add(std::string("cube") + shape_name(shape), cube_scene(shape), FacePlanes{kind},
                 edge_points(solid_object(PlatonicSolid::cube)), rays);
}
void plan_axis_parallel(Plan& plan) {
    for (const Shape shape : {Shape::planes, Shape::triangles})
        plan.add(std::string("cube") + shape_name(shape), cube_scene(shape), AxisParallel{shape == Shape::planes},
                 triangulated_solid(solid_object(PlatonicSolid::cube)).vertices, plan.rays(1'000'000, 20000));
}
void plan_slab_planes(Plan& plan) {
    plan.add("cube of planes", cube_scene(Shape::planes), OnSlabPlanes{}, {}, plan.rays(1'000'000, 20000));
}

/// Adds a part with twenty overlapping solids and a light.
template <class Functor>
void plan_twenty(Plan& plan) {
    for (const Shape shape : {Shape::planes, Shape::triangles}) {
        SceneDescription scene = empty_scene();
        for (int row = 0; row < 4; ++row)
            for (int k = 0; k < 5; ++k)
                add_solid(scene, shape, solid_object(platonic_solids[k], {k - 2.0, row - 2.0, 0}, 0.7));
        add_light(scene, {0, 0, 3});
        plan.add(std::string("20 solids") + shape_name(shape), scene, Functor{}, {{0, 0, 0}},
                 plan.rays(1'000'000, 20000));
    }
}

// ---- meshes

/// The lens as a mesh. Vertices: the upper hub, the lower hub, the rim.
TrianglesObject lens(uint32_t spokes, const glm::dvec3& center, double height) {
    TrianglesObject mesh{.keep_triangles = true};
    mesh.vertices = {center + glm::dvec3(0, 0, height), center - glm::dvec3(0, 0, height)};
    for (uint32_t i = 0; i < spokes; ++i) {
        const double angle = 6.283185307179586 * i / spokes;
        mesh.vertices.push_back(center + glm::dvec3(std::cos(angle), std::sin(angle), 0));
    }
    for (uint32_t i = 0; i < spokes; ++i) {
        const uint32_t a = 2 + i;
        const uint32_t b = 2 + (i + 1) % spokes;
        mesh.triangles.push_back({0, a, b});
        mesh.triangles.push_back({1, b, a});
    }
    return mesh;
}

/// Replaces a compiled scene's clusters by those of a lens: eight neighbors of either fan each.
template <class Scene>
void put_triangles(Scene& compiled, const TrianglesObject& mesh) {
    using Lanes = typename decltype(compiled.clusters)::value_type;
    using Real = std::remove_reference_t<decltype(Lanes::corner[0][0][0])>;
    compiled.clusters.clear();
    for (size_t fan = 0; fan < 2; ++fan)
        for (size_t first = fan; first < mesh.triangles.size(); first += 2 * cluster_lanes) {
            Lanes cluster{};
            for (size_t t = first; t < mesh.triangles.size() && cluster.count < cluster_lanes; t += 2) {
                for (int c = 0; c < 3; ++c)
                    for (int axis = 0; axis < 3; ++axis)
                        cluster.corner[c][axis][cluster.count] =
                            Real(mesh.vertices[mesh.triangles[t][size_t(c)]][axis]);
                cluster.triangle[cluster.count++] = uint32_t(t);
            }
            compiled.clusters.push_back(cluster);
        }
}

void plan_fans(Plan& plan) {
    for (const uint32_t spokes : {4u, 5u, 8u, 31u, 256u, 2048u, 65536u}) {
        const TrianglesObject mesh = lens(spokes, spokes % 2 ? glm::dvec3(0.1, 0.3, 0.2) : glm::dvec3(0), 0.25);
        // The check of the places that mirrored rays start from takes the square of a fan's triangles at load; rays
        // that go straight do without, so the largest fan takes the place of a small one after that.
        const bool by_hand = spokes > 4096;
        SceneDescription scene = empty_scene();
        add_object(scene, by_hand ? lens(8, glm::dvec3(0), 0.25) : mesh);
        Part& part = plan.add(std::to_string(spokes) + " spokes", scene, Fans{spokes}, mesh.vertices,
                              by_hand ? plan.rays(5'000, 128) : plan.rays(200'000, 4000));
        if (by_hand) part.edit([mesh](auto& compiled) { put_triangles(compiled, mesh); });
    }
}

/// The box [-1, 1]^3, cut by grid planes at these coordinates of every axis.
TrianglesObject grid_box(const std::vector<double>& cuts) {
    const uint32_t n = uint32_t(cuts.size());
    TrianglesObject mesh{.keep_triangles = true};
    for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
            // Vertices at one position count as one, so every face may have its own.
            const uint32_t first = uint32_t(mesh.vertices.size());
            for (uint32_t i = 0; i < n; ++i)
                for (uint32_t j = 0; j < n; ++j) {
                    glm::dvec3 p;
                    p[axis] = high ? cuts.back() : cuts.front();
                    p[(axis + 1) % 3] = cuts[i];
                    p[(axis + 2) % 3] = cuts[j];
                    mesh.vertices.push_back(p);
                }
            for (uint32_t i = 0; i + 1 < n; ++i)
                for (uint32_t j = 0; j + 1 < n; ++j) {
                    const uint32_t a = first + i * n + j;
                    const uint32_t b = a + n;
                    const uint32_t c = b + 1;
                    const uint32_t d = a + 1;
                    if (high) {
                        mesh.triangles.push_back({a, b, c});
                        mesh.triangles.push_back({a, c, d});
                    } else {
                        mesh.triangles.push_back({a, c, b});
                        mesh.triangles.push_back({a, d, c});
                    }
                }
        }
    return mesh;
}

/// A prism with seven long thin faces, turned about the origin.
TrianglesObject needle(const glm::dvec3& rotation) {
    const double radius = 0x1p-20;
    TrianglesObject mesh = prism(7, radius, radius);
    mesh.keep_triangles = true;
    const Rotation turned(rotation);
    for (glm::dvec3& vertex : mesh.vertices) vertex = glm::dvec3(0) + turned(vertex);
    return mesh;
}

void plan_slivers(Plan& plan) {
    const auto add = [&](const char* label, const TrianglesObject& mesh, bool is_box) {
        SceneDescription scene = empty_scene();
        add_object(scene, mesh);
        Part& part = plan.add(label, scene, Slivers{is_box}, mesh.vertices, plan.rays(4'000'000, 20000));
        part.frame_numbers = [](const PartFrame& frame, Numbers& numbers) {
            for (int axis = 0; axis < 3; ++axis)
                for (const double side : {-1.0, 1.0}) {
                    glm::dvec3 normal(0);
                    normal[axis] = side;
                    add_vector(normal, numbers);
                    numbers.push_back((1 - side * frame.center[axis]) * frame.factor);
                }
        };
    };
    const double thin = 2 * 0x1p-20;
    add("box with strips", grid_box({-1, -0.5, -0.5 + thin, 0, thin, 0.3, 0.3 + thin, 1}), true);
    for (const glm::dvec3& turn : turns) add(turn == glm::dvec3(0) ? "needle" : "needle, turned", needle(turn), false);
}

void plan_coincident(Plan& plan) {
    const uint32_t copies = 1000;
    for (const uint32_t solids : {1u, copies}) {
        SceneDescription scene = empty_scene();
        TrianglesObject sheet{.vertices = {{-1, -0.7, 0.1}, {1, -0.9, -0.3}, {0.1, 1, 0.2}}};
        sheet.triangles.assign(copies / solids, {0, 1, 2});
        for (uint32_t k = 0; k < solids; ++k) add_object(scene, sheet);
        plan.add(solids == 1 ? "one sheet" : "a thousand sheets", scene, Coincident{solids}, sheet.vertices,
                 plan.rays(2000, 16));
    }
}

/// A mesh of one valid and ten degenerate triangles.
TrianglesObject degenerate_mesh() {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    TrianglesObject mesh;
    const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        const uint32_t first = uint32_t(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
        mesh.triangles.push_back({first, first + 1, first + 2});
    };
    const glm::dvec3 a(-1, -1, 0), b(1, -1, 0), c(0, 1, 0);
    add({-1, -1, -0.5}, {1, -1, -0.5}, {0, 1, -0.5});
    add(a, a, a);
    add(a, b, a);
    add(a, b, b);
    add(a, b, (a + b) * 0.5);
    add(a, c, a + (c - a) * 2.0);
    add(a, b, {nan, nan, nan});
    add(a, {nan, 0, 0}, c);
    add({0, 0, nan}, b, c);
    add(a, b, {0, inf, 0});
    add({-inf, -inf, 0}, {inf, -inf, 0}, {0, inf, 0});
    return mesh;
}

void plan_degenerate(Plan& plan) {
    SceneDescription scene = empty_scene();
    add_object(scene, degenerate_mesh());
    const std::vector<glm::dvec3> targets{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, -1, 0}, {1, 3, 0}, {0, -0.5, 0}};
    Part& part = plan.add("left out at load", scene, Degenerate(), targets, plan.rays(1'000'000, 20000));
    part.warnings = {"3 triangles with a repeated vertex", "5 triangles with a vertex that is not finite",
                     "2 triangles of zero area"};
    // Finite ones written into the compiled arrays, since those that close a mesh stay there. Trees contain no
    // others.
    Part& raw = plan.add("in the arrays", scene, Degenerate(), targets, plan.rays(1'000'000, 20000));
    raw.edit([](auto& compiled) {
        auto& cluster = compiled.clusters[0];
        using Real = std::remove_reference_t<decltype(cluster.corner[0][0][0])>;
        const TrianglesObject mesh = degenerate_mesh();
        const std::array<int, 5> chosen{1, 2, 3, 4, 5};
        for (const int t : chosen) {
            for (int c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis)
                    cluster.corner[c][axis][cluster.count] = Real(mesh.vertices[size_t(3 * t + c)][axis]);
            cluster.triangle[cluster.count] = cluster.count;
            ++cluster.count;
        }
    });
}

/// A random point for plans; drawn on the host, equal everywhere.
glm::dvec3 drawn(Draw& draw, double half) {
    const double x = draw.centered(half);
    const double y = draw.centered(half);
    const double z = draw.centered(half);
    return {x, y, z};
}

void plan_random(Plan& plan) {
    const uint64_t rays = plan.rays(1'700'000, 8000);  // seven scenes
    Draw draw(0, 7);
    const auto add = [&](const char* label, const SceneDescription& scene) {
        std::vector<glm::dvec3> points;
        for (const ObjectDescription& object : scene.objects) {
            const auto* solid = std::get_if<SolidObject>(&object.shape);
            const auto* ball = std::get_if<SphereObject>(&object.shape);
            const auto* disk = std::get_if<DiskObject>(&object.shape);
            const auto* mesh = std::get_if<TrianglesObject>(&object.shape);
            if (ball || disk) {  // where others touch them, and anywhere on ball or rim
                const glm::dvec3 middle = ball ? ball->center : disk->center;
                const double radius = ball ? ball->radius : std::min(disk->radius, 2.0);
                points.push_back(middle);
                for (int k = 0; k < 12; ++k) {
                    glm::dvec3 way(0);
                    way[k % 3] = k < 3 ? -1 : 1;
                    if (k >= 6) way = drawn(draw, 1);
                    if (disk) way -= dot(way, disk->normal) / dot(disk->normal, disk->normal) * disk->normal;
                    if (length(way) > 0.1) points.push_back(middle + radius / length(way) * way);
                }
                continue;
            }
            const std::vector<glm::dvec3> more = solid ? edge_points(*solid) : mesh->vertices;
            points.insert(points.end(), more.begin(), more.end());
        }
        plan.add(label, scene, RandomRays{}, points, rays);
    };
    SceneDescription soup = empty_scene();
    add_object(soup, triangle_soup(1500, 0.4, 1));
    add("triangle soup", soup);
    SceneDescription slivers = empty_scene();
    add_object(slivers, moved(triangle_soup(400, 0.8, 2), glm::dvec3(0), {1, 1e-6, 1}));
    add_object(slivers, moved(triangle_soup(400, 1, 3), glm::dvec3(0.1), {1e-7, 1, 1e-4}));
    add("slivers", slivers);
    SceneDescription closed = empty_scene();
    add_object(closed, bumpy_sphere(1000));
    add_object(closed, moved(torus(1, 0.4, 24, 16), glm::dvec3(0), glm::dvec3(0.6)));
    add_object(closed, moved(star(), {0.7, 0, 0}, glm::dvec3(0.8)));
    add_object(closed, lens(31, {0, 0, 0.5}, 0.25));
    add("closed meshes", closed);
    SceneDescription nested = empty_scene();
    for (int k = 0; k < 5; ++k)
        add_object(nested, solid_object(platonic_solids[k], glm::dvec3(0), 1.0 / (1 + k * k), drawn(draw, 180)));
    for (int k = 0; k < 3; ++k)
        add_solid(nested, Shape::triangles, solid_object(PlatonicSolid::cube, glm::dvec3(0.02 * k), 0.8 - 0.2 * k));
    add("nested solids", nested);
    SceneDescription many = empty_scene();
    for (int k = 0; k < 60; ++k) {
        const glm::dvec3 center = drawn(draw, 2);
        const glm::dvec3 turn = k % 3 ? drawn(draw, 180) : glm::dvec3(0);
        add_object(many, solid_object(platonic_solids[k % 5], center, 0.05 + 0.5 * draw.unit<double>(), turn));
    }
    add("many solids", many);
    SceneDescription touching = empty_scene();
    const double side = 2 / std::sqrt(3.0);
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x)
                add_solid(touching, (x + y + z) % 2 ? Shape::planes : Shape::triangles,
                          solid_object(PlatonicSolid::cube, {side * x, side * y, side * z}));
    add_object(touching, parallelogram({-2, -2, -1}, {6, 0, 0}, {0, 6, 0}));
    add("touching cubes", touching);
    SceneDescription round = empty_scene();  // touching, nested, equal and cut; planes without end through them
    const glm::dvec3 centers[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, -1, 0.3}};
    const double radii[] = {0.5, 0.5, 0.5, 0.4, 0.3, 0.5, 0.2};
    for (int k = 0; k < 7; ++k) add_object(round, SphereObject{.center = centers[k], .radius = radii[k]});
    for (int k = 0; k < 6; ++k)
        add_object(round, SphereObject{.center = drawn(draw, 1.5), .radius = 0.1 + 0.3 * draw.unit<double>()});
    add_object(round, solid_object(PlatonicSolid::cube, {1, 1, 0}, 0.5));
    add_object(round, DiskObject{.center = {0, 0, 0.5}, .normal = {0, 0, 1}, .radius = 0.7});
    add_object(round, DiskObject{.center = {0, 0, 0.5}, .normal = {0, 0, -1}, .radius = 0.3});
    add_object(round, DiskObject{.center = {1, 0.5, 0}, .normal = {1, 2, 3}, .radius = 1});
    add_object(round, DiskObject::plane({0, 0, 1}, -0.5));
    add_object(round, DiskObject::plane({1, 0, 2}, 0.1));
    add("balls and disks", round);
}

}  // namespace
}  // namespace geometry

void add_geometry(Cases& cases) {
    using namespace geometry;
    const Bound none = no_failures("rays");
    const Bound witnessed = no_failures("rays", needs_witness);
    const Shape planes = Shape::planes;
    const Shape triangles = Shape::triangles;
    const char* one_way_out = "one way out at every vertex and k/16 of every edge";
    cases.rays<EdgesFromInside>("edges-from-inside/planes", one_way_out, none, solids<EdgesFromInside>(planes));
    cases.rays<EdgesFromInside>("edges-from-inside/triangles", one_way_out, none, solids<EdgesFromInside>(triangles));
    const char* in_and_out = "as many ways in as out; one each where the line is inside";
    cases.rays<EdgesFromOutside>("edges-from-outside/planes", in_and_out, witnessed, solids<EdgesFromOutside>(planes));
    cases.rays<EdgesFromOutside>("edges-from-outside/triangles", in_and_out, witnessed,
                                 solids<EdgesFromOutside>(triangles));
    cases.rays<Fans>("fans", "4 to 65,536 triangles about a vertex: one way in, one way out", witnessed, plan_fans);
    cases.rays<Slivers>("slivers",
                        "closed meshes with triangles of aspect 2^20: as many ways in as out, one each in a box",
                        witnessed, plan_slivers);
    // Each must fail on rays that the sound tests pass, or those prove nothing.
    const Bound fails = must_fail(1, "rays");
    cases.rays<Flawed<Flaw::contracted_products>>("broken/contracted-products",
                                                  "edge functions with contracted products leak at vertices and edges",
                                                  fails, plan_flawed<Flaw::contracted_products>);
    cases.rays<Flawed<Flaw::inclusive_edges>>("broken/inclusive-edges", "inclusive edges are hit twice", fails,
                                              plan_flawed<Flaw::inclusive_edges>);
    cases.rays<Flawed<Flaw::unpadded_boxes>>("broken/unpadded-boxes",
                                             "boxes without padding hide hits that the triangles accept", fails,
                                             plan_flawed<Flaw::unpadded_boxes>);
    cases.rays<SignedZeros>("signed-zeros", "-0 in origin or direction gives the bits of +0", none,
                            upright<SignedZeros>(1'000'000, 4000));
    cases.rays<Subnormals>("subnormal-directions",
                           "components down to the least subnormal: as many ways in as out, one each inside", witnessed,
                           upright<Subnormals>(1'000'000, 4000));
    cases.rays<AxisParallel>("axis-parallel",
                             "lines along axes meet a cube of planes iff strictly within it, to the last bit",
                             witnessed, plan_axis_parallel);
    cases.rays<OnSlabPlanes>("origins-on-slab-planes",
                             "from a face inward: in at t = 0 and out; outward or along it: nothing", none,
                             plan_slab_planes);
    cases.rays<OriginsOnPlanes>("origins-on-faces/planes",
                                "inward or along it: one way out, by a neighbor where that is near; outward: nothing",
                                witnessed, solids<OriginsOnPlanes>(planes));
    cases.rays<OriginsOnTriangles>("origins-on-faces/triangles",
                                   "inward: one way out, not by the face left; outward: nothing", witnessed,
                                   solids_of_size(false));
    cases.rays<OriginsOnTriangles>("origins-on-faces/tiny-triangles",
                                   "the same on a 2^-20 solid beside a unit one: a way out more than ways in",
                                   no_failures("rays", needs_witness | float_warns), solids_of_size(true));
    cases.rays<NotFiniteRays>("not-finite-rays", "NaN or infinity in origin or direction: a miss and no light", none,
                              plan_twenty<NotFiniteRays>);
    cases.rays<ExtremeRays>("extreme-rays",
                            "subnormal numbers, zeros, no direction at all: crossings in order, to an end", none,
                            plan_twenty<ExtremeRays>);
    cases.rays<RandomRays>("random-rays",
                           "t, u, v and key of three crossings: those of a plain loop over all primitives", none,
                           plan_random);
    cases.rays<FarCameras>("far-cameras",
                           "from 1e3 to 1e9 scene sizes away: one way in, one out, none beside the solid", witnessed,
                           upright<FarCameras>(1'000'000, 4000));
    cases.rays<FacePlanes>("rays-in-face-planes",
                           "a sheet is passed by; a cube of planes too; one of triangles is left as often as entered",
                           none, plan_face_planes);
    cases.rays<Coincident>(
        "coincident-triangles",
        "a thousand sheets in one place: the last first, then all others in order; a thousand copies in one: one",
        witnessed, plan_coincident);
    cases.rays<Degenerate>("degenerate-triangles",
                           "no area, a repeated vertex, NaN, infinity: reported at load, never hit", witnessed,
                           plan_degenerate);
}

}  // namespace cistula::verify
