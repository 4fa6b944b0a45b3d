// The effects that a scene may need, as bits, and the compile-time masks that leave out the code of the others.
#pragma once

#include <type_traits>

#include "cistula/numerics/vec.h"

namespace cistula {

enum Effect : uint32_t {
    effect_texture = 1u << 0,
    effect_diffuse = 1u << 1,
    effect_specular = 1u << 2,
    effect_opaque_shadows = 1u << 3,       // some material blocks light entirely
    effect_transparent_shadows = 1u << 4,  // some material transmits part of the light
    effect_reflection = 1u << 5,
    effect_transmission = 1u << 6,  // rays that pass through a face (kt > 0)
    effect_refraction = 1u << 7,    // rays bend at a face
    effect_fresnel = 1u << 8,
    effect_absorption = 1u << 9,
    effect_visible_lights = 1u << 10,
    effect_light_falloff = 1u << 11,
    effect_tint = 1u << 12,             // transmittance of a face differs between channels
    effect_solids = 1u << 13,           // convex solids, given by planes
    effect_triangles = 1u << 14,        // triangles of meshes and sheets
    effect_insides = 1u << 15,          // rays inside closed solids
    effect_lights_on_faces = 1u << 16,  // a point light lies on a face or an edge (docs/rules.md, 5)
    effect_contacts = 1u << 17,         // faces of several solids lie in one plane (docs/rules.md, 11)
    effect_spheres = 1u << 18,          // solid spheres (docs/rules.md, 14)
    effect_sky = 1u << 19,              // what rays meet that meet nothing depends on their direction
    effect_smooth = 1u << 20,           // meshes with normals at their corners (docs/rules.md, 17)
    effect_planes = 1u << 21,           // planes without end, and disks (docs/rules.md, 18)
};
inline constexpr int effect_count = 22;
inline constexpr uint32_t all_effects = (1u << effect_count) - 1;

/// A bit of masks whose code also fills the layers of a film (layers.h). No scene calls for it.
inline constexpr uint32_t fills_layers = 1u << effect_count;
/// A bit of masks whose code keeps a budget of truncation (tree_threshold.h), which a cutoff or a target error is.
inline constexpr uint32_t keeps_budget = 1u << (effect_count + 1);

/// Effect names, in the order of the bits, as in --explain, --stats and the documentation.
inline constexpr const char* effect_names[effect_count] = {
    "texture",      "diffuse",    "specular",  "opaque-shadows", "transparent-shadows", "reflection",
    "transmission", "refraction", "fresnel",   "absorption",     "visible-lights",      "light-falloff",
    "tint",         "solids",     "triangles", "insides",        "lights-on-faces",     "contacts",
    "spheres",      "sky",        "smooth",    "planes"};

/// A set of effects as a type: `if constexpr (E::has(...))` removes the code of all others.
template <uint32_t Mask>
struct Effects {
    static constexpr uint32_t mask = Mask;
    CISTULA_HD static constexpr bool has(uint32_t effects) { return (Mask & effects) != 0; }

    /// Which kinds of primitives occur, convex solids and triangles; a mask that names no kind means both.
    static constexpr bool solids = has(effect_solids | effect_spheres) || !has(effect_triangles);
    static constexpr bool triangles = has(effect_triangles) || !has(effect_solids | effect_spheres);
};

/// The effects of a mask without what only a tree of rays keeps. What the tree calls is compiled for these, once for
/// all masks that differ in a budget or layers.
template <class E>
using OnlyEffects = Effects<E::mask & all_effects>;

/// Path throughput type: one value per channel, or a single one where no effect treats channels differently.
template <class Real, class E>
using Throughput = std::conditional_t<E::has(effect_tint | effect_absorption), Vec3<Real>, Real>;

/// Mask for opaque solids with local light and shadows; `mirrors` adds reflection.
inline constexpr uint32_t opaque_bodies =
    effect_diffuse | effect_specular | effect_opaque_shadows | effect_solids | effect_texture | effect_triangles;
inline constexpr uint32_t mirrors = opaque_bodies | effect_reflection;
/// Mask for solids that transmit light straight on, all channels alike.
inline constexpr uint32_t clear_bodies = mirrors | effect_transparent_shadows | effect_transmission | effect_insides;

/// Mask for everything that flat bodies under a background of one color call for.
inline constexpr uint32_t flat_scenes = all_effects & ~(effect_spheres | effect_sky | effect_smooth | effect_planes);
/// Mask for balls and flat bodies, and for skies.
inline constexpr uint32_t ball_scenes = flat_scenes | effect_spheres | effect_sky;

/// The effect masks that are instantiated, ordered by size. Each is a superset of what some common kind of scene needs
/// (docs/effects.md).
inline constexpr uint32_t effect_masks[] = {
    opaque_bodies,
    mirrors,
    clear_bodies,
    clear_bodies | effect_visible_lights | effect_tint | effect_lights_on_faces,
    flat_scenes,
    ball_scenes,
    all_effects,
    all_effects | keeps_budget,
    all_effects | keeps_budget | fills_layers,
};
inline constexpr int compiled_mask_count = sizeof(effect_masks) / sizeof(effect_masks[0]);
inline constexpr int layered_mask = compiled_mask_count - 1;
inline constexpr int limited_mask = compiled_mask_count - 2;
/// The number of masks that scenes are rendered with, without a budget and layers; the last of them is all_effects.
inline constexpr int effect_mask_count = limited_mask;
static_assert(effect_masks[effect_mask_count - 1] == all_effects);
inline constexpr int ball_mask = effect_mask_count - 2;
static_assert(effect_masks[ball_mask] == ball_scenes);
/// The index in effect_masks of the smallest mask that contains `required`.
constexpr int least_mask(uint32_t required) {
    for (int i = 0; i < effect_mask_count; ++i)
        if ((required & ~effect_masks[i]) == 0) return i;
    return effect_mask_count - 1;
}

/// The masks that the CPU's tiles in lanes are compiled for, as indices of effect_masks. On a CPU lesser ones are
/// hardly quicker, and that of balls no quicker than all effects.
inline constexpr int lane_masks[] = {ball_mask - 3, ball_mask - 2, ball_mask - 1, ball_mask + 1};
inline constexpr int lane_mask_count = sizeof(lane_masks) / sizeof(lane_masks[0]);
static_assert(lane_masks[lane_mask_count - 1] == effect_mask_count - 1);

/// The place in lane_masks of the least that contains one of effect_masks.
constexpr int least_lane_mask(int mask) {
    int place = 0;
    while (lane_masks[place] < mask) ++place;
    return place;
}

}  // namespace cistula
