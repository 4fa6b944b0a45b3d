// Cases on changes that must leave an image unchanged or change it in a known way: scales, places, flips, effects,
// threads, brightness.
#include <tbb/global_control.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "backend_embree/embree/embree_renderer.h"
#include "base/error.h"
#include "cistula/numerics/fixed_sum.h"
#include "render/record/film_difference.h"
#include "sequence/backends.h"
#include "verify/cases/metamorphic/rays.h"
#include "verify/cases/metamorphic/scenes.h"
#include "verify/reference_renderers.h"

namespace cistula::verify {
namespace metamorphic {

void add_samples(Cases& cases);  // samples.cpp

namespace {

// ---- the image does not depend on threads, lanes, tiles, crops, trees, instruction sets, the order of primitives, or
// devices

template <class Real>
using Compiled = std::shared_ptr<CompiledScene<Real>>;

Film film_by(Renderer& renderer, const SceneDescription& scene, const FrameSettings& settings) {
    Film film;
    RenderProgress progress;
    renderer.render(camera_at(scene.camera, 0), settings, film, progress);
    return film;
}

template <class Real>
void swap_lanes(Cluster<Real>& cluster, uint32_t a, uint32_t b) {
    for (auto& corner : cluster.corner)
        for (auto& axis : corner) std::swap(axis[a], axis[b]);
    for (auto& side : cluster.height) std::swap(side[a], side[b]);
    std::swap(cluster.triangle[a], cluster.triangle[b]);
}

/// Reorders primitives, and the triangles in clusters. Their numbers, which decide ties, stay.
template <class Real>
void shuffle_primitives(CompiledScene<Real>& scene, std::mt19937_64& random) {
    std::shuffle(scene.convex.begin(), scene.convex.end(), random);
    std::shuffle(scene.clusters.begin(), scene.clusters.end(), random);
    for (Cluster<Real>& cluster : scene.clusters)
        for (uint32_t lane = cluster.count; lane > 1; --lane) swap_lanes(cluster, lane - 1, uint32_t(random() % lane));
}

/// Reorders a tree's children and the items of its leaves.
template <class Real>
void shuffle_tree(CompiledScene<Real>& scene, std::mt19937_64& random) {
    for (TreeNode& node : scene.tree) {
        for (int side = 0; side < 2; ++side)
            if (node.child[side] < 0 && node.count[side] > 0)
                std::shuffle(scene.tree_items.begin() + ~node.child[side],
                             scene.tree_items.begin() + ~node.child[side] + node.count[side], random);
        if (random() % 2) continue;
        std::swap(node.low[0], node.low[1]);
        std::swap(node.high[0], node.high[1]);
        std::swap(node.child[0], node.child[1]);
        std::swap(node.count[0], node.count[1]);
    }
}

/// All ways to make a renderer of an intersector; all must give the same image.
template <class Real>
std::vector<std::function<std::unique_ptr<Renderer>(Compiled<Real>)>> renderers(const std::string& intersector) {
    std::vector<std::function<std::unique_ptr<Renderer>(Compiled<Real>)>> all;
    if (intersector == "embree") {
        std::vector<EmbreeOptions> variants = {{"", 0, true}, {"", 1, true}, {"isa=sse2", 1, true}};
        if (__builtin_cpu_supports("avx2")) variants.push_back({"isa=avx2", 1, true});
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
            __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
            variants.push_back({"isa=avx512", 1, true});
        for (const EmbreeOptions& options : variants)
            all.push_back([options](Compiled<Real> scene) { return make_embree_renderer<Real>(scene, options); });
    } else if (intersector == "lanes") {
        all.push_back([](Compiled<Real> scene) { return make_embree_renderer<Real>(scene); });
    } else if (intersector == "bvh") {
        for (const int quality : {0, 1})
            for (const bool shuffled : {false, true})
                all.push_back([quality, shuffled](Compiled<Real> scene) {
                    build_primitive_tree(*scene, quality);
                    std::mt19937_64 random(5);
                    if (shuffled) shuffle_tree(*scene, random);
                    return make_host_renderer<Real>(scene, HostIntersector::bvh);
                });
    } else if (intersector == "brute") {
        all.push_back([](Compiled<Real> scene) { return make_host_renderer<Real>(scene, HostIntersector::brute); });
    } else {
        DeviceChoice every;
        every.all = true;
        std::vector<CudaOptions> variants(4, choose_devices(Backend::cuda, {}).options);
        variants[1].devices = choose_devices(Backend::cuda, every).options.devices;  // one GPU or several
        variants[2].always_tree = true;
        variants[3].memory_limit = size_t(1) << 20;
        for (const CudaOptions& options : variants)
            all.push_back(
                [options](Compiled<Real> scene) { return make_renderer<Real>(Backend::cuda, scene, options); });
    }
    return all;
}

template <class Real>
void one_hash(Stage& stage, Tally& tally) {
    for_each_scene(stage, 200, 12, [&](uint64_t seed, const SceneDescription& scene) {
        const FrameSettings settings = generated_settings(scene);
        const Film expected =
            film_by(*make_host_renderer<Real>(compile_scene<Real>(scene), HostIntersector::brute), scene, settings);
        uint64_t variation = 0;
        const auto check = [&](const Film& film) {
            tally.place = place_of(seed, variation++, 0);
            tally.expect(film.flags == 0 && film_difference(film, expected).differing == 0);
        };
        check(stage.render(scene, settings));
        for (const auto& make : renderers<Real>(stage.intersector))
            for (const bool shuffled : {false, true}) {
                Compiled<Real> compiled = compile_scene<Real>(scene);
                std::mt19937_64 random(seed);
                if (shuffled) shuffle_primitives(*compiled, random);
                check(film_by(*make(compiled), scene, settings));
            }
        return true;
    });
}

void threads_and_tiles(Stage& stage, Tally& tally) {
    for_each_scene(stage, 40, 6, [&](uint64_t seed, const SceneDescription& scene) {
        FrameSettings settings = generated_settings(scene);
        const Film whole = stage.render(scene, settings);
        uint64_t variation = 0;
        for (const size_t threads : {1, 2, 7}) {
            const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
            for (const int tile : {1, 5, 16, 64}) {
                settings.tile = tile;
                expect_same(tally, stage.render(scene, settings), whole, seed, variation++);
            }
        }
        for (const int lanes : {1, 4, 8, 16}) {
            settings.lanes = lanes;
            expect_same(tally, stage.render(scene, settings), whole, seed, variation++);
        }
        for (const PixelRect& crop : {PixelRect{0, 0, 24, 5}, PixelRect{0, 5, 11, 11}, PixelRect{11, 5, 13, 11}}) {
            settings.crop = crop;
            settings.tile = 4;
            Film part = whole;  // the whole frame, cropped
            part.pixels.begin(size_t(crop.width * crop.height));
            for (int y = 0; y < crop.height; ++y)
                for (int x = 0; x < crop.width; ++x)
                    part.pixels.set(size_t(y * crop.width + x), whole.pixels[size_t((crop.y + y) * 24 + crop.x + x)]);
            expect_same(tally, stage.render(scene, settings), part, seed, variation++);
        }
        return true;
    });
}

/// Effects that a scene does not use are left out at compile time; including them changes no bit.
void more_effects(Stage& stage, Tally& tally) {
    for_each_scene(stage, 80, 24, [&](uint64_t seed, const SceneDescription& scene) {
        const int least = least_mask(compile_scene<float>(scene)->effects);
        if (least == effect_mask_count - 1) return false;  // runs with all of them anyway
        FrameSettings settings = generated_settings(scene);
        const Film expected = stage.render(scene, settings);
        for (int mask = least; mask < effect_mask_count; ++mask) {
            settings.effects = effect_masks[mask];
            expect_same(tally, stage.render(scene, settings), expected, seed, uint64_t(mask));
            tally.witness(mask > least && shows_something(expected));
        }
        // One at a time, too: whatever the renderer makes of them.
        for (int bit = 0; bit < effect_count && !stage.quick; ++bit) {
            settings.effects = 1u << bit;
            expect_same(tally, stage.render(scene, settings), expected, seed, uint64_t(100 + bit));
        }
        return true;
    });
}

// ---- scenes in other units and at other positions: the frame of reference makes the numbers, and the image, the same

/// Multiplies all lengths by 2^k and the intensities of lights with falloff by 4^k.
void scale_scene(SceneDescription& scene, int k) {
    const double s = std::ldexp(1.0, k);
    const auto scale_light = [=](auto& light) {
        light.radius *= s;
        if (!light.falloff) return;
        light.glow = light.glow.value_or(light.color);
        light.color *= s * s;
    };
    for_each_point(scene, [=](glm::dvec3& p) { p *= s; });
    for (ObjectDescription& object : scene.objects) {
        if (auto* ball = std::get_if<SphereObject>(&object.shape)) ball->radius *= s;
        if (auto* disk = std::get_if<DiskObject>(&object.shape)) disk->radius *= s;
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) {
            solid->radius *= s;
            scale_light(solid->edge_lights);
        }
    }
    for (LightDescription& light : scene.lights) scale_light(light);
    for (MaterialDescription& m : scene.materials) m.absorption /= s;
    for (auto* path : {&scene.camera.position_path, &scene.camera.target_path})
        if (*path)
            for (double* length : {&(*path)->r0, &(*path)->z0, &(*path)->Ar, &(*path)->Az}) *length *= s;
    if (!scene.frame) return;
    scene.frame->center *= s;
    scene.frame->scale -= k;
}

/// Whether a scene has disks, or planes without end, of which a condition holds.
template <class Condition>
bool has_disks(const SceneDescription& scene, const Condition& holds) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const ObjectDescription& object) {
        const auto* disk = std::get_if<DiskObject>(&object.shape);
        return disk && holds(*disk, scene.materials[size_t(object.material)]);
    });
}

