// Cases on mirrors: paths and sums compared with closed forms, and no escapes from closed solids.
#include <algorithm>

#include "verify/cases/mirrors/paths.h"
#include "verify/cases/pictures.h"
#include "verify/cases/scenes.h"

namespace cistula::verify {
namespace mirrors {
namespace {

// ---- mirrored cubes and parallel mirrors against FoldedPath

SceneDescription cube_scene(Shape shape, double radius) {
    SceneDescription scene = empty_scene();
    add_solid(scene, shape, solid_object(PlatonicSolid::cube, glm::dvec3(0), radius));
    return scene;
}
void plan_cubes(Plan& plan, Walls walls) {
    const Shape shape = walls == Walls::cube_of_planes ? Shape::planes : Shape::triangles;
    const auto add = [&](const char* label, double radius) {
        const auto corners = triangulated_solid(solid_object(PlatonicSolid::cube, glm::dvec3(0), radius)).vertices;
        glm::dvec3 high(0);
        for (const glm::dvec3& p : corners)
            for (int axis = 0; axis < 3; ++axis) high[axis] = std::max(high[axis], p[axis]);
        plan.add(label, cube_scene(shape, radius), FoldedPath{walls, 1000}, {-high, high}, plan.rays(4096, 64));
    };
    add("radius 1", 1);
    add("radius 1e-5", 1e-5);
    add("radius 2^40", 0x1p40);
}

/// Distance of the mirrors, which are 1 wide.
constexpr double gap = 0x1p-8;

void plan_parallel_planes(Plan& plan) {
    SceneDescription scene = empty_scene();
    const double radius = std::sqrt(0.75);
    const double y = 0.5 + gap / 2;
    for (const double side : {-y, y}) add_object(scene, solid_object(PlatonicSolid::cube, {0, side, 0}, radius));
    plan.add("two cubes", scene, FoldedPath{Walls::two_cubes, 500}, {}, plan.rays(16384, 256));
}
/// A square perpendicular to the y axis, of two triangles.
TrianglesObject square_across_y(double y, double half) {
    return parallelogram({-half, y, -half}, {2 * half, 0, 0}, {0, 0, 2 * half});
}
void plan_parallel_sheets(Plan& plan) {
    SceneDescription scene = empty_scene();
    for (const double y : {-gap / 2, gap / 2}) add_object(scene, square_across_y(y, 0.5));
    plan.add("two sheets", scene, FoldedPath{Walls::two_sheets, 500}, {{-0.5, -gap / 2, -0.5}, {0.5, gap / 2, 0.5}},
             plan.rays(16384, 256));
}

// ---- closed solids

/// A mesh, a point inside, and the radius around it that is inside, too.
struct InsideOf {
    const char* name;
    TrianglesObject mesh;
    glm::dvec3 middle;
    double around;
};
std::vector<InsideOf> closed_meshes() {
    return {{"torus", torus(1, 0.4, 16, 12), {1, 0.05, 0.1}, 0.1},
            {"coarse torus", torus(1, 0.5, 5, 3), {0.8, 0.05, 0.02}, 0.02},
            {"star", star(), {0.01, 0.02, -0.03}, 0.1},
            {"sharp star", star(0.2, 1), {0.01, 0.02, -0.03}, 0.05},
            {"bumpy sphere", bumpy_sphere(500), {0.01, 0.02, -0.03}, 0.3}};
}

/// Corners, edge points and centers of triangles.
std::vector<glm::dvec3> mesh_points(const TrianglesObject& mesh) {
    std::vector<glm::dvec3> points = mesh.vertices;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        points.insert(points.end(), {(b + c) * 0.5, a + (b - a) * 0.3, (a + b + c) / 3.0});
    }
    return points;
}

template <class Functor>
auto inside_planes(const Functor& functor, uint64_t in_full, uint64_t in_quick) {
    return [=](Plan& plan) {
        for (const double scale : {1.0, 1e-5})
            for (const PlatonicSolid kind : platonic_solids)
                for (const glm::dvec3& turn : turns) {
                    const SolidObject solid = solid_object(kind, glm::dvec3(0), scale, turn);
                    SceneDescription scene = empty_scene();
                    add_object(scene, solid);
                    std::vector<glm::dvec3> points = mesh_points(triangulated_solid(solid));
                    const auto edges = edge_points(solid);
                    points.insert(points.end(), edges.begin(), edges.end());
                    plan.add(platonic_name(kind) + std::string(scale == 1 ? "" : " at 1e-5"), scene, functor, points,
                             plan.rays(in_full, in_quick))
                        .frame_numbers = ball_numbers(glm::dvec3(0), 0.25 * scale * platonic_shape(kind).inradius);
                }
    };
}
template <class Functor>
auto inside_meshes(const Functor& functor, uint64_t in_full, uint64_t in_quick) {
    return [=](Plan& plan) {
        for (const double scale : {1.0, 1e-5})
            for (InsideOf body : closed_meshes()) {
                for (glm::dvec3& v : body.mesh.vertices) v *= scale;
                SceneDescription scene = empty_scene();
                add_object(scene, body.mesh);
                plan.add(body.name + std::string(scale == 1 ? "" : " at 1e-5"), scene, functor, mesh_points(body.mesh),
                         plan.rays(in_full, in_quick))
                    .frame_numbers = ball_numbers(body.middle * scale, body.around * scale);
            }
    };
}
auto lengths(bool renormalize) {
    return [=](Plan& plan) {
        SceneDescription solid = empty_scene();
        SceneDescription mesh = empty_scene();
        add_object(solid, solid_object(PlatonicSolid::dodecahedron, glm::dvec3(0), 1, turns[1]));
        const InsideOf body = closed_meshes()[0];
        add_object(mesh, body.mesh);
        plan.add("dodecahedron", solid, Lengths{renormalize}, {}, plan.rays(4096, 64)).frame_numbers =
            ball_numbers(glm::dvec3(0), 0.1);
        plan.add("torus", mesh, Lengths{renormalize}, {}, plan.rays(1024, 16)).frame_numbers =
            ball_numbers(body.middle, 0.1);
    };
}

// ---- images: materials without local light, and sums in integers

/// A material with local light 1 in the share that is neither reflected nor transmitted.
MaterialDescription share_material(const char* name, double reflection, double transmission) {
    return {.name = name,
            .color = glm::dvec3(1),
            .ambient = 1,
            .diffuse = 0,
            .reflection = reflection,
            .transmission = transmission};
}

/// A scene with ambient light 1, no objects, one material.
SceneDescription share_scene(double reflection, double transmission, double background) {
    SceneDescription scene = empty_scene();
    scene.materials = {share_material("mirror", reflection, transmission)};
    scene.ambient = glm::dvec3(1);
    scene.background = glm::dvec3(background);
    return scene;
}

Film film_from(const Stage& stage, SceneDescription scene, const glm::dvec3& from, const glm::dvec3& to,
               double field_of_view, int size, int depth) {
    scene.camera.position = from;
    scene.camera.target = to;
    scene.camera.field_of_view = field_of_view;
    scene.depth = depth;
    return stage.render(scene, size, size);
}

/// Radiance 1 in units of the sums, in scenes whose brightest radiance is 1: B is 1 + 2^-10 there, and sums are scaled
/// by the next power of two.
constexpr int64_t whole = int64_t(1) << 61;
constexpr int64_t bound_of_whole = whole + (whole >> 10);

/// Whether the sums of a film are in the units of `whole`.
bool counts_in_wholes(const Film& film) {
    return film.flags == 0 && film.fixed_shift == 62 && film.radiance_exponent == 1 && film.samples == 1;
}

int64_t ledger(const PixelRecord& pixel, int channel) {
    return pixel.cut[channel] + pixel.pruned[channel];
}

/// Calls check(pixel, channel) for all, with places `first` and following; returns whether the film's units are those
/// of `whole`.
template <class Check>
void for_each_sum(Tally& tally, uint64_t first, const Film& film, const Check& check) {
    tally.place = first;
    tally.expect(counts_in_wholes(film));
    for (const PixelRecord& pixel : film.pixels) {
        tally.place = ++first;
        for (int channel = 0; channel < 3; ++channel) check(pixel, channel);
    }
}

/// A solid for cameras inside: an inner point, and the radius around it that is inside, too.
struct Body {
    SceneDescription scene;
    glm::dvec3 middle;
    double around;
};

/// Five solids as planes and as triangles, then a torus, a star and a bumpy sphere, with material 0 of `scene`.
std::vector<Body> bodies(const SceneDescription& scene) {
    std::vector<Body> all;
    for (const Shape shape : {Shape::planes, Shape::triangles})
        for (const PlatonicSolid kind : platonic_solids) {
            Body body{scene, glm::dvec3(0), 0.25 * platonic_shape(kind).inradius};
            add_solid(body.scene, shape, solid_object(kind, glm::dvec3(0), 1, glm::dvec3(31, 47, 11)));
            all.push_back(body);
        }
    const auto meshes = closed_meshes();
    for (const size_t number : {0, 2, 4}) {
        Body body{scene, meshes[number].middle, meshes[number].around};
        add_object(body.scene, meshes[number].mesh);
        all.push_back(body);
    }
    return all;
}

/// Lossless mirrors around the camera in a white world: every path ends at the depth limit, and none sees the white.
void depth_ends(Stage& stage, Tally& tally) {
    const int size = stage.quick ? 3 : 16;
    uint64_t place = 0;
    for (const Body& body : bodies(share_scene(1, 0, 1))) {
        const glm::dvec3 from = body.middle + body.around * glm::dvec3(0.3, -0.2, 0.1);
        const Film film = film_from(stage, body.scene, from, from + glm::dvec3(0.3, 1, -0.2), 100, size, 1024);
        for_each_sum(tally, place, film, [&](const PixelRecord& pixel, int c) {
            tally.expect(pixel.radiance[c] == 0 && pixel.rays == 1024 && pixel.cut[c] == bound_of_whole &&
                         pixel.pruned[c] == 0);
        });
        place += 1000;
    }
}

/// Two mirrors that reflect half and emit the other half: 1/2 + 1/4 + ... after `depth` surfaces.
void parallel_sum(Stage& stage, Tally& tally) {
    const int size = stage.quick ? 6 : 32;
    for (const Shape shape : {Shape::planes, Shape::triangles}) {
        SceneDescription scene = share_scene(0.5, 0, 0);
        for (const double side : {-1.0, 1.0})
            if (shape == Shape::planes)
                add_object(scene, solid_object(PlatonicSolid::cube, {0, side * 1.015625, 0}, std::sqrt(3.0)));
            else
                add_object(scene, square_across_y(side * 0.015625, 1));
        for (const int depth : {1, 2, 3, 10, 40}) {
            const Film film = film_from(stage, scene, {0, 0.001, 0}, {0.01, 1, 0.02}, 40, size, depth);
            for_each_sum(tally, uint64_t(depth) * 10000 + (shape == Shape::planes ? 0 : 5000), film,
                         [&](const PixelRecord& pixel, int c) {
                             tally.expect(pixel.radiance[c] == whole - (whole >> depth) &&
                                          pixel.cut[c] == bound_of_whole >> depth && pixel.pruned[c] == 0 &&
                                          pixel.rays == uint32_t(depth));
                         });
        }
    }
}

// ---- a slab whose two faces reflect R and transmit 1 - R, in front of a wall of radiance 1:
// T = (1-R)^2 (1 + R^2 + R^4 + ...)

/// A slab perpendicular to y between the camera and the wall: a cube of planes or a thin box of triangles.
SceneDescription slab_scene(Shape shape, double reflectance) {
    SceneDescription scene = share_scene(reflectance, 1 - reflectance, 0);
    if (shape == Shape::planes)
        add_object(scene, solid_object(PlatonicSolid::cube, glm::dvec3(0), std::sqrt(3.0)));
    else
        add_object(scene, box({-1, -0x1p-6, -1}, {1, 0x1p-6, 1}, true));
    scene.materials.push_back(share_material("wall", 0, 0));
    add_object(scene, square_across_y(1.75, 1.5), 1);
    return scene;
}

/// A film with a view so narrow that 1,024 crossings of the slab stay on its large faces.
Film slab_film(const Stage& stage, Shape shape, double reflectance, int depth) {
    return film_from(stage, slab_scene(shape, reflectance), {0.001, -3, 0.002}, {0.001, 0, 0.002},
                     shape == Shape::planes ? 0.03 : 1.5, stage.quick ? 3 : 16, depth);
}

/// Number of terms within a depth. The surfaces of a path are the near face, the far one, 2 j more in the slab, the
/// wall.
int terms_within(int depth) {
    return depth < 3 ? 0 : (depth - 1) / 2;
}

/// Deviation in ulps of a sum of `terms` terms from its closed form in the scene's R, or of the sum with its ledger
/// from the limit. Truncation takes less than a unit of the sums from each term, besides what was pruned.
double slab_deviation(const Stage& stage, const PixelRecord& pixel, int channel, double reflectance, int terms) {
    const auto in_real = [&](double x) { return stage.in_double() ? x : double(float(x)); };
    const __float128 r = in_real(reflectance);
    const __float128 t = in_real(1 - reflectance);
    __float128 power = 1;
    for (int j = 0; j < terms; ++j) power *= r * r;
    const __float128 limit = t * t / (1 - r * r) * whole;
    const __float128 closed = limit * (1 - power);
    const __float128 above = pixel.radiance[channel] - closed;
    const __float128 below = -above - terms - pixel.pruned[channel];
    const __float128 missing = limit - pixel.radiance[channel] - ledger(pixel, channel) - terms;
    const __float128 larger = above > below ? above : below;
    const __float128 off = larger > missing ? larger : missing;
    return off > 0 ? double(off / closed) / (2 * stage.unit()) : 0;
}

/// Calls check(pixel, channel) for the slabs of planes and of triangles, traced 1,024 deep.
template <class Check>
void for_each_slab(const Stage& stage, Tally& tally, double reflectance, const Check& check) {
    for (const Shape shape : {Shape::planes, Shape::triangles})
        for_each_sum(tally, shape == Shape::planes ? 0 : 5000, slab_film(stage, shape, reflectance, 1024), check);
}
auto semi_mirror(double r) {
    return [=](Stage& stage, Tally& tally) {
        for_each_slab(stage, tally, r, [&](const PixelRecord& pixel, int c) {
            tally.measure(slab_deviation(stage, pixel, c, r, terms_within(1024)));
        });
    };
}
void semi_mirror_of_half(Stage& stage, Tally& tally) {
    for_each_slab(stage, tally, 0.5, [&](const PixelRecord& pixel, int c) {
        tally.expect(pixel.radiance[c] == whole / 3 && pixel.cut[c] == 0);
    });
}

/// T R^2k = 4^-k / 3 remains, to the units that the sums can hold; the ledger has both branches of the last face,
/// half of what gets there each: 2^-depth B twice, or after the near face 2^-1 B.
bool halves(const PixelRecord& pixel, int c, int depth) {
    const int k = terms_within(depth);
    const bool remains = whole / 3 - pixel.radiance[c] == (k > 30 ? 0 : (whole >> 2 * k) / 3);
    const bool exactly = depth > 50 || (pixel.pruned[c] == 0 && pixel.cut[c] == 2 * (bound_of_whole >> depth));
    return remains && exactly;
}
void depth_cut(Stage& stage, Tally& tally) {
    uint64_t place = 0;
    for (const Shape shape : {Shape::planes, Shape::triangles})
        for (const double r : {0.5, 0.9, 0.99}) {
            const Film reference = slab_film(stage, shape, r, 1024);
            for (const int depth : {1, 2, 3, 4, 7, 16, 33, 64, 255}) {
                size_t sums = 0;
                for_each_sum(tally, place, slab_film(stage, shape, r, depth), [&](const PixelRecord& pixel, int c) {
                    const int64_t most = reference.pixels[sums++ / 3].radiance[c];
                    tally.expect(pixel.radiance[c] <= most && most - pixel.radiance[c] <= ledger(pixel, c));
                    if (r == 0.5) tally.expect(halves(pixel, c, depth));
                });
                place += 1000;
            }
        }
}

// ---- furnace: lossless objects are invisible in a world of constant radiance

/// Tests the bodies one by one, then five overlapping solids, seen from outside and from inside.
template <class Check>
void for_each_furnace(const Stage& stage, const SceneDescription& lossless, int depth_of_convex, int depth_of_others,
                      const Check& check) {
    const int size = stage.quick ? 6 : 48;
    std::vector<Body> all = bodies(lossless);
    Body together{lossless, glm::dvec3(0), 0.1};
    for (const PlatonicSolid kind : platonic_solids) {
        const double n = double(together.scene.objects.size());
        add_solid(together.scene, Shape::planes,
                  solid_object(kind, {0.3 * n - 0.6, 0.1 * n, 0}, 0.8, glm::dvec3(31 * n, 0, 11)));
    }
    all.push_back(together);
    for (const Body& body : all) {
        const bool convex =
            body.scene.objects.size() == 1 && std::holds_alternative<SolidObject>(body.scene.objects[0].shape);
        const int depth = convex ? depth_of_convex : depth_of_others;
        check(film_from(stage, body.scene, {0.4, -3.5, 0.8}, {0, 0, 0}, 40, size, depth));
        const glm::dvec3 from = body.middle + body.around * glm::dvec3(0.3, -0.2, 0.1);
        check(film_from(stage, body.scene, from, from + glm::dvec3(0.3, 1, -0.2), 90, size, depth));
    }
}

/// Shares of 1/2, which make every weight a power of two.
void furnace_of_halves(Stage& stage, Tally& tally) {
    uint64_t place = 0;
    for_each_furnace(stage, share_scene(0.5, 0.5, 1), 40, 9, [&](const Film& film) {
        for_each_sum(tally, place, film, [&](const PixelRecord& pixel, int c) {
            const int64_t missing = whole - pixel.radiance[c];
            tally.expect(missing >= 0 && pixel.pruned[c] == 0 &&
                         __int128(missing) * bound_of_whole == __int128(pixel.cut[c]) * whole);
            tally.witness(missing > 0 && pixel.radiance[c] > 0);
        });
        place += 10000;
    });
}
/// Glass of index 1.5: total reflection, given shares, and Fresnel's.
void furnace_of_glass(Stage& stage, Tally& tally) {
    uint64_t place = 0;
    for (const bool fresnel : {false, true}) {
        SceneDescription scene = share_scene(fresnel ? 0.0 : 0.1, fresnel ? 1.0 : 0.9, 1);
        scene.materials[0].index = 1.5;
        scene.materials[0].fresnel = fresnel;
        for_each_furnace(stage, scene, 10, 10, [&](const Film& film) {
            for_each_sum(tally, place, film, [&](const PixelRecord& pixel, int c) {
                const __float128 sum = pixel.radiance[c] + __float128(ledger(pixel, c)) * whole / bound_of_whole;
                const __float128 off = sum > whole ? sum - whole : whole - sum;
                const __float128 units = 3 * (__float128(pixel.rays) + 1);
                tally.measure(off > units ? double((off - units) / whole) / (2 * stage.unit()) : 0);
                tally.witness(pixel.cut[c] > 0 && pixel.radiance[c] > 0);
            });
            place += 10000;
        });
    }
}

}  // namespace
}  // namespace mirrors

