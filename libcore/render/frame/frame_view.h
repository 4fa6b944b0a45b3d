// The constants of a frame that every pixel needs, from its settings; shared by all backends.
#pragma once

#include "base/error.h"
#include "cistula/transport/pixel.h"
#include "cistula/transport/pixel_sums.h"
#include "render/renderer.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// Sets where a frame's rays start: at the camera, or, where it lies on faces to within 16 times the rounding of its
/// distance from their planes, 32 u M off each plane, on either side. Of more than three planes the first three count.
/// The camera's position is already in the frame, and so is `half_unit`, which rounding may have moved it by.
template <class Real>
void set_camera_sides(const CompiledScene<Real>& scene, const glm::dvec3& half_unit, FrameView& frame);

/// The parameters of adaptive sampling for a frame with a target error.
template <class Real>
void set_lattice(const CompiledScene<Real>& scene, const FrameSettings& settings, LatticeSettings& lattice) {
    const double target = min_or_second(elementary::scaled(settings.target_error, -scene.radiance_exponent), 4.0);
    lattice.target = max_or_second(int64_t(floor_of(elementary::scaled(target, color_bits))), int64_t(1));
    lattice.most = settings.max_samples;
    lattice.significant = target / 4;
}

/// The view of a frame, except the solids around the camera, which need an intersector (find_camera_solids).
template <class Real>
FrameView frame_view(const CompiledScene<Real>& scene, const CameraFrame& camera, const FrameSettings& settings) {
    const auto refuse = [](const char* key, auto value, const std::string& right) {
        throw Error(ErrorKind::usage, "", "must be " + right).of(key, std::to_string(value));
    };
    if (settings.depth < 1 || settings.depth > largest_depth)
        refuse("depth", settings.depth, "from 1 to " + std::to_string(largest_depth));
    if (settings.supersample < 1 || settings.supersample > 64)
        refuse("supersample", settings.supersample, "from 1 to 64");
    if (!(settings.cutoff >= 0)) refuse("cutoff", settings.cutoff, "at least 0");
    if (!(settings.target_error >= 0)) refuse("target_error", settings.target_error, "at least 0");
    if (settings.layers.light && scene.layer_names->light_groups.size() > size_t(most_light_groups))
        throw Error(ErrorKind::usage,
                    "light layers: the scene has " + std::to_string(scene.layer_names->light_groups.size()) +
                        " groups of lights",
                    "put lights together with \"group\", at most " + std::to_string(most_light_groups) + " groups");
    if (settings.max_samples < least_lattice_samples || settings.max_samples > lattice_samples)
        refuse("max_samples", settings.max_samples,
               "from " + std::to_string(least_lattice_samples) + " to " + std::to_string(lattice_samples));
    const double unit = elementary::power_of_two(scene.scale);
    FrameView frame;
    frame.camera = camera.camera;
    frame.camera.position = (camera.camera.position - scene.center) * unit;
    frame.unit_length = 1 / unit;
    frame.width = settings.full_width;
    frame.height = settings.full_height;
    frame.supersample = settings.grid();
    frame.half_sample = frame.camera.tan_half_width / (double(frame.width) * frame.supersample);
    frame.is_far = is_far(frame.camera.position, double(scene.extent));
    set_camera_sides(scene, coordinate_rounding({&camera.camera.position, 1}).half_unit * unit, frame);
    frame.tree.depth = settings.depth;
    const int shift = fixed_shift(uint32_t(frame.supersample * frame.supersample));
    frame.tree.fixed_scale = float(fixed_scale(shift));
    frame.tree.fixed_unit = float(fixed_scale(-shift));
    // A budget above the radiance bound prunes everything either way.
    const double budget = min_or_second(elementary::scaled(settings.truncation(), -scene.radiance_exponent), 16.0);
    frame.tree.budget = int64_t(floor_of(min_or_second(budget * fixed_scale(shift), 0x1p62)));
    frame.tree.threshold = TreeThreshold::first(frame.tree.budget, frame.tree.fixed_unit);
    if (settings.adaptive()) set_lattice(scene, settings, frame.lattice);
    frame.layers = layer_plan(settings.layers, scene.layer_names->light_groups.size());
    return frame;
}

/// Index in effect_masks of the kernel for a scene that requires `effects`. Call it after find_camera_solids: a
/// camera inside a body adds effects. Adaptive sampling runs with all effects.
inline int mask_to_run(uint32_t effects, const FrameSettings& settings, const FrameView& frame) {
    if (settings.layers.any()) return layered_mask;
    if (frame.tree.budget != 0 || settings.adaptive()) return limited_mask;
    uint32_t of_camera = 0;
    for (int i = 0; i < 1 << frame.camera_planes; ++i)
        if (!frame.camera_sides[i].media.empty()) of_camera = effect_insides;
    return least_mask(settings.effects | effects | of_camera);
}

/// Enters pixels that show only background, whose sums are known, into their layers.
inline void fill_background_layers(Film& film, size_t first, size_t count) {
    const LayerPlan& plan = film.layers.plan;
    const auto put = [&](int place, int layer, size_t pixel) {
        if (place < 0) return;
        int64_t* to = film.layers.of(pixel) + place + 3 * layer;
        for (int c = 0; c < 3; ++c) to[c] = film.pixels.radiance(pixel).radiance[c];
    };
    film.layers.clear(first, count);
    if (plan.path < 0 && plan.light < 0) return;
    for (size_t pixel = first; pixel < first + count; ++pixel) {
        put(plan.path, int(PathLayer::background), pixel);
        put(plan.light, int(LightLayer::environment), pixel);
    }
}

/// A film of the frame's size, with uninitialized pixels.
template <class Real>
void prepare_film(Film& film, const FrameSettings& settings, const CompiledScene<Real>& scene,
                  const CameraFrame& camera) {
    film.full_width = settings.full_width;
    film.full_height = settings.full_height;
    film.rect = settings.crop;
    film.radiance_exponent = scene.radiance_exponent;
    film.samples = settings.grid() * settings.grid();
    film.fixed_shift = fixed_shift(uint32_t(film.samples));
    PixelRecord nothing = {};
    TreeSettings settings_of_sums;
    settings_of_sums.fixed_scale = float(fixed_scale(film.fixed_shift));
    PixelSums<Real>(settings_of_sums, scene.view(), nothing, film.flags).add(scene.background);
    std::copy(nothing.radiance, nothing.radiance + 3, film.background);
    const double place = 2 * double(RealTraits<Real>::unit) * std::ldexp(double(scene.extent), -scene.scale);
    film.rounding = place * film.full_width / (2 * camera.camera.tan_half_width);
    film.pixels.begin(size_t(film.rect.width) * size_t(film.rect.height), settings.kept_parts());
    static_cast<FrameCounts&>(film) = {};
    begin_layers(film.layers, settings.layers, film.pixels.size(), scene.layer_names);
    film.layers.unit_length = elementary::power_of_two(-scene.scale);
    for (int c = 0; c < 3; ++c) film.layers.center[c] = scene.center[c];
}

}  // namespace cistula