/// Coordinates become multiples of 2^-20 of the scene's size, so that adding multiples of that, of up to 2^32 times it,
/// is exact in double; the frame is pinned, since corners of solids that are turned are not such multiples. The
/// camera's paths give way to its position and target in frame 0.
void put_on_grid(SceneDescription& scene) {
    const auto compiled = compile_scene<double>(scene);
    const double size = std::ldexp(1.0, -compiled->scale);
    const double step = size * 0x1p-20;
    const auto snap = [&](glm::dvec3& p) {
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::floor(p[axis] / step + 0.5) * step;
    };
    const Camera camera = camera_at(scene.camera, 0).camera;
    scene.camera.position_path.reset();
    scene.camera.target_path.reset();
    scene.camera.position = camera.position;
    scene.camera.target = camera.position + camera.forward * size;
    for_each_point(scene, snap);
    scene.frame = FrameOfReference{compiled->center, compiled->scale - 1, {}};
    snap(scene.frame->center);
}
void translate_scene(SceneDescription& scene, const glm::dvec3& by) {
    for_each_point(scene, [&](glm::dvec3& p) { p += by; });
    if (scene.frame) scene.frame->center += by;
}

void powers_of_two(Stage& stage, Tally& tally) {
    const int step = stage.quick ? 20 : 4;
    for_each_scene(stage, 100, 16, [&](uint64_t seed, const SceneDescription& scene) {
        const auto is_tiled = [](const DiskObject& disk, const MaterialDescription& material) {
            return disk.is_endless() && material.texture >= 0;
        };
        if (has_disks(scene, is_tiled)) return false;  // one texture a scene unit, whatever that is
        const Film expected = stage.render(scene, generated_settings(scene));
        tally.witness(shows_something(expected));
        for (int k = -40; k <= 40; k += step) {
            SceneDescription scaled = scene;
            scale_scene(scaled, k == 0 ? 1 : k);  // 2^1 in the place of 2^0
            const Film found = stage.render(scaled, generated_settings(scaled));
            expect_same(tally, found, expected, seed, uint64_t(k + 40), std::ldexp(1.0f, k == 0 ? 1 : k));
        }
        return true;
    });
}