void add_mirrors(Cases& cases) {
    using namespace mirrors;
    const char* folded = "position after n bounces: triangle wave of o + T d; direction: +-d, bit for bit";
    const char* a_bounce = "ulps of M a bounce";
    // The path is unfolded, so that errors of bounces add up. Half an edge is M. t has three roundings, so that the hit
    // is 3 u of at most 2 M off the wall; the closed form turns at the wall itself, which makes it twice as much; the
    // point is rounded by u M: (2 * 6 + 1) u M a bounce, or 6.5 ulps of M.
    cases.rays<FoldedPath>("cube-fold/planes", folded, at_most(6.5, a_bounce),
                           [](Plan& plan) { plan_cubes(plan, Walls::cube_of_planes); });
    // Components of d lie in [0.33, 0.82]; all in u M. Differences to corners (up to 2 M) are off by 2, shears by 4,
    // what is sheared by 14. Weights of corners are off by 6 u, so that a point is off by 26, across the ray by 52 + 14
    // at most, and on a face at a slant of 1/2 and more by three times that: 198. t is off by 198 / 0.577 + 24, and the
    // point at t by 0.82 of that: 301. The way toward the apex is 8 u M / height, 163 of which 146 along an axis, to a
    // height of 0.0732 M over a centroid that is at most 1.49 M away. Together 646 u M, or 323 ulps.
    cases.rays<FoldedPath>("cube-fold/triangles", folded, at_most(323, a_bounce),
                           [](Plan& plan) { plan_cubes(plan, Walls::cube_of_triangles); });
    // The bound of the cube, except that the distance of the walls is 2^-8 M: 2 * 3 u * 2^-8 M off the walls. Along
    // them at most u / 2 M, for coordinates up to M / 2: 0.53 u M, or 0.27 ulps.
    cases.rays<FoldedPath>("parallel/planes",
                           "500 bounces between faces of two cubes: triangle wave across, straight along them",
                           at_most(0.27, a_bounce), plan_parallel_planes);
    // The bound of the cube of triangles, all in u M, for slopes of 0.3 at most and distances across of 2^-7: sheared
    // corners are off by 5, points by 26 + 5, the start by 146 along the sheet and 8 across it, which counts at the
    // slope too: 31 + 146 + 8 * 1.3, or 94 ulps.
    cases.rays<FoldedPath>("parallel/sheets",
                           "500 bounces between two sheets: triangle wave across, straight along them",
                           at_most(94, a_bounce), plan_parallel_sheets);
    cases.images("parallel/image",
                 "between half mirrors a pixel is 1 - 2^-depth, its ledger 2^-depth B, its rays depth",
                 no_failures("sums"), parallel_sum);
    cases.images("semi-mirror-slab/0.5", "T = 1/3, depth 1,024, to the last of 62 bits", no_failures("sums"),
                 semi_mirror_of_half);
    // Term j is a product of 2 j + 2 shares, the first of which is exact: (2 j + 1) u. Over all terms that is
    // 1 + 2 R^2 / (1 - R^2) u: 9.6 u for R = .9 and 99.6 u for R = .99, half as many ulps.
    const char* sum_of_terms = "T = (1-R)/(1+R), depth 1,024, less truncation; the rest is in the ledger";
    cases.images("semi-mirror-slab/0.9", sum_of_terms, at_most(4.8, "ulps"), semi_mirror(0.9));
    cases.images("semi-mirror-slab/0.99", sum_of_terms, at_most(49.8, "ulps"), semi_mirror(0.99));
    cases.images("depth-cut", "cut after k terms: 0 <= T - image <= ledger, in integers; R = .5: T - image = T R^2k",
                 no_failures("sums"), depth_cut);
    cases.images("furnace/halves",
                 "lossless solids in a white world, kr = kt = 1/2: (1 - image) B = ledger, in integers",
                 no_failures("sums", needs_witness), furnace_of_halves);
    // Rounding at each surface: kr and kt, 1 u for both; 1 - F; and the products with the branch's weight: at most 3 u
    // of what arrives. 10 surfaces, and the ledger's product with B: 31 u, or 15.5 ulps. A contribution and a branch
    // that is not followed are off by less than a unit of the sums each, three at most for a ray.
    cases.images("furnace/glass", "lossless glass in a white world: image + ledger / (1 + 2^-10) = 1, less truncation",
                 at_most(15.5, "ulps of 1", needs_witness), furnace_of_glass);
    cases.rays<BouncesInside>(
        "escapes/planes", "a bounce inside one of five solids ends on another face, at most 64 u M outside",
        no_failures("bounces"),
        inside_planes(BouncesInside{Start::as_rendered}, 3000, 300));  // 20 parts of 100 bounces: 6 million
    cases.rays<BouncesInside>(
        "escapes/meshes", "a bounce inside a torus, star or bumpy sphere ends on another triangle, inside by parity",
        no_failures("bounces"),
        inside_meshes(BouncesInside{Start::as_rendered}, 4060, 200));  // 10 parts of 99 bounces: 4 million
    cases.rays<FirstLines>("escapes/camera-in-mesh",
                           "a line that starts inside a mesh, on no face, first meets a face from within",
                           no_failures("rays"), inside_meshes(FirstLines{}, 100000, 20000));
    cases.rays<BouncesByEpsilon>("broken/escapes-by-epsilon",
                                 "an epsilon in the place of state lets rays out at edges, which must be caught",
                                 must_fail(1000, "bounces"), inside_planes(BouncesByEpsilon{}, 3000, 100));
    cases.rays<BouncesInside>("broken/escapes-without-apex",
                              "meshes whose lines start on the face, which alone is left out, must be caught",
                              must_fail(50, "bounces"), inside_meshes(BouncesInside{Start::on_face}, 4000, 100));
    cases.images("depth-1024", "in opaque mirrors a pixel takes 1,024 rays, stays black, and its ledger is B",
                 no_failures("sums"), depth_ends);
    // A Newton step takes a length 1 + e to 1 - 3/2 e^2 with a factor f of 3/2 - |d|^2 / 2: the square is off by 3 u,
    // its half by 1.5 u, f is rounded by u, the products by u. What e was does not matter: 3.5 u, or 1.75 ulps, and e^2
    // (e is under 64 u) of float.
    cases.rays<Lengths>("unit-length", "||d| - 1| after 1, 2, ... 1,000 reflections", at_most(Lengths::most, "ulps"),
                        lengths(true));
    cases.rays<Lengths>("broken/not-renormalized", "d - 2 (d.N) N alone drifts from unit length, which must be caught",
                        must_fail(1000, "reflections"), lengths(false));
}

}  // namespace cistula::verify
