// Where the time goes: before and after the pixels, by path depth, over the picture, and by effect.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/timing.h"
#include "cistula/model/effects.h"
#include "image.h"
#include "image/exr/exr.h"
#include "measure.h"
#include "render/record/film_picture.h"
#include "render/record/frame_header.h"
#include "scene/compile/materials/required_effects.h"
#include "small_frame.h"

namespace cistula::report {
namespace {

/// A temporary file, removed by the destructor.
class ScratchFile {
  public:
    ScratchFile()
        : path_((std::filesystem::temp_directory_path() / fmt::format("render-report-{}.exr", getpid())).string()) {}
    ~ScratchFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    const std::string& path() const { return path_; }

  private:
    const std::string path_;
};

Rays minus(const Rays& a, const Rays& b) {
    Rays rays;
    rays.primary = a.primary - b.primary;
    rays.reflected = a.reflected - b.reflected;
    rays.transmitted = a.transmitted - b.transmitted;
    rays.shadow = a.shadow - b.shadow;
    return rays;
}

}  // namespace

void measure_stages(Frames& frames, const MeasureSettings& settings, SceneRecord& scene) {
    frames.progress.begin(scene.name + ": stages", settings.repetitions + 2);
    Film film;
    for (const Precision precision : {Precision::single_, Precision::double_}) {
        Setting setting = scene.base;
        setting.precision = precision;
        const auto seconds = frames.render_within(settings.of_reference(), setting, film);
        if (!seconds)
            throw Error(ErrorKind::failed,
                        fmt::format("{}: a frame of the scene's own depth, {}, does not get on within {:g} seconds; "
                                    "give it less depth, or a larger --limit",
                                    scene.file, setting_name(setting), settings.of_reference().still));
        scene.stages.push_back({"first frame", precision_name(precision), {{*seconds * 1e3}}});
        frames.progress.advance();
    }
    for (const Stage& stage : frames.renderers.stages()) scene.stages.push_back(stage);
    Timing encode;
    const ScratchFile file;
    for (int i = 0; i < settings.repetitions; ++i) {
        check_interrupt(frames.progress);
        encode.runs.push_back(1e3 * seconds_of([&] {
                                  LayeredPicture picture = to_layers(film, {});
                                  picture.attributes.merge(header_attributes(
                                      scene.hash, frame_settings(scene.base, frames.width, frames.height),
                                      Precision::double_, frames.camera));
                                  write_exr(file.path(), picture);
                              }));
        frames.progress.advance();
    }
    scene.stages.push_back({"encode", "float", encode});
}

void measure_levels(Frames& frames, const MeasureSettings& settings, SceneRecord& scene) {
    const int depths = std::min(scene.base.depth, settings.quick ? 8 : 32);
    frames.progress.begin(scene.name + ": rays by depth", depths);
    Rays before;
    Film film;
    for (int depth = 1; depth <= depths; ++depth) {
        Setting setting = scene.base;
        setting.depth = depth;
        const double seconds = frames.render(setting, film);
        const Rays rays(film.rays);
        scene.levels.push_back({depth, minus(rays, before)});
        before = rays;
        frames.progress.advance();
        if (seconds > settings.limit) break;
    }
    // The picture of costs is rendered at the size in which it is displayed.
    const auto [width, height] = small_size(frames.width, frames.height);
    frames.render(frames.renderers.of(scene.base), frame_settings(scene.base, width, height), film);
    std::vector<double> costs;
    for (size_t i = 0; i < film.pixels.size(); ++i) costs.push_back(film.pixels.sight(i).rays);
    for (const double cost : costs) {
        scene.heat_mean += cost / static_cast<double>(costs.size());
        scene.heat_most = std::max(scene.heat_most, cost);
    }
    scene.heat = to_heat_image(width, height, costs);
}

void measure_masks(Frames& frames, const MeasureSettings& settings, SceneRecord& scene) {
    const uint32_t required = frames.renderers.single()->effects;
    const int least = least_mask(required);
    for (int i = least; i < effect_mask_count; ++i)
        scene.effect_costs.push_back({effect_masks[i], names_of_effects(effect_masks[i] & ~effect_masks[least]), {}});
    const int rounds = settings.warm_ups + settings.repetitions;
    frames.progress.begin(scene.name + ": effects", rounds * static_cast<double>(scene.effect_costs.size()));
    Film film;
    for (int round = 0; round < rounds; ++round)
        for (MaskCost& cost : scene.effect_costs) {
            const double seconds = frames.render(scene.base, film, cost.mask);
            if (round >= settings.warm_ups) cost.time.runs.push_back(frames.kernel_ms(scene.base, seconds));
            frames.progress.advance();
        }
}

}  // namespace cistula::report