/// Scenes on the grid and their displacements: by their size, and far away. M is the largest coordinate in world units,
/// where corners of turned solids are rounded, and of the squares that stand for disks; where a corner of the ground,
/// on the grid, is the largest, and there are no disks, nothing at all depends on the place, else hits do not.
auto translated(bool with_ground) {
    return [=](Stage& stage, Tally& tally) {
        for_each_scene(stage, 150, 24, [&](uint64_t seed, SceneDescription scene) {
            const auto is_any = [](const DiskObject&, const MaterialDescription&) { return true; };
            if (with_ground && has_disks(scene, is_any)) return false;
            put_on_grid(scene);
            const double size = std::ldexp(1.0, -scene.frame->scale);
            const double reach = 1.75 * size;
            if (with_ground)  // below everything else, and reaching farthest
                add_object(scene, parallelogram(scene.frame->center - reach, {2 * reach, 0, 0}, {0, 2 * reach, 0}),
                           add_material(scene, MaterialDescription()));
            scene.contact = 0x1p-16 * size;  // not what the digits of a place say
            const Film expected = stage.render(scene, generated_settings(scene));
            tally.witness(shows_something(expected));
            uint64_t variation = 0;
            for (const glm::dvec3& by : {glm::dvec3(0x1p-19, -1, 0x1p10), glm::dvec3(-0x1p20, 0x1.8p15, 0x1p-18),
                                         glm::dvec3(0x1.4p30, 0x1p30, -0x1.8p29)}) {
                SceneDescription moved = scene;
                translate_scene(moved, by * size);
                const Film found = stage.render(moved, generated_settings(moved));
                if (with_ground)
                    expect_same(tally, found, expected, seed, variation++);
                else
                    expect_same_hits(tally, found, expected, seed, variation++);
            }
            return true;
        });
    };
}

