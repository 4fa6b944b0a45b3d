#include "render/record/film_layers.h"

namespace cistula {

LayerPlan layer_plan(const LayerRequest& request, size_t light_groups) {
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

void begin_layers(FilmLayers& layers, const LayerRequest& request, size_t pixels,
                  std::shared_ptr<const LayerNames> names) {
    layers.plan = layer_plan(request, names->light_groups.size());
    layers.words.clear();  // else a larger table would be moved
    layers.words.resize(pixels * static_cast<size_t>(layers.plan.words));
    layers.names = std::move(names);
}

}  // namespace cistula
