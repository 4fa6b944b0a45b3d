// What must hold of a film's layers, whoever rendered it.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "render/record/film.h"
#include "render/record/film_picture.h"

namespace cistula::test {

/// All layers that there are.
inline LayerRequest all_layers() {
    LayerRequest request;
    request.path = request.light = request.first_hit = request.objects = true;
    return request;
}

/// The sums of `layers` layers from word `place` of a pixel on, channel c.
inline int64_t sum_of_layers(const int64_t* words, int place, int layers, int c) {
    int64_t sum = 0;
    for (int layer = 0; layer < layers; ++layer) sum += words[place + 3 * layer + c];
    return sum;
}

/// The first pixel whose layers do not add up to it, or that has a negative one, in words; empty if all do.
inline std::string first_fault_of_layers(const Film& film) {
    const FilmLayers& layers = film.layers;
    const LayerPlan& plan = layers.plan;
    const int light_layers = common_light_layers + int(layers.names->light_groups.size());
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelRecord& pixel = film.pixels[i];
        const int64_t* words = layers.of(i);
        const std::string where = "pixel " + std::to_string(i);
        for (int c = 0; c < 3; ++c) {
            if (sum_of_layers(words, plan.path, path_layer_count, c) != pixel.radiance[c]) return where + ": by path";
            if (sum_of_layers(words, plan.light, light_layers, c) != pixel.radiance[c]) return where + ": by light";
        }
        for (int k = 0; k < 3 * path_layer_count; ++k)
            if (words[plan.path + k] < 0) return where + ": path word " + std::to_string(k) + " is negative";
        uint32_t met = 0;
        for (int k = 0; k < plan.object_entries; ++k) met += uint32_t(words[plan.objects + k]);
        if (met != pixel.hits) return where + ": objects of " + std::to_string(met) + " samples";
        FirstHit hit;
        std::memcpy(&hit, words + plan.first_hit, sizeof hit);
        if (hit.object != uint32_t(pixel.id)) return where + ": object " + std::to_string(hit.object);
    }
    return "";
}

/// The words of all pixels, with tables of objects in the order of their entries' bits: threads may fill a table in
/// any order.
inline std::vector<int64_t> ordered_words(const Film& film) {
    std::vector<int64_t> words(film.layers.words.begin(), film.layers.words.end());
    const LayerPlan& plan = film.layers.plan;
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const auto table = words.begin() + ptrdiff_t(i * size_t(plan.words)) + plan.objects;
        for (auto entry = table; entry != table + plan.object_entries; ++entry)
            if (uint32_t(*entry) == 0) *entry = 0;  // what was added was taken back
        std::sort(table, table + plan.object_entries);
    }
    return words;
}

}  // namespace cistula::test