/// Tests the frame's computed center: that of corners on a grid moves with them.
void found_center(Stage& stage, Tally& tally) {
    SceneDescription scene = empty_scene();
    scene.materials[0].transmission = 0.6;
    scene.materials[0].reflection = 0.2;
    scene.materials[0].index = 1.5;
    add_object(scene, torus(1.5, 0.5, 12, 8));
    add_object(scene, star(0.5));
    add_light(scene, {3, -4, 5});
    scene.camera.position = {1, -4, 2};
    for_each_point(scene, [](glm::dvec3& p) {
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::floor(p[axis] * 0x1p16) * 0x1p-16;
    });
    const FrameSettings settings = frame_of(32, 24, 1, 5);
    const Film expected = stage.render(scene, settings);
    tally.witness(shows_something(expected));
    for (int k = 0; k <= 32; k += stage.quick ? 8 : 1) {
        SceneDescription moved = scene;
        translate_scene(moved, glm::dvec3(std::ldexp(1.0, k), std::ldexp(-0.75, k), 0x1p-16 * k));
        expect_same(tally, stage.render(moved, settings), expected, 0, uint64_t(k));
    }
}

// ---- flips of axes

/// Number of maps to test for a solid: 8, or 16 with the swap. The tetrahedron has none of the flips and is left out.
uint32_t maps_of(PlatonicSolid kind) {
    return kind == PlatonicSolid::cube || kind == PlatonicSolid::octahedron ? 16 : 8;
}
/// Corners on multiples of 2^-10: their flips, and those of the frame's center, are exact.
TrianglesObject on_grid(TrianglesObject mesh) {
    for (glm::dvec3& p : mesh.vertices)
        for (int axis = 0; axis < 3; ++axis) {
            const double size = std::floor(std::abs(p[axis]) * 0x1p10 + 0.5) * 0x1p-10;
            p[axis] = p[axis] < 0 ? -size : size;
        }
    return mesh;
}
void plan_flips(Plan& plan, Shape shape) {
    for (const PlatonicSolid kind : platonic_solids) {
        if (kind == PlatonicSolid::tetrahedron) continue;
        SceneDescription scene = empty_scene();
        scene.frame = FrameOfReference();
        const SolidObject solid = solid_object(kind);
        std::vector<glm::dvec3> points = edge_points(solid);
        if (shape == Shape::planes) {
            add_object(scene, solid);
        } else {
            const TrianglesObject mesh = on_grid(triangulated_solid(solid));
            add_object(scene, mesh);
            points = mesh.vertices;
            for (const auto& edge : platonic_shape(kind).edges)
                for (int k = 1; k < 16; ++k)
                    points.push_back(mesh.vertices[edge.vertices[0]] * (1 - k / 16.0) +
                                     mesh.vertices[edge.vertices[1]] * (k / 16.0));
        }
        plan.add(platonic_name(kind), scene, Flips{shape == Shape::planes, maps_of(kind)}, points,
                 plan.rays(1'000'000, 12'000));
    }
}

/// Mirrors, glass and lights on solids of planes: dot is symmetric in x and y, so that a flipped scene has the mirrored
/// image to the bit. Not so with triangles, whose shear has an order of axes.
SceneDescription flippable_scene(bool swappable) {
    SceneDescription scene = empty_scene();
    scene.ambient = {0.1, 0.2, 0.3};
    scene.background = {0.2, 0.1, 0.4};
    scene.frame = FrameOfReference{{0, 0, 0}, -3, {}};
    const int clear = add_material(scene, {.specular = 0.5,
                                           .reflection = 0.2,
                                           .transmission = 0.7,
                                           .tint = {1, 0.5, 0.25},
                                           .index = 1.5,
                                           .absorption = {0.1, 0.2, 0.3},
                                           .fresnel = true});
    const int shiny = add_material(scene, {.color = {0.9, 0.6, 0.3}, .specular = 0.4, .reflection = 0.5});
    const PlatonicSolid round = swappable ? PlatonicSolid::octahedron : PlatonicSolid::icosahedron;
    const PlatonicSolid other = swappable ? PlatonicSolid::cube : PlatonicSolid::dodecahedron;
    add_object(scene, solid_object(PlatonicSolid::cube, {0, 0, -6}, 8), shiny);  // the ground
    add_object(scene, solid_object(round, {0.5, 0.25, 0.375}, 1.25), clear);
    add_object(scene, solid_object(other, {-1.5, 1.75, 0.125}, 1), shiny);
    add_object(scene, solid_object(other, {-1.25, -1.5, 0.25}, 1.125), clear);
    scene.lights.push_back(
        {.position = {2, -1.5, 2.5}, .color = {4, 3, 2}, .glow = glm::dvec3(0.9), .radius = 0.25, .falloff = true});
    add_light(scene, {-3, 2, 4});
    return scene;
}
void flipped_images(Stage& stage, Tally& tally) {
    const int width = stage.quick ? 48 : 320;
    const int height = stage.quick ? 32 : 200;
    for (const bool swappable : {false, true}) {
        SceneDescription scene = flippable_scene(swappable);
        // In the plane of x and z the axes of the camera are exact when x and y are swapped.
        scene.camera.position = swappable ? glm::dvec3(5, 0, 2.5) : glm::dvec3(4.5, -3.25, 2.5);
        const FrameSettings settings = frame_of(width, height, 1, 6);
        const Film expected = stage.render(scene, settings);
        tally.witness(shows_something(expected));
        for (uint32_t map = 1; map < (swappable ? 16u : 8u); ++map) {
            SceneDescription other = scene;
            for_each_point(other, [=](glm::dvec3& p) { p = mapped(p, map); });
            other.camera.up = mapped(scene.camera.up, map);
            const Film found = stage.render(other, settings);
            // Each flip, and the swap, turns the picture's right into its left.
            const bool turned = ((map & 1u) + (map >> 1 & 1u) + (map >> 2 & 1u) + (map >> 3 & 1u)) % 2 != 0;
            for_each_pixel(expected, [&](size_t i, int x, int y) {
                const PixelRecord& a = expected.pixels[i];
                PixelRecord b = found.pixels[size_t(y * width + (turned ? width - 1 - x : x))];
                const Vec3<float> normal = mapped(Vec3<float>(a.normal[0], a.normal[1], a.normal[2]), map);
                bool same = true;
                for (int c = 0; c < 3; ++c) same &= b.normal[c] == normal[c], b.normal[c] = a.normal[c];
                tally.place = place_of(swappable, map, i);
                tally.expect(same && found.flags == 0 && same_pixel(a, b));
            });
        }
    }
}

// ---- bright and dim scenes: radiances are scaled by a power of two to their bound, and exceeding it is reported

/// What lights and is seen, times 2^light; the colors of surfaces times 2^color. Where the two differ, what is seen
/// without a surface stays (lights of their own radiance, background), and there are no highlights, which colors do not
/// dim.
void brighten(SceneDescription& scene, int light, int color) {
    const double l = std::ldexp(1.0, light);
    const double s = std::ldexp(1.0, light + color);
    const auto scale_light = [&](glm::dvec3& emitted, std::optional<glm::dvec3>& glow) {
        glow = glow.value_or(emitted) * s;
        emitted *= l;
    };
    for (LightDescription& each : scene.lights) scale_light(each.color, each.glow);
    for (ObjectDescription& object : scene.objects)
        if (auto* solid = std::get_if<SolidObject>(&object.shape))
            scale_light(solid->edge_lights.color, solid->edge_lights.glow);
    for (MaterialDescription& m : scene.materials) {
        m.color *= std::ldexp(1.0, color);
        if (color != 0) m.specular = 0;
    }
    scene.ambient *= l;
    scene.background *= s;
    if (scene.sky) {
        scene.sky->scale *= s;
        for (SkyColor& stop : scene.sky->stops) stop.color *= s;
    }
    scene.cutoff *= s;
    if (scene.frame && scene.frame->bound) *scene.frame->bound *= s;
}

/// Whether anything emits light; without that there is no bound to scale by.
bool shines(const SceneDescription& scene) {
    const Vec3<double> bound = compile_scene<double>(scene)->view().bound;
    return bound.x + bound.y + bound.z > 0;
}

/// Whether no light is so faint relative to the bound, which becomes 1, that the type keeps fewer of its digits.
template <class Real>
bool keeps_digits(const SceneDescription& scene) {
    const auto compiled = compile_scene<Real>(scene);
    const auto kept = [](const Vec3<Real>& a) {
        constexpr Real least_normal = std::numeric_limits<Real>::min();
        return (a.x == 0 || a.x >= least_normal) && (a.y == 0 || a.y >= least_normal) &&
               (a.z == 0 || a.z >= least_normal);
    };
    const SceneView<Real> view = compiled->view();
    return std::all_of(view.lights.begin(), view.lights.end(), [&](const auto& l) { return kept(l.intensity); }) &&
           std::all_of(view.materials.begin(), view.materials.end(), [&](const auto& m) { return kept(m.ambient); });
}

void brightness(Stage& stage, Tally& tally) {
    for_each_scene(stage, 150, 12, [&](uint64_t seed, const SceneDescription& scene) {
        if (!shines(scene)) return false;
        const Film expected = stage.render(scene, generated_settings(scene));
        tally.witness(shows_something(expected));
        const int most = 100 - expected.radiance_exponent;  // the bound is above half of 2^100 then
        for (const int k : {-99, -50, -1, 33, most, most + 1}) {
            SceneDescription bright = scene;
            brighten(bright, k, 0);
            try {
                const Film film = stage.render(bright, generated_settings(bright));
                expect_same(tally, film, expected, seed, uint64_t(k + 100), 1, k);
                tally.expect(stage.in_double() || k <= most);
            } catch (const Error& error) {
                tally.expect(!stage.in_double() && k > most && error.kind() == ErrorKind::scene);
            }
        }
        return true;
    });
}

/// Colors of 1e-30 under lights of 1e30, and vice versa.
void colors_against_lights(Stage& stage, Tally& tally) {
    for_each_scene(stage, 150, 12, [&](uint64_t seed, SceneDescription scene) {
        for (MaterialDescription& m : scene.materials) m.specular = 0;
        const Film expected = stage.render(scene, generated_settings(scene));
        tally.witness(shows_something(expected));
        for (const int k : {-99, -31, 60, 99}) {
            SceneDescription other = scene;
            brighten(other, k, -k);
            if (!(stage.in_double() ? keeps_digits<double>(other) : keeps_digits<float>(other))) continue;
            expect_same(tally, stage.render(other, generated_settings(other)), expected, seed, uint64_t(k + 100));
        }
        return true;
    });
}

/// Radiances equal those of the scene, from the smallest to the largest; and scenes that reach their bound.
template <class Real>
void extreme_radiance(Stage& stage, Tally& tally) {
    for (const double value : {1e-30, 1e-10, 1.0, 1e10, 1e30}) {
        SceneDescription scene = empty_scene();
        scene.background = {value, value / 3, 0};
        ++tally.place;
        const Film film = stage.render(scene, frame_of(1, 1));
        const int64_t* sums = film.pixels.radiance(0).radiance;
        const auto shown = [&](int c) { return resolve<Real>(sums[c], film.fixed_shift, 1, film.radiance_exponent); };
        tally.expect(film.flags == 0 && shown(0) == Real(value) && shown(1) == Real(value / 3) && shown(2) == 0);
    }
    // Straight down at a plane, lights over the camera: N.L = R.V = 1, all that the bound counts. Of each number a
    // few u are lost: lengths, products and dots of N.L (4 u), R.V (8 u), shares and sums (4 u); and what the sums
    // truncate, a unit a number, of a pixel that is more than 1/4.
    for (const int lights : {1, 7, 300})
        for (const double value : {1e-30, 1.0, 1e27})
            for (const int k : {1, 64}) {
                if (k > 1 && lights > 7) continue;
                ++tally.place;
                SceneDescription scene = half_plane({1, 0, 2}, 1, false);
                scene.materials[0] = {.name = "m", .color = glm::dvec3(1), .specular = 1, .exponent = 1};
                scene.ambient = glm::dvec3(value);
                scene.camera.field_of_view = 1e-6;
                for (int n = 0; n < lights; ++n) add_light(scene, {0, 0, 5}).color = glm::dvec3(value);
                const Film film = stage.render(scene, frame_of(1, 1, k));
                const int64_t sum = film.pixels[0].radiance[0];
                const double shown =
                    resolve<double>(sum, film.fixed_shift, uint32_t(film.samples), film.radiance_exponent);
                const double truncated = std::ldexp(4.0 * (1 + lights), -film.fixed_shift);
                const double share = shown / (value * (1 + 2 * lights));
                tally.expect(film.flags == 0 && sum > 0 && sum < int64_t(1) << 62 &&
                             magnitude(share - 1) <= 16 * stage.unit() + truncated);
            }
}
/// Radiances that exceed the range of the sums: such scenes are rejected when read; if that is bypassed, a flag makes
/// the render fail.
bool refused(Stage& stage, const SceneDescription& scene) {
    try {
        return (stage.render(scene, frame_of(3, 3)).flags & flag_not_finite) != 0;
    } catch (const Error& error) {
        return error.kind() == ErrorKind::scene;
    }
}
void expect_refusals(Stage& stage, Tally& tally) {
    SceneDescription scene = empty_scene();
    scene.materials[0].color = glm::dvec3(1);
    add_object(scene, solid_object(PlatonicSolid::cube));
    const SceneDescription plain = scene;
    const double largest = stage.in_double() ? 0x1p127 : 0x1p100;  // what a bound may be
    const auto expect = [&](bool is_refused, const auto& change) {
        scene = plain;
        change();
        tally.expect(refused(stage, scene) == is_refused);
    };
    for (const double value : {largest, 2 * largest, 0x1p1000, double(INFINITY), double(NAN)}) {
        ++tally.place;
        expect(true, [&] { scene.background.y = value; });
        expect(true, [&] { scene.ambient.x = value; });
        expect(true, [&] { add_light(scene, {3, 3, 3}).color.z = value; });
        expect(true, [&] {
            for (int i = 0; i < 2; ++i) add_light(scene, {3, 3, 3}).color.z = value / 2;  // in sum
        });
    }
    expect(false, [&] { scene.background = glm::dvec3(largest / 2); });
    expect(true, [&] {
        scene.background = glm::dvec3(1);
        scene.frame = FrameOfReference{{0, 0, 0}, -1, 0.5};  // pinned, and too low
    });
}

template <class Real>
void expect_flags(Stage& stage, Tally& tally) {
    const Real infinite = RealTraits<Real>::infinity;
    SceneDescription scene = empty_scene();
    add_object(scene, solid_object(PlatonicSolid::cube));
    for (const bool at_surface : {false, true})
        for (const int k : {1, 3, 64})
            for (const Real value : {Real(1), Real(1) + 2 * RealTraits<Real>::unit, Real(2), Real(4), Real(0x1p66),
                                     RealTraits<Real>::largest, infinite, infinite - infinite, Real(-0x1p-20)}) {
                Compiled<Real> compiled = compile_scene<Real>(scene);
                // Two channels are legal: what the third does must not reach them.
                const Vec3<Real> radiance(Real(1), value, Real(0.5));
                compiled->background = at_surface ? Vec3<Real>(Real(0)) : radiance;
                compiled->materials[0].color = Vec3<Real>(Real(1));
                compiled->materials[0].ambient = at_surface ? radiance : Vec3<Real>(Real(0));
                scene.camera.field_of_view = at_surface ? 5 : 60;
                scene.camera.target = at_surface ? glm::dvec3(0) : glm::dvec3(0, -9, 2);
                const std::unique_ptr<Renderer> renderer = renderers<Real>(stage.intersector)[0](compiled);
                const Film film = film_by(*renderer, scene, frame_of(1, 1, k));
                const int64_t all = int64_t(film.samples) << film.fixed_shift;
                const int64_t* sums = film.pixels.radiance(0).radiance;
                const bool legal = value == Real(1);
                tally.place = place_of(at_surface, uint64_t(k), 0);
                tally.expect((film.flags == 0) == legal && (legal || (film.flags & flag_not_finite) != 0) &&
                             sums[0] == all && sums[1] == (legal ? all : 0) && sums[2] == all / 2);
            }
}
/// The one of two functions that is for the stage's precision.
auto by_precision(void (*in_float)(Stage&, Tally&), void (*in_double)(Stage&, Tally&)) {
    return [=](Stage& stage, Tally& tally) { (stage.in_double() ? in_double : in_float)(stage, tally); };
}

}  // namespace
}  // namespace metamorphic

