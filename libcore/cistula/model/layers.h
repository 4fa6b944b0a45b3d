// Layers of a film: parts that a pixel's radiance is divided into, which add up to it, and what its samples meet first.
#pragma once

#include "cistula/model/pixel_record.h"

namespace cistula {

/// What a contribution to a pixel comes from, other than a point light.
enum class LightSource { background, visible_light, ambient };

/// The parts of a pixel's radiance by the way that light takes: what the first surface adds itself, and what comes in
/// through the ray that it mirrors and the one that it transmits.
enum class PathLayer : int {
    emission,    // visible lights that the primary ray meets
    background,  // that it meets
    ambient,     // of the first surface, like the next two
    diffuse,
    specular,
    reflection,    // all that the mirrored ray brings
    transmission,  // all that the transmitted ray brings
};
inline constexpr int path_layer_count = 7;

/// The parts of a pixel's radiance by where light comes from. Those of light groups follow.
enum class LightLayer : int {
    ambient,
    environment,  // the background, however it is seen
    glow,         // visible lights, however they are seen
};
inline constexpr int common_light_layers = 3;

/// The maximum number of a scene's light groups.
inline constexpr int most_light_groups = 64;

/// What the sample that gives a pixel's id meets first. All zero: nothing.
struct FirstHit {
    double position[3];  // in the scene's frame
    float uv[2];         // texture coordinates; 0 where the material has no texture
    float albedo[3];     // material color times texture; 0 for visible lights
    float distance;      // along the ray from the camera, in scene units
    uint32_t material;   // 1 + material; 0 for visible lights
    uint32_t object;     // id of PixelRecord
};

/// How many samples of a pixel meet an object first: the count in the low half of a word, the object's id in the high
/// half. A pixel has a table of these; free entries are 0.
inline constexpr int object_shift = 32;

/// The place of each group of layers in a pixel's words of 64 bits, in this order; -1: not kept.
struct LayerPlan {
    int words = 0;   // of a pixel; 0: no layers
    int path = -1;   // 3 sums for each PathLayer
    int light = -1;  // 3 sums for each LightLayer and light group
    int first_hit = -1;
    int objects = -1;
    int object_entries = 0;

    /// The number of words that are sums. They come first.
    CISTULA_INLINE int sums() const { return first_hit >= 0 ? first_hit : objects >= 0 ? objects : words; }
    /// The number of words of a single sample, whose table holds one object.
    CISTULA_INLINE int sample_words() const { return objects >= 0 ? objects + 1 : words; }

    bool operator==(const LayerPlan&) const = default;
};

inline constexpr int first_hit_words = int(sizeof(FirstHit) / sizeof(int64_t));
static_assert(sizeof(FirstHit) % sizeof(int64_t) == 0);

/// The words of a pixel, or of one sample, and the number of lattice samples that the sample under way stands for; 1 in
/// a uniform grid. A negative weight takes back what was added.
struct PixelLayers {
    int64_t* words = nullptr;
    int weight = 1;
};

/// Counts `weight` samples of an object in a pixel's table. False if the table has no room for it.
CISTULA_INLINE bool count_object(int64_t* table, int entries, uint32_t object, int weight) {
    for (int i = 0; i < entries; ++i) {
        const int64_t before = claim_word(table[i], int64_t(object) << object_shift);
        if (before != 0 && uint32_t(uint64_t(before) >> object_shift) != object) continue;
        add_to_word(table[i], weight);
        return true;
    }
    return false;
}

/// Enters what a sample met first, from its own words, into its pixel's, as if it represented `weight` samples.
/// `chosen`: it gives the pixel's id. False if the pixel's table has no room for the object.
CISTULA_INLINE bool give_first_hit(const LayerPlan& plan, const int64_t* sample, int weight, bool chosen,
                                   int64_t* pixel) {
    if (plan.first_hit >= 0 && chosen)
        for (int i = plan.first_hit; i < plan.first_hit + first_hit_words; ++i) pixel[i] = sample[i];
    if (plan.objects < 0 || sample[plan.objects] == 0) return true;
    const uint32_t object = uint32_t(uint64_t(sample[plan.objects]) >> object_shift);
    return count_object(pixel + plan.objects, plan.object_entries, object, weight);
}

}  // namespace cistula
