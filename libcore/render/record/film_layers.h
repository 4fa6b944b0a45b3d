// The layers of a film: what is asked for, what a backend fills, and the names that files give.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cistula/model/layers.h"
#include "render/record/film_memory.h"
#include "scene/compile/scene_names.h"

namespace cistula {

/// The groups of layers that a frame is rendered with.
struct LayerRequest {
    // divisions of the radiance (PathLayer, LightLayer)
    bool path = false;
    bool light = false;
    bool first_hit = false;
    bool objects = false;     // how many samples of a pixel meet which object first
    int object_entries = 16;  // in a pixel's table of objects; a film with flag_objects_overflow needs more

    bool any() const { return path || light || first_hit || objects; }
    bool operator==(const LayerRequest&) const = default;
};

/// The layers that a backend fills.
struct FilmLayers {
    LayerPlan plan;
    std::vector<int64_t, FilmAllocator<int64_t>> words;  // plan.words for each pixel
    double center[3] = {0, 0, 0}, unit_length = 1;  // a FirstHit's position in scene units: center + position * that
    std::shared_ptr<const LayerNames> names;

    /// The words of a pixel.
    int64_t* of(size_t pixel) { return words.data() + pixel * static_cast<size_t>(plan.words); }
    const int64_t* of(size_t pixel) const { return words.data() + pixel * static_cast<size_t>(plan.words); }

    /// Sets the words of pixels to 0, as they are before anything is added.
    void clear(size_t first, size_t count) { std::fill_n(of(first), count * static_cast<size_t>(plan.words), 0); }
};

/// The plan for the layers of a scene with so many light groups.
inline LayerPlan layer_plan(const LayerRequest& request, size_t light_groups) {
    LayerPlan plan;
    const auto take = [&plan](bool wanted, int words) {
        if (!wanted) return -1;
        const int place = plan.words;
        plan.words += words;
        return place;
    };
    plan.path = take(request.path, 3 * path_layer_count);
    plan.light = take(request.light, 3 * (common_light_layers + static_cast<int>(light_groups)));
    plan.first_hit = take(request.first_hit, first_hit_words);
    plan.objects = take(request.objects, request.object_entries);
    plan.object_entries = request.objects ? request.object_entries : 0;
    return plan;
}

/// Sets up layers of so many pixels, in the scene's frame, with uninitialized words.
inline void begin_layers(FilmLayers& layers, const LayerRequest& request, size_t pixels,
                         std::shared_ptr<const LayerNames> names) {
    layers.plan = layer_plan(request, names->light_groups.size());
    layers.words.clear();  // else a larger table would be moved
    layers.words.resize(pixels * static_cast<size_t>(layers.plan.words));
    layers.names = std::move(names);
}

}  // namespace cistula