void add_metamorphic(Cases& cases) {
    using namespace metamorphic;
    const Bound pixels = no_failures("pixels", needs_witness);
    const Bound rays = no_failures("rays", needs_witness);
    cases.images("more-effects", "sums, ids and normals with any larger set of effects switched on", pixels,
                 more_effects);
    cases.images("one-hash", "the plain loop's image, by every tree, instruction set, device and order",
                 no_failures("images"), by_precision(one_hash<float>, one_hash<double>));
    cases.images("threads-tiles-crops", "sums, ids and normals for any number of threads, lanes, tile and crop",
                 no_failures("pixels"), threads_and_tiles);
    cases.images("scaled-by-powers-of-two", "sums, ids and normals at 2^-40 to 2^40 times the size; Z times 2^k",
                 pixels, powers_of_two);
    cases.images("dyadic-translation", "hits and ids after an exact translation of up to 2^30 sizes", pixels,
                 translated(false));
    cases.images("dyadic-translation/images", "sums, ids, normals and Z, where M is that of a corner on the grid",
                 pixels, translated(true));
    cases.images("dyadic-translation/meshes", "sums, ids, normals and Z of meshes, whose frame is found where they are",
                 pixels, found_center);
    cases.rays<Flips>("flips/planes", "crossings and their t for flipped axes and x, y swapped", rays,
                      [](Plan& plan) { plan_flips(plan, Shape::planes); });
    cases.rays<Flips>("flips/triangles", "number and kind of the crossings for flipped axes and x, y swapped", rays,
                      [](Plan& plan) { plan_flips(plan, Shape::triangles); });
    cases.images("flips/images", "sums and Z of mirrored pixels, in scenes of planes", pixels, flipped_images);
    add_samples(cases);
    cases.images("brightness", "sums, ids and ledgers, 2^-99 times as bright to bounds of 2^100; float ends there",
                 pixels, brightness);
    cases.images("brightness/colors-against-lights",
                 "sums, ids and ledgers: lights times 2^k, colors times 2^-k, k to 99, while lights are normal numbers",
                 pixels, colors_against_lights);
    cases.images("brightness/extremes", "backgrounds of 1e-30 to 1e30; the bound, met by as many lights as you like",
                 no_failures("images"), by_precision(extreme_radiance<float>, extreme_radiance<double>));
    cases.images("brightness/overflow", "what exceeds the bound is an error or a flag, and never in the sums",
                 no_failures("images"), [](Stage& stage, Tally& tally) {
                     expect_refusals(stage, tally);
                     by_precision(expect_flags<float>, expect_flags<double>)(stage, tally);
                 });
}

}  // namespace cistula::verify
