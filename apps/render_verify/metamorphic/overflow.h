// Radiances that exceed the range of the sums.
#pragma once

#include "apps/render_verify/metamorphic/films.h"
#include "apps/render_verify/metamorphic/one_hash.h"
#include "base/error.h"

namespace cistula::verify::metamorphic {

/// Such scenes are rejected when read; if that is bypassed, a flag makes the render fail.
struct OverflowIsSaid {
    static constexpr const char* name = "metamorphic/brightness/overflow";
    static constexpr const char* exact = "what exceeds the bound is an error or a flag, and never in the sums";
    static constexpr Bound bound = no_failures("images");

    static bool refused(Stage& stage, const SceneDescription& scene) {
        try {
            return (stage.render(scene, frame_of(3, 3)).flags & flag_not_finite) != 0;
        } catch (const Error& error) {
            return error.code() == ExitCode::usage;
        }
    }
    static void expect_refusals(Stage& stage, Tally& tally) {
        SceneDescription scene = empty_scene();
        scene.materials[0].color = glm::dvec3(1);
        add_object(scene, solid_object(PlatonicSolid::cube));
        const SceneDescription plain = scene;
        const double largest = stage.in_double() ? 0x1p127 : 0x1p100;  // what a bound may be
        for (const double value : {largest, 2 * largest, 0x1p1000, double(INFINITY), double(NAN)}) {
            ++tally.place;
            scene = plain;
            scene.background.y = value;
            tally.expect(refused(stage, scene));
            scene = plain;
            scene.ambient.x = value;
            tally.expect(refused(stage, scene));
            scene = plain;
            add_light(scene, {3, 3, 3}).color.z = value;
            tally.expect(refused(stage, scene));
            scene = plain;
            for (int i = 0; i < 2; ++i) add_light(scene, {3, 3, 3}).color.z = value / 2;  // in sum
            tally.expect(refused(stage, scene));
        }
        scene = plain;
        scene.background = glm::dvec3(largest / 2);
        tally.expect(!refused(stage, scene));
        scene = plain;
        scene.background = glm::dvec3(1);
        scene.frame = FrameOfReference{{0, 0, 0}, -1, 0.5};  // pinned, and too low
        tally.expect(refused(stage, scene));
    }

    template <class Real>
    static void expect_flags(Stage& stage, Tally& tally) {
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
    static void render(Stage& stage, Tally& tally) {
        expect_refusals(stage, tally);
        stage.in_double() ? expect_flags<double>(stage, tally) : expect_flags<float>(stage, tally);
    }
};

}  // namespace cistula::verify::metamorphic
