// The effects a scene may call for, as bits, and the compile-time masks that leave the rest out.
#pragma once

#include <type_traits>

#include "cistula/numerics/vec.h"

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
    effect_tint = 1u << 12,             // what passes a face keeps a share that differs between colors
    effect_solids = 1u << 13,           // convex ones, which are planes
    effect_triangles = 1u << 14,        // of meshes and sheets
    effect_insides = 1u << 15,          // rays inside of closed solids
    effect_lights_on_faces = 1u << 16,  // a lamp lies on a face, an edge perhaps: half-spaces tell its shadows
};
inline constexpr int effect_count = 17;
inline constexpr uint32_t all_effects = (1u << effect_count) - 1;

/// The names that --explain, --stats and the documentation use, in the order of the bits.
inline constexpr const char* effect_names[effect_count] = {
    "texture",      "diffuse",    "specular",  "opaque-shadows", "transparent-shadows", "reflection",
    "transmission", "refraction", "fresnel",   "absorption",     "visible-lights",      "light-falloff",
    "tint",         "solids",     "triangles", "insides",        "lights-on-faces"};

/// The effects that are compiled in; `if constexpr (E::has(...))` removes the others.
template <uint32_t Mask>
struct Effects {
    static constexpr uint32_t mask = Mask;
    CISTULA_HD static constexpr bool has(uint32_t effects) { return (Mask & effects) != 0; }

    /// Kinds of primitives: who names neither means both.
    static constexpr bool solids = has(effect_solids) || !has(effect_triangles);
    static constexpr bool triangles = has(effect_triangles) || !has(effect_solids);
};

/// What is left of light after some bounces: a share per color, or one for all where no color is treated apart.
template <class Real, class E>
using Share = std::conditional_t<E::has(effect_tint | effect_absorption), Vec3<Real>, Real>;

/// Bodies that light falls on and passes by; mirrors too.
inline constexpr uint32_t opaque_bodies =
    effect_diffuse | effect_specular | effect_opaque_shadows | effect_solids | effect_texture | effect_triangles;
inline constexpr uint32_t mirrors = opaque_bodies | effect_reflection;
/// Bodies through which light goes straight on, all colors alike.
inline constexpr uint32_t clear_bodies = mirrors | effect_transparent_shadows | effect_transmission | effect_insides;

/// The masks that are instantiated, each a superset of what some common kind of scene needs, ordered by size
/// (docs/effects.md).
inline constexpr uint32_t effect_masks[] = {
    opaque_bodies,
    mirrors,
    clear_bodies,
    clear_bodies | effect_visible_lights | effect_tint | effect_lights_on_faces,
    all_effects,
    all_effects &
        ~(effect_opaque_shadows | effect_transparent_shadows),  // never the least: to measure what shadows cost
};
inline constexpr int compiled_mask_count = sizeof(effect_masks) / sizeof(effect_masks[0]);
inline constexpr int unshadowed_mask = compiled_mask_count - 1;
/// Masks that scenes run with; the last is all_effects.
inline constexpr int effect_mask_count = unshadowed_mask;

/// The index in effect_masks of the least mask that contains `required`.
constexpr int least_mask(uint32_t required) {
    for (int i = 0; i < effect_mask_count; ++i)
        if ((required & ~effect_masks[i]) == 0) return i;
    return effect_mask_count - 1;
}

}  // namespace cistula
