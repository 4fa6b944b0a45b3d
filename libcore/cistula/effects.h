// The effects a scene may call for, as bits, and the compile-time masks that leave the rest out.
#pragma once

#include "cistula/portable.h"

namespace cistula {

enum Effect : uint32_t {
    effect_texture = 1u << 0,
    effect_diffuse = 1u << 1,
    effect_specular = 1u << 2,
    effect_opaque_shadows = 1u << 3,       // something stops light altogether
    effect_transparent_shadows = 1u << 4,  // something lets a share of it through
    effect_reflection = 1u << 5,
    effect_transmission = 1u << 6,  // rays that pass through a face (kt > 0)
    effect_refraction = 1u << 7,    // ... and bend there
    effect_fresnel = 1u << 8,
    effect_absorption = 1u << 9,
    effect_visible_lights = 1u << 10,
    effect_light_falloff = 1u << 11,
};
inline constexpr int effect_count = 12;
inline constexpr uint32_t all_effects = (1u << effect_count) - 1;

/// The names that --explain, --stats and the documentation use, in the order of the bits.
inline constexpr const char* effect_names[effect_count] = {
    "texture",      "diffuse",    "specular", "opaque-shadows", "transparent-shadows", "reflection",
    "transmission", "refraction", "fresnel",  "absorption",     "visible-lights",      "light-falloff"};

/// The effects that are compiled in; `if constexpr (E::has(...))` removes the others.
template <uint32_t Mask>
struct Effects {
    static constexpr uint32_t mask = Mask;
    CISTULA_HD static constexpr bool has(uint32_t effects) { return (Mask & effects) != 0; }
};

/// The masks that are instantiated, each a superset of what some common kind of scene needs, ordered by size.
inline constexpr uint32_t effect_masks[] = {
    effect_diffuse | effect_specular | effect_opaque_shadows | effect_texture,
    effect_diffuse | effect_specular | effect_opaque_shadows | effect_texture | effect_reflection |
        effect_transparent_shadows | effect_transmission,
    effect_diffuse | effect_specular | effect_opaque_shadows | effect_texture | effect_reflection |
        effect_transparent_shadows | effect_transmission | effect_visible_lights | effect_light_falloff,
    all_effects,
};
inline constexpr int effect_mask_count = sizeof(effect_masks) / sizeof(effect_masks[0]);

/// The index in effect_masks of the least mask that contains `required`.
constexpr int least_mask(uint32_t required) {
    for (int i = 0; i < effect_mask_count; ++i)
        if ((required & ~effect_masks[i]) == 0) return i;
    return effect_mask_count - 1;
}

}  // namespace cistula
