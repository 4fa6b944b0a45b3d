// Gaps that a file can tell are no contacts: glass over a floor reflects totally, whatever the gap.
#pragma once

#include "apps/render_verify/digits/contacts.h"

namespace cistula::verify::digits {

/// A block of glass, `size` large, over a floor by a share of that.
inline SceneDescription with_gap(double size, double share, bool triangles) {
    SceneDescription scene = scene_of(
        +[](SceneDescription& to, bool) { add_floor(to); }, triangles);
    const double gap = share * size;
    add_object(scene, box({-size / 2, -size / 2, gap}, {size / 2, size / 2, gap + size}, triangles), glass_material);
    scene.camera.position = dvec3(1.9, -2.6, 1.9) * size;
    scene.camera.target = dvec3(0.03, 0.02, 0.4) * size;
    scene.lights[0].position = dvec3(-3, -4, 5) * size;
    return scene;
}

template <bool is_small>
struct Apart {
    static constexpr const char* exact = "the picture of a gap larger by a sixteenth";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        for_each_rounding(stage, [&](const Writing& writing, uint64_t i) {
            const double size = is_small ? 0.05 : 1, share = i % 4 < 2 ? 1e-3 : 1e-2;
            const auto film = [&](double gap) { return written(with_gap(size, gap, i % 2 == 1), writing); };
            expect_same_picture(stage, tally, film(share), film(share * 1.0625), i);
        });
    }
};
struct Gaps : Apart<false> {
    static constexpr const char* name = "digits/gaps";
};
/// A pebble of a hundredth of its floor.
struct Hovering : Apart<true> {
    static constexpr const char* name = "digits/hovering";
};

/// Contacts that are missed: a gap in their place must be seen. And the reverse.
template <bool touches>
struct Mistaken {
    static constexpr const char* exact = "a gap in a contact's place is seen, and a contact in a gap's";
    static constexpr Bound bound = must_fail(5, "pixels");

    static void render(Stage& stage, Tally& tally) {
        expect_same_picture(stage, tally, with_gap(1, touches ? 1e-3 : 0, false),
                            with_gap(1, touches ? 0 : 1e-3, false), 0);
    }
};
struct BrokenContact : Mistaken<true> {
    static constexpr const char* name = "digits/broken/contact";
};
struct BrokenGap : Mistaken<false> {
    static constexpr const char* name = "digits/broken/gap";
};

}  // namespace cistula::verify::digits
