// Bright and dim scenes: radiances are scaled by a power of two to their bound, and exceeding it is reported.
#pragma once

#include <algorithm>
#include <limits>

#include "apps/render_verify/metamorphic/films.h"
#include "apps/render_verify/metamorphic/samples.h"
#include "base/error.h"
#include "cistula/numerics/fixed_sum.h"
#include "scene/compile/compiled_scene.h"

namespace cistula::verify::metamorphic {

/// What lights and is seen, times 2^light; the colors of surfaces times 2^color. Where the two differ, what is seen
/// without a surface stays (lights of their own radiance, background), and there are no highlights, which colors do not
/// dim.
inline void brighten(SceneDescription& scene, int light, int color) {
    const double l = std::ldexp(1.0, light), s = std::ldexp(1.0, light + color);
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
    scene.cutoff *= s;
    if (scene.frame && scene.frame->bound) *scene.frame->bound *= s;
}

/// Whether anything emits light; without that there is no bound to scale by.
inline bool shines(const SceneDescription& scene) {
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

struct Brightness {
    static constexpr const char* name = "metamorphic/brightness";
    static constexpr const char* exact =
        "sums, ids and ledgers, 2^-99 times as bright to bounds of 2^100; float ends there";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        for (uint64_t seed = 0, left = stage.quick ? 12 : 150; seed < generated_scene_count && left > 0; ++seed) {
            const SceneDescription scene = small_scene(seed);
            if ((stage.quick && is_heavy(scene)) || !shines(scene)) continue;
            --left;
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
                    tally.expect(!stage.in_double() && k > most && error.code() == ExitCode::usage);
                }
            }
        }
    }
};

/// Colors of 1e-30 under lights of 1e30, and vice versa.
struct ColorsAgainstLights {
    static constexpr const char* name = "metamorphic/brightness/colors-against-lights";
    static constexpr const char* exact =
        "sums, ids and ledgers: lights times 2^k, colors times 2^-k, k to 99, while lights are normal numbers";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        for (uint64_t seed = 0, left = stage.quick ? 12 : 150; seed < generated_scene_count && left > 0; ++seed) {
            SceneDescription scene = small_scene(seed);
            if (stage.quick && is_heavy(scene)) continue;
            --left;
            for (MaterialDescription& m : scene.materials) m.specular = 0;
            const Film expected = stage.render(scene, generated_settings(scene));
            tally.witness(shows_something(expected));
            for (const int k : {-99, -31, 60, 99}) {
                SceneDescription other = scene;
                brighten(other, k, -k);
                if (!(stage.in_double() ? keeps_digits<double>(other) : keeps_digits<float>(other))) continue;
                expect_same(tally, stage.render(other, generated_settings(other)), expected, seed, uint64_t(k + 100));
            }
        }
    }
};

/// Radiances equal those of the scene, from the smallest to the largest; and scenes that reach their bound.
struct ExtremeRadiance {
    static constexpr const char* name = "metamorphic/brightness/extremes";
    static constexpr const char* exact = "backgrounds of 1e-30 to 1e30; the bound, met by as many lights as you like";
    static constexpr Bound bound = no_failures("images");

    template <class Real>
    static void compare(Stage& stage, Tally& tally) {
        for (const double value : {1e-30, 1e-10, 1.0, 1e10, 1e30}) {
            SceneDescription scene = empty_scene();
            scene.background = {value, value / 3, 0};
            ++tally.place;
            const Film film = stage.render(scene, frame_of(1, 1));
            const int64_t* sums = film.pixels.radiance(0).radiance;
            const auto shown = [&](int c) {
                return resolve<Real>(sums[c], film.fixed_shift, 1, film.radiance_exponent);
            };
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
                    MaterialDescription& m = scene.materials[0];
                    m.color = glm::dvec3(1);
                    m.specular = 1;
                    m.exponent = 1;
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
    static void render(Stage& stage, Tally& tally) {
        stage.in_double() ? compare<double>(stage, tally) : compare<float>(stage, tally);
    }
};

}  // namespace cistula::verify::metamorphic
