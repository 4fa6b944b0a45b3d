// Cases on refraction: Snell, Fresnel, total reflection, and nested media.
#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "verify/cases/pictures.h"
#include "verify/cases/refraction/lines.h"
#include "verify/cases/scenes.h"

namespace cistula::verify {
namespace refraction {

void add_media(Cases& cases);  // media.cpp

namespace {

// ---- reference results of snell.h in 113 bits

using Quad = __float128;

/// Square root by Newton's method from the root in double; each step doubles the number of digits.
Quad root(Quad a) {
    if (!(a > 0)) return 0;
    Quad r = Quad(std::sqrt(double(a)));
    for (int step = 0; step < 2; ++step) r = (r + a / r) / 2;
    return r;
}

/// Appends the record of the refraction of `direction`, rounded to Real; returns g^2.
template <class Real>
Quad add_record(const Vec3<double>& direction, const Vec3<double>& normal, double from, double to, Numbers& numbers) {
    const Vec3<Real> d(direction), at(normal);
    const auto pair = [&](Quad x) {
        numbers.push_back(double(x));
        numbers.push_back(double(x - Quad(double(x))));
    };
    const Quad n = Quad(to) / Quad(from);
    Quad c = 0;
    for (int k = 0; k < 3; ++k) c -= Quad(d[k]) * Quad(at[k]);
    if (!(c > 0)) c = 0;
    const Quad g2 = (n - 1) * (n + 1) + c * c;
    const bool total = !(g2 > 0);
    numbers.insert(numbers.end(), {from, to});
    add_vector(glm::dvec3(d), numbers);
    add_vector(glm::dvec3(at), numbers);
    numbers.push_back(total ? 1 : 0);
    const Quad g = root(g2);
    // Fresnel's amplitudes in textbook form: perpendicular to the plane of incidence and in it.
    const Quad s = (c - g) / (c + g);
    const Quad p = (n * n * c - g) / (n * n * c + g);
    pair(total ? Quad(1) : (s * s + p * p) / 2);
    Quad through[3], square = 0;
    for (int k = 0; k < 3; ++k) through[k] = Quad(d[k]) + (c - g) * Quad(at[k]), square += through[k] * through[k];
    for (int k = 0; k < 3; ++k) pair(total ? Quad(0) : through[k] / root(square));
    return g2;
}
/// Appends records of one refraction for both precisions, side by side; returns the g^2 of double.
Quad add_records(const Vec3<double>& direction, const Vec3<double>& normal, double from, double to, Numbers& numbers) {
    add_record<float>(direction, normal, from, to, numbers);
    return add_record<double>(direction, normal, from, to, numbers);
}

struct IndexPair {
    double from, to;
};

/// A random unit vector perpendicular to `normal`.
Vec3<double> tangent_to(const Vec3<double>& normal, Draw& draw) {
    for (;;) {
        const Vec3<double> other = draw.in_cube<double>(1.0);
        const Vec3<double> across = other - dot(other, normal) * normal;
        if (dot(across, across) > 0x1p-8) return normalized(across);
    }
}
/// The incoming direction for a cosine and a sine of incidence.
Vec3<double> incoming(const Vec3<double>& normal, double cosine, double sine, Draw& draw) {
    const Vec3<double> tangent = tangent_to(normal, draw);
    return sine * tangent - cosine * normal;
}
Vec3<double> axis_normal(Draw& draw) {
    Vec3<double> normal(0.0);
    const int axis = draw.between(0, 2);
    normal[axis] = draw.sign();
    return normal;
}

/// A random pair of indices at least 2^-10 apart, in either order.
IndexPair drawn_pair(Draw& draw) {
    IndexPair pair{1 + 1.5 * draw.unit<double>(), 1};
    const int kind = draw.between(0, 3);
    if (kind == 0) pair.from = 1;
    pair.to = pair.from * (kind == 1 ? 1 + draw.unit<double>() * 0x1p-6 + 0x1p-10 : 1.0625 + 1.5 * draw.unit<double>());
    const bool swap = draw.one_in(2);
    return swap ? IndexPair{pair.to, pair.from} : pair;
}

/// Replaces the reflectance of the records of both precisions that begin at `first`.
void expect_share(Quad share, size_t first, Numbers& numbers) {
    for (const size_t at : {first + record_reflectance, first + record_size + record_reflectance}) {
        numbers[at] = double(share);
        numbers[at + 1] = double(share - Quad(double(share)));
    }
}

/// Adds a part of rays whose records make(draw, numbers) appends.
template <class Functor>
auto records(uint64_t seed, uint64_t in_full, uint64_t in_quick, void (*make)(Draw&, Numbers&)) {
    return [=](Plan& plan) {
        Part& part = plan.add("records", empty_scene(), Functor(), {}, plan.rays(in_full, in_quick));
        for (uint64_t i = 0; i < part.count; ++i) {
            Draw draw(i, seed);
            make(draw, part.numbers);
        }
    };
}
void normal_record(Draw& draw, Numbers& numbers) {
    const IndexPair index = drawn_pair(draw);
    const Vec3<double> normal = axis_normal(draw);
    const size_t first = numbers.size();
    add_records(-normal, normal, index.from, index.to, numbers);
    // The closed form instead of the general one.
    const Quad n = Quad(index.to) / Quad(index.from);
    const Quad amplitude = (n - 1) / (n + 1);
    expect_share(amplitude * amplitude, first, numbers);
}
/// Appends records for a cosine of incidence.
void add_incidence(Draw& draw, const IndexPair& index, const Vec3<double>& normal, double cosine, Numbers& numbers) {
    add_records(incoming(normal, cosine, std::sqrt((1 - cosine) * (1 + cosine)), draw), normal, index.from, index.to,
                numbers);
}
void grazing_record(Draw& draw, Numbers& numbers) {
    const IndexPair index = drawn_pair(draw);
    const Vec3<double> normal = axis_normal(draw);
    add_incidence(draw, index, normal, magnitude(draw.scaled<double>(-60, -1)), numbers);
}
void any_record(Draw& draw, Numbers& numbers) {
    const IndexPair index = drawn_pair(draw);
    const Vec3<double> normal = on_sphere(draw);
    const double n = index.to / index.from;
    const double critical = n < 1 ? std::sqrt((1 - n) * (1 + n)) : 0;
    const double cosine = critical + (1 - critical) * (0x1p-10 + (1 - 0x1p-10) * draw.unit<double>());
    add_incidence(draw, index, normal, cosine, numbers);
}
/// Appends a record whose direction is at Brewster's angle, tan = n, rounded; the expected share is that of the exact
/// angle.
void brewster_record(Draw& draw, Numbers& numbers) {
    const double from = 1 + draw.unit<double>();
    const double to = from * (1.0625 + 1.5 * draw.unit<double>());
    const Vec3<double> normal = axis_normal(draw);
    const Quad n = Quad(to) / Quad(from);
    const Quad cosine = 1 / root(1 + n * n);
    const size_t first = numbers.size();
    // The tangent along an axis as well: the other components are zeros, and stay so.
    Vec3<double> tangent(0.0);
    for (int k = 0; k < 3; ++k)
        if (normal[k] != 0) tangent[(k + 1 + draw.between(0, 1)) % 3] = draw.sign();
    add_records(double(n * cosine) * tangent - double(cosine) * normal, normal, from, to, numbers);
    const Quad amplitude = (n * n - 1) / (n * n + 1);
    const Quad share = amplitude * amplitude / 2;
    expect_share(share, first, numbers);
}

constexpr IndexPair critical_pairs[] = {{1.5, 1}, {1.5, 1.33}, {1.33, 1}, {2, 1}, {2.417, 1.5}};

/// Appends records at the critical sine times 1 + k step for |k| in [1, most], about normals along axes and others.
void sweep_records(const IndexPair& index, double step, int most, bool axes, uint64_t seed, Numbers& numbers) {
    for (int k = -most; k <= most; ++k) {
        if (k == 0) continue;
        Draw draw(uint64_t(k + most), seed);
        const Quad sine = Quad(index.to) / Quad(index.from) * (1 + Quad(k) * Quad(step));
        const Quad cosine = root((1 - sine) * (1 + sine));
        const Vec3<double> normal = axes ? axis_normal(draw) : on_sphere(draw);
        const Vec3<double> direction = incoming(normal, double(cosine), double(sine), draw);
        const Quad g2 = add_records(direction, normal, index.from, index.to, numbers);
        // Along an axis the cosine is rounded once, so that the order of steps must show: the reference itself is
        // right.
        if (axes && step >= 0x1p-22 && (g2 > 0) == (k > 0)) throw std::runtime_error("the reference decides wrongly");
    }
}

void plan_critical(Plan& plan) {
    const int most = int(plan.rays(20000, 400));
    for (const IndexPair& index : critical_pairs)
        for (const double step : {0x1p-22, 0x1p-54})
            for (const bool axes : {true, false}) {
                Numbers numbers;
                sweep_records(index, step, most, axes, uint64_t(index.from * 1e6 + axes), numbers);
                Part& part = plan.add(std::to_string(index.from) + " to " + std::to_string(index.to) +
                                          (step == 0x1p-22 ? ", steps of 2^-22" : ", steps of 2^-54"),
                                      empty_scene(), CriticalAngle(), {}, uint64_t(2 * most));
                part.numbers = std::move(numbers);
            }
}
void plan_critical_traced(Plan& plan) {
    const int most = int(plan.rays(20000, 200));
    for (const IndexPair& index : critical_pairs)
        for (const Shape shape : {Shape::planes, Shape::triangles}) {
            SceneDescription scene = empty_scene();
            const double radius = std::sqrt(3.0);  // half diagonal of a cube of side 2
            add_solid(scene, shape, solid_object(PlatonicSolid::cube, {}, radius),
                      add_material(scene, glass(index.to)));
            add_solid(scene, shape, solid_object(PlatonicSolid::cube, {}, radius / 2),
                      add_material(scene, glass(index.from)));
            Part& part = plan.add(std::to_string(index.from) + " to " + std::to_string(index.to), scene,
                                  CriticalAngleTraced(), {}, uint64_t(2 * most));
            sweep_records(index, 0x1p-22, most, true, uint64_t(index.to * 1e6), part.numbers);
        }
}
/// A part of directions that the functor draws.
template <class Functor>
auto any_angle(uint64_t in_quick) {
    return [=](Plan& plan) { plan.add("any angle", empty_scene(), Functor(), {}, plan.rays(1000000, in_quick)); };
}

// ---- traced

void plan_camera_inside(Plan& plan) {
    const auto add = [&](const char* label, const SceneDescription& scene) {
        plan.add(label, scene, CameraInside(), {}, plan.rays(200000, 1500));
    };
    for (const Shape shape : {Shape::planes, Shape::triangles}) {
        SceneDescription nested = empty_scene();
        SceneDescription overlapping = empty_scene();
        const double indices[] = {1.5, 1.33, 2};
        for (int k = 0; k < 3; ++k) {
            const PlatonicSolid kind = platonic_solids[4 - k];
            const glm::dvec3 turn(10 * k, 20, 30 + k);
            add_solid(nested, shape, solid_object(kind, {}, 1.2 / (1 << k), turn),
                      add_material(nested, glass(indices[k])));
            add_solid(overlapping, shape, solid_object(kind, {0.375 * (k - 1), 0.125 * k, 0}, 0.75, turn),
                      add_material(overlapping, glass(indices[k])));
        }
        add(shape == Shape::planes ? "nested planes" : "nested meshes", nested);
        add(shape == Shape::planes ? "overlapping planes" : "overlapping meshes", overlapping);
    }
    SceneDescription hollow = empty_scene();
    SceneDescription spiked = empty_scene();
    add_object(hollow, torus(0.8, 0.3, 24, 12), add_material(hollow, glass(1.5)));
    add_solid(hollow, Shape::planes, solid_object(PlatonicSolid::icosahedron, {0.8, 0, 0}, 0.4),
              add_material(hollow, glass(1.33)));
    add_object(spiked, star(), add_material(spiked, glass(1.25)));
    add("a torus with a solid", hollow);
    add("a star", spiked);
}
/// Two faces of a solid at one of its edges, and an index for which light passes symmetrically.
struct Prism {
    PlatonicSolid solid;
    double index;
};
constexpr Prism prisms[] = {{PlatonicSolid::tetrahedron, 1.5},
                            {PlatonicSolid::cube, 1.3},
                            {PlatonicSolid::octahedron, 1.15},
                            {PlatonicSolid::dodecahedron, 1.1},
                            {PlatonicSolid::icosahedron, 1.04}};

void prism_numbers(const SolidObject& solid, double index, const PartFrame& frame, Numbers& numbers) {
    const Polyhedron& shape = platonic_shape(solid.solid);
    const Rotation rotation(solid.rotation);
    const auto& edge = shape.edges[0];
    const auto normal_of = [&](uint32_t id) {
        for (const auto& face : shape.faces)
            if (face.id == id) return rotation(face.normal);
        return glm::dvec3(0);
    };
    const glm::dvec3 first = normal_of(edge.faces[0]);
    const glm::dvec3 second = normal_of(edge.faces[1]);
    const glm::dvec3 a = rotation(shape.vertices[edge.vertices[0]]);
    const glm::dvec3 b = rotation(shape.vertices[edge.vertices[1]]);
    // The angle between the normals is 180 degrees less A: half of it has the cosine sin(A/2).
    Quad product = 0;
    for (int k = 0; k < 3; ++k) product += Quad(first[k]) * Quad(second[k]);
    const Quad half_sine = root((1 + product) / 2);
    const Quad half_cosine = root((1 - product) / 2);
    // Snell at the face: sin of incidence n sin(A/2); the deviation is twice that angle less A.
    const Quad s = Quad(index) * half_sine;
    const Quad c = root((1 - s) * (1 + s));
    const Quad half_turn_cosine = c * half_cosine + s * half_sine;
    const Quad cosine = 2 * half_turn_cosine * half_turn_cosine - 1;
    const glm::dvec3 within = normalized(second - first);  // across the plane that halves the prism
    const glm::dvec3 along_first = normalized(within - dot(within, first) * first);
    const glm::dvec3 along_second = normalized(within - dot(within, second) * second);
    const glm::dvec3 in =
        normalized(along_first * (index * length(within - dot(within, first) * first)) - double(c) * first);
    const glm::dvec3 out =
        normalized(along_second * (index * length(within - dot(within, second) * second)) + double(c) * second);
    // The symmetric path, a little inside the middle of the edge, back to the first face.
    const glm::dvec3 inward = -normalized(first + second);
    const double apothem = length(a - b) * 0.125;
    const glm::dvec3 through = 0.5 * (a + b) + inward * apothem;
    const double back = (shape.inradius - dot(first, through)) / dot(first, within);
    const glm::dvec3 entry = frame.point((through + back * within) * solid.radius + solid.center);
    const glm::dvec3 along = normalized(b - a);
    for (const glm::dvec3& v : {in, out, along, entry}) add_vector(v, numbers);
    numbers.insert(numbers.end(), {double(cosine), length(b - a) * solid.radius * frame.factor});
}
void plan_prisms(Plan& plan) {
    for (const Prism& prism : prisms)
        for (const glm::dvec3& turn : turns) {
            SceneDescription scene = empty_scene();
            const SolidObject solid = solid_object(prism.solid, {}, 1, turn);
            add_solid(scene, Shape::planes, solid, add_material(scene, glass(prism.index)));
            Part& part = plan.add(platonic_name(prism.solid), scene, PrismDeviation(), {}, plan.rays(200000, 2000));
            part.frame_numbers = [solid, prism](const PartFrame& frame, Numbers& numbers) {
                prism_numbers(solid, prism.index, frame, numbers);
            };
        }
}

constexpr double slab_indices[] = {1.0625, 1.33, 1.5, 2.5};

template <class Functor>
void plan_slabs(Plan& plan, Shape shape, bool turned) {
    for (const double index : slab_indices)
        for (const glm::dvec3& turn : {glm::dvec3(0), glm::dvec3(20, 35, 50)}) {
            if (!turned && turn != glm::dvec3(0)) continue;
            SceneDescription scene = empty_scene();
            const glm::dvec3 center(3, -7, 5);
            add_solid(scene, shape, solid_object(PlatonicSolid::cube, center, std::sqrt(3.0), turn),
                      add_material(scene, glass(index)));
            std::vector<glm::dvec3> points;
            for (const auto& face : platonic_shape(PlatonicSolid::cube).faces)
                points.push_back(center + Rotation(turn)(face.normal));
            points.push_back(center);
            Part& part = plan.add("index " + std::to_string(index), scene, Functor(), points, plan.rays(200000, 2000));
            part.frame_numbers = [index](const PartFrame& frame, Numbers& numbers) { numbers = {index, frame.factor}; };
        }
}

// ---- a clear solid of the surrounding index changes no bit of the image

/// A room with a checkered floor, an opaque solid, a mirror, tinted absorbing Fresnel glass, and lights of all kinds.
/// The frame and the bound are given, so that additional solids change neither.
SceneDescription room() {
    SceneDescription scene = empty_scene();
    scene.frame = FrameOfReference{{0, 0, 0}, -2, 64.0};
    scene.camera.position = {3.1, -3.7, 2.2};
    scene.camera.target = {0, 0, 0.4};
    scene.camera.field_of_view = 50;
    scene.depth = 6;
    scene.ambient = glm::dvec3(0.2);
    scene.background = {0.1, 0.2, 0.4};
    const int floor = add_material(scene, {.reflection = 0.2});
    add_checker(scene, {8, 8}, floor, {glm::dvec3(0.9, 0.8, 0.7), glm::dvec3(0.1, 0.2, 0.3)});
    TrianglesObject quad = parallelogram({-5, -5, -1}, {10, 0, 0}, {0, 10, 0});
    quad.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    add_object(scene, quad, floor);
    add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube, {-1.5, 1.25, -0.25}, 1, {0, 0, 20}),
              add_material(scene, {.specular = 0.5, .reflection = 0.8}));
    add_solid(scene, Shape::planes, solid_object(PlatonicSolid::icosahedron, {0.5, -0.5, 0.25}, 1, {10, 20, 30}),
              add_material(scene, {.reflection = 0.2,
                                   .transmission = 0.7,
                                   .tint = {0.9, 1, 0.8},
                                   .index = 1.5,
                                   .absorption = {0.1, 0.2, 0.3},
                                   .fresnel = true}));
    add_solid(scene, Shape::triangles, solid_object(PlatonicSolid::octahedron, {-1, -1.5, 0}, 0.7, {5, 0, 40}),
              add_material(scene, {.specular = 0.5}));
    add_light(scene, {3, -3, 4});
    LightDescription& seen = add_light(scene, {-1, 0.5, 1.5});
    seen.color = {0.8, 0.6, 0.4};
    seen.radius = 0.125;
    seen.falloff = true;
    return scene;
}

void index_one(Stage& stage, Tally& tally) {
    using Change = std::function<void(SceneDescription&, int clear)>;
    const int width = stage.quick ? 40 : 320;
    const int height = stage.quick ? 30 : 240;
    const auto compare = [&](const SceneDescription& scene, bool first, const Change& add) {
        SceneDescription with = scene;
        SceneDescription alone = scene;
        const int clear = add_material(with, glass(1));
        const int split = add_material(with, glass(1));
        with.materials[size_t(split)].fresnel = true;
        const size_t before = with.objects.size();
        add(with, clear);
        const int added = int(with.objects.size() - before);
        for (size_t k = before; k < with.objects.size(); k += 2) with.objects[k].material = split;
        if (first) std::rotate(with.objects.begin(), with.objects.begin() + long(before), with.objects.end());
        const Film seen = stage.render(with, width, height);
        const Film expected = stage.render(alone, width, height);
        tally.expect(seen.flags == 0 && expected.flags == 0 && seen.fixed_shift == expected.fixed_shift &&
                     seen.radiance_exponent == expected.radiance_exponent);
        // Ids of lights come after those of all solids. Lines pass more faces: rays are not compared.
        const int solids = int(alone.objects.size());
        for (size_t i = 0; i < expected.pixels.size(); ++i) {
            PixelRecord pixel = expected.pixels[i];
            pixel.id += pixel.id > solids ? added : pixel.id != 0 && first ? added : 0;
            pixel.rays = seen.pixels[i].rays;
            tally.place = i;
            tally.expect(same_pixel(seen.pixels[i], pixel));
        }
    };
    // A solid of lower priority than all others: through everything, around the camera and around lights. At most 8
    // in one place.
    const Change everywhere = [](SceneDescription& scene, int clear) {
        for (size_t k = 0; k < 5; ++k) {
            const PlatonicSolid kind = platonic_solids[k];
            const double angle = 20 * double(k);
            if (k % 2 == 0)
                add_solid(scene, Shape::planes,
                          solid_object(kind, {0.5 * double(k) - 1, 0.25, 0.125}, 2, {angle, 5, 7}), clear);
            else
                add_solid(scene, Shape::triangles,
                          solid_object(kind, {0.5, 0.5 * double(k) - 1, 0.5}, 1, {3, angle, 9}), clear);
        }
        add_solid(scene, Shape::planes, solid_object(PlatonicSolid::icosahedron, scene.camera.position, 1), clear);
        add_solid(scene, Shape::triangles, solid_object(PlatonicSolid::dodecahedron, scene.camera.position, 0.5),
                  clear);
        add_solid(scene, Shape::planes, solid_object(PlatonicSolid::octahedron, scene.lights[1].position, 1), clear);
        add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube, {3, -3, 3}, std::sqrt(3.0)), clear);
    };
    compare(room(), true, everywhere);
    // Last in the file they would carve a hole into what they overlap: beside it. (On the floor they would
    // change t by rounding: the group contact has such.)
    const Change beside = [](SceneDescription& scene, int clear) {
        add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube, {2.75, 1.75, 0.25}, std::sqrt(3.0)), clear);
        add_solid(scene, Shape::triangles, solid_object(PlatonicSolid::cube, {-3, -3, 0.25}, std::sqrt(3.0)), clear);
        add_object(scene, moved(torus(0.5, 0.2, 24, 12), {1.5, -2.5, 0.5}), clear);
        add_object(scene, moved(star(), {-1.5, 4, 1}), clear);
        add_solid(scene, Shape::planes, solid_object(PlatonicSolid::octahedron, {2.75, -0.5, 1.25}, 1), clear);
    };
    compare(room(), false, beside);
    // Inside a body of the same index, seen from outside and from within.
    for (const Shape shape : {Shape::planes, Shape::triangles})
        for (const bool from_within : {false, true}) {
            SceneDescription scene = room();
            MaterialDescription material = glass(1.5);
            material.reflection = 0.1;
            material.transmission = 0.9;
            add_solid(scene, shape, solid_object(PlatonicSolid::dodecahedron, {2, -2, 1.5}, 1),
                      add_material(scene, material));
            if (from_within) scene.camera.position = {2.25, -2.25, 1.5};
            compare(scene, false, [&](SceneDescription& with, int clear) {
                with.materials[size_t(clear)].index = with.materials[size_t(clear) + 1].index = 1.5;
                add_solid(with, Shape::planes, solid_object(PlatonicSolid::icosahedron, {2, -2, 1.5}, 0.5), clear);
                add_solid(with, Shape::triangles, solid_object(PlatonicSolid::octahedron, {2, -2, 1.5}, 0.375), clear);
            });
        }
}
/// Bound in ulps for results computed one precision up and rounded once. For float that is double: n - 1 has a relative
/// error of 2^-53 / |n - 1| <= 2^-43, which the square doubles; g^2, at least 2^-14 here, one of 2^-39 at most; every
/// further step adds about 2^-52. Beside the half ulp of the last rounding all of these are below 2^-13 of an ulp, and
/// less in double; the bound allows 2^-10.
constexpr double rounded_once = 0.5 + 0x1p-10;

}  // namespace
}  // namespace refraction

