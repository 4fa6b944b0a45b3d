// The image does not depend on threads, lanes, tiles, crops, trees, instruction sets, the order of primitives, or
// devices.
#pragma once

#include <tbb/global_control.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <utility>

#include "apps/render_verify/metamorphic/films.h"
#include "backend_embree/embree/embree_renderer.h"
#include "render/record/film_difference.h"
#include "scene/compile/compiled_scene.h"
#include "sequence/backends.h"
#include "testing/reference_renderers.h"

namespace cistula::verify::metamorphic {

template <class Real>
using Compiled = std::shared_ptr<CompiledScene<Real>>;

inline Film film_by(Renderer& renderer, const SceneDescription& scene, const FrameSettings& settings) {
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

/// Numbers of generated scenes for these cases: few primitives and many, planes and meshes.
inline std::vector<uint64_t> some_seeds(bool quick, size_t in_full, size_t in_quick) {
    std::vector<uint64_t> seeds;
    for (uint64_t seed = 0; seed < generated_scene_count && seeds.size() < (quick ? in_quick : in_full); ++seed)
        if (!quick || !is_heavy(small_scene(seed))) seeds.push_back(seed);
    return seeds;
}

struct OneHash {
    static constexpr const char* name = "metamorphic/one-hash";
    static constexpr const char* exact = "the plain loop's image, by every tree, instruction set, device and order";
    static constexpr Bound bound = no_failures("images");

    static void render(Stage& stage, Tally& tally) {
        stage.in_double() ? compare<double>(stage, tally) : compare<float>(stage, tally);
    }

    template <class Real>
    static void compare(Stage& stage, Tally& tally) {
        for (const uint64_t seed : some_seeds(stage.quick, 200, 12)) {
            const SceneDescription scene = small_scene(seed);
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
        }
    }
};

struct ThreadsAndTiles {
    static constexpr const char* name = "metamorphic/threads-tiles-crops";
    static constexpr const char* exact = "sums, ids and normals for any number of threads, lanes, tile and crop";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        for (const uint64_t seed : some_seeds(stage.quick, 40, 6)) {
            const SceneDescription scene = small_scene(seed);
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
                        part.pixels.set(size_t(y * crop.width + x),
                                        whole.pixels[size_t((crop.y + y) * 24 + crop.x + x)]);
                expect_same(tally, stage.render(scene, settings), part, seed, variation++);
            }
        }
    }
};

}  // namespace cistula::verify::metamorphic
