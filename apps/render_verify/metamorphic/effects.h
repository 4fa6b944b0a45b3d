// Effects that a scene does not use are left out at compile time; including them changes no bit.
#pragma once

#include "apps/render_verify/metamorphic/films.h"
#include "scene/compile/compiled_scene.h"

namespace cistula::verify::metamorphic {

struct MoreEffects {
    static constexpr const char* name = "metamorphic/more-effects";
    static constexpr const char* exact = "sums, ids and normals with any larger set of effects switched on";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        int left = stage.quick ? 24 : 80;
        for (uint64_t seed = 0; seed < generated_scene_count && left > 0; ++seed) {
            const SceneDescription scene = small_scene(seed);
            if (stage.quick && is_heavy(scene)) continue;
            const uint32_t required = compile_scene<float>(scene)->effects;
            const int least = least_mask(required);
            if (least == effect_mask_count - 1) continue;  // runs with all of them anyway
            --left;
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
        }
    }
};

}  // namespace cistula::verify::metamorphic