void add_refraction(Cases& cases) {
    using namespace refraction;
    cases.images("index-one", "the image without the solid, integer for integer", no_failures("pixels"), index_one);
    // Decided as the exact value of g^2 = (n - 1)(n + 1) + c^2 of the rounded direction and normal says, in steps of
    // 2^-22 of the sine over the critical angle; in double, of 2^-54 too. Zero is total.
    cases.rays<CriticalAngle>("critical-angle", "total reflection where 113 bits say so, in steps of 2^-22 and 2^-54",
                              no_failures("decisions"), plan_critical);
    cases.rays<CriticalAngleTraced>("critical-angle/traced",
                                    "the ray tree mirrors or bends as 113 bits say, in steps of 2^-22",
                                    no_failures("rays", needs_witness), plan_critical_traced);
    const Bound once = at_most(rounded_once, "ulps");
    cases.rays<FresnelNormal>("fresnel/normal-incidence", "((n - 1)/(n + 1))^2, rounded once; the direction unchanged",
                              once, records<FresnelNormal>(1, 100000, 4000, normal_record));
    cases.rays<FresnelEqual>("fresnel/equal-indices", "no reflection, no bend, at any angle", no_failures("rays"),
                             any_angle<FresnelEqual>(10000));
    cases.rays<FresnelGrazing>("fresnel/grazing",
                               "all is reflected at cosine 0; the share and its rounding from 2^-60 up", once,
                               records<FresnelGrazing>(2, 100000, 4000, grazing_record));
    cases.rays<AnyAngle>("fresnel/any-angle", "Fresnel's share, rounded once; Snell's direction within 4.5 u", once,
                         records<AnyAngle>(3, 200000, 8000, any_record));
    // Reflectance at Brewster's angle, ((n^2 - 1)/(n^2 + 1))^2 / 2. The amplitude perpendicular to the plane has the
    // derivative 2 D / (g h^2) by c, so its square changes by the share 4 c / g = 4 / n^2 of c's change; the other
    // amplitude's square has derivative 0 there. c is rounded by at most u, which is at most one ulp of the share: 4
    // ulps for n >= 1, and one rounding.
    cases.rays<BrewsterShare>("brewster/share", "half of ((n^2 - 1)/(n^2 + 1))^2: none of the light in the plane",
                              at_most(4 + rounded_once, "ulps"),
                              records<BrewsterShare>(4, 100000, 4000, brewster_record));
    // Perpendicularity of the reflected and the refracted ray. The angle between them changes by 1 + c / g = 1 + 1 /
    // n^2
    // <= 2 times that of incidence, which is off by at most u: 2 u. The reflected ray is rounded by its last factor, u;
    // the other by 2 u (any-angle). 5 u.
    cases.rays<BrewsterAngle>("brewster/right-angle", "mirrored and refracted ray at right angles", at_most(5, "u"),
                              records<BrewsterAngle>(5, 100000, 4000, brewster_record));
    cases.rays<Reversibility>("reversibility", "refracted back, a ray returns on itself, at the same share",
                              at_most(4.5, "u x condition", needs_witness), any_angle<Reversibility>(20000));
    // Both faces have the same normal, bit for bit, so this is reversibility once more, with n < 1 on the way out and
    // the same bound. A mesh's normals come from its corners; both faces have the same one only if perpendicular to an
    // axis.
    cases.rays<SlabParallel>("slab/parallel", "the ray leaves as it came", at_most(4.5, "u x condition", needs_witness),
                             [](Plan& plan) {
                                 plan_slabs<SlabParallel>(plan, Shape::planes, true);
                                 plan_slabs<SlabParallel>(plan, Shape::triangles, false);
                             });
    // In u M. A point on a ray is rounded in three coordinates: sqrt(3). Its distance from the plane is that of t, a
    // difference of two numbers below sqrt(3) M with four roundings in all, 7; it moves the exit by no more than
    // itself, and there are two planes: 14. The two points: 3.5. The direction within, 2 u across (any-angle) over a
    // way of at most 2 sqrt(3) M: 7. That of the first line in the reference, s and c in double for double: 4. The
    // plane's normal and offset, rounded: 2 sqrt(3) u M each, 7. In all 36.
    cases.rays<SlabDisplacement>("slab/displacement", "moved aside by h s (1 - c/g)", at_most(36, "u M", needs_witness),
                                 [](Plan& plan) { plan_slabs<SlabDisplacement>(plan, Shape::planes, true); });
    // In u, of the cosine of the deviation. Rounded normals change the angle between the faces by 2 u and the least
    // deviation by n cos(A/2)/c - 1 <= 1.5 of that: 3. Inside the direction is off by 2 u across, and at the exit by
    // g/c
    // <= 2.5 of it, 5; for its length, 3 u, by s D/(n^2 c) <= 1.2 of that, 3.5; that of the ray inside, 2.5 u, by s D/c
    // <= 2.2, 5.5; its own rounding 2: 19 u of angle, by the sine of the deviation, at most 0.77: 15. Lengths of the
    // two, 5.5 u, by its cosine, at most 0.8: 4.5. The reference and the measured product, in double: 4. In all 23.5.
    cases.rays<PrismDeviation>("prism/minimum-deviation",
                               "2 asin(n sin(A/2)) - A on the symmetric way, and no less beside it",
                               at_most(23.5, "u", needs_witness), plan_prisms);
    add_media(cases);
    cases.rays<CameraInside>("camera-inside", "media, next face and next direction of a ray from outside, bit for bit",
                             no_failures("rays", needs_witness), plan_camera_inside);
}

}  // namespace cistula::verify
