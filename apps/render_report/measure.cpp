#include "measure.h"

#include <fmt/format.h>

#include <filesystem>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/readers/read_scene.h"

namespace cistula::report {
namespace {

/// Finds the largest shares among the materials that objects use.
void find_shares(const SceneDescription& scene, SceneRecord& record) {
    for (const ObjectDescription& object : scene.objects) {
        if (object.material < 0) continue;
        const MaterialDescription& material = scene.materials[static_cast<size_t>(object.material)];
        const auto take = [&](Share& share, const char* what, double value) {
            if (value > share.value) share = {what, material.name, value};
        };
        take(record.mirror, "reflection", material.reflection);
        take(record.strongest, "reflection", material.reflection);
        // A Fresnel surface divides kr + kt by the angle.
        take(record.strongest, "transmission",
             material.fresnel ? material.reflection + material.transmission : material.transmission);
    }
}

std::string unused_name(const std::string& file, const Record& record) {
    const std::string stem = std::filesystem::path(file).stem().string();
    std::string name = stem;
    for (int n = 2;; ++n) {
        bool taken = false;
        for (const SceneRecord& scene : record.scenes) taken = taken || scene.name == name;
        if (!taken) return name;
        name = fmt::format("{}-{}", stem, n);
    }
}

}  // namespace

void measure_scene(const std::string& file, const MeasureSettings& settings, StepProgress& progress, Record& record) {
    const SceneDescription description = read_scene(file);
    SceneRecord scene;
    scene.name = unused_name(file, record);
    scene.file = file;
    scene.width = settings.width > 0 ? settings.width : description.film.width;
    scene.height = settings.height > 0 ? settings.height : description.film.height;
    scene.base.depth = description.depth;
    find_shares(description, scene);
    Frames frames(description, settings.machine, scene.width, scene.height, progress);
    scene.hash = frames.renderers.single()->hashes.of(frames.camera.frame);
    scene.effects = names_of_effects(frames.renderers.single()->effects);
    measure_stages(frames, settings, scene);
    measure_levels(frames, settings, scene);
    measure_masks(frames, settings, scene);
    measure_parity(frames, settings, scene);
    measure_sweep(frames, settings, scene, record);
    record.scenes.push_back(std::move(scene));
}

}  // namespace cistula::report
