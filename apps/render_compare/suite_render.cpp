#include "suite_render.h"

#include <fmt/format.h>

#include "apps/common/film_loop.h"
#include "apps/common/frame_writer.h"
#include "apps/common/header_attributes.h"
#include "apps/common/layer_list.h"
#include "apps/common/target.h"
#include "apps/common/timing.h"
#include "cistula/transport/ray_tree.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/precision_choice.h"
#include "scene/compile/scene_source.h"
#include "scene/film/frame_settings.h"
#include "scene/image/picture/picture_hash.h"
#include "scene/readers/read_scene.h"

namespace cistula {
namespace {

/// A scene on its backend, with what its frames are made of.
struct PreparedCase {
    SuiteCase one;
    SceneDescription scene;
    FrameSettings settings;
    Precision precision = Precision::single_;
    FrameHashes hashes;
    std::unique_ptr<Renderer> renderer;
};

template <class Real>
void compile(SceneSource source, PreparedCase& to, Backend backend, const CudaOptions& cuda,
             std::vector<std::string>& notes) {
    const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(std::move(source));
    notes.insert(notes.end(), compiled->warnings.begin(), compiled->warnings.end());
    require_light_layers(to.one.channels, *compiled->layer_names);
    to.hashes = compiled->hashes;
    to.renderer = make_renderer<Real>(backend, compiled, cuda);
}

SuiteFrame render_prepared(PreparedCase& prepared, int frame, RenderProgress& progress) {
    const SuiteCase& one = prepared.one;
    const CameraFrame camera = camera_at(prepared.scene.camera, frame);
    SuiteFrame result;
    result.frame = frame;
    Film film;
    bool whole = false;
    result.seconds = seconds_of([&] {
        FrameSettings settings = prepared.settings;
        whole = render_frame(*prepared.renderer, camera, settings, film, progress);
    });
    if (!whole) throw Error(ExitCode::interrupted, "interrupted");
    if (film.flags != 0)
        throw Error(ExitCode::failed, fmt::format("{}: frame {} cannot be trusted: {}", prepared.scene.source, frame,
                                                  describe_flags(film.flags, prepared.scene)));
    uint64_t clamped = 0;
    LayeredPicture& picture = result.picture;
    picture = to_layers(film, one.channels, &clamped);
    if (clamped > 0) result.notes.push_back("clamped: " + over_largest_half(clamped));
    round_to_stored(picture);
    picture.attributes.merge(header_attributes(prepared.hashes, prepared.settings, prepared.precision, camera));
    add_film_attributes(prepared.scene.film, picture.attributes);
    if (prepared.settings.adaptive()) add_target_attributes(target_report(film, prepared.settings), picture.attributes);
    result.film_hash = film_hash(film);
    return result;
}

}  // namespace

FrameSettings settings_of(const SuiteCase& one, const SceneDescription& scene) {
    FrameSettings settings = frame_settings(scene);
    if (one.resolution) settings.set_size(one.resolution->width, one.resolution->height);
    settings.supersample = one.supersample.value_or(settings.supersample);
    settings.depth = one.depth.value_or(settings.depth);
    settings.cutoff = one.cutoff.value_or(settings.cutoff);
    settings.target_error = one.target_error.value_or(0);
    settings.max_samples = one.max_samples.value_or(settings.max_samples);
    settings.layers = layers_for(one.channels);
    if (settings.adaptive()) settings.depth = one.depth.value_or(largest_depth);
    settings.crop = one.crop.value_or(settings.crop);
    const PixelRect& crop = settings.crop;
    if (crop.x > settings.full_width - crop.width || crop.y > settings.full_height - crop.height)
        throw Error(ExitCode::usage,
                    fmt::format("{}/crop: {}x{} at {},{} leaves the frame, which is {}x{}", one.place, crop.width,
                                crop.height, crop.x, crop.y, settings.full_width, settings.full_height));
    return settings;
}

SuiteScene prepare_case(const SuiteCase& one, const std::string& folder, Backend backend, const CudaOptions& cuda,
                        StopSignal stop) {
    SuiteScene result;
    const auto prepared = std::make_shared<PreparedCase>();
    prepared->one = one;
    prepared->scene = read_scene(one.scene_path(folder));
    prepared->settings = settings_of(one, prepared->scene);
    SceneSource source = gather_scene(prepared->scene, stop);
    const PrecisionChoice choice = choose_precision(one.precision, smallest_part(source));
    for (const std::string& text : {choice.note, choice.warning})
        if (!text.empty()) result.notes.push_back(text);
    result.precision = prepared->precision = choice.precision;
    if (choice.precision == Precision::double_)
        compile<double>(std::move(source), *prepared, backend, cuda, result.notes);
    else
        compile<float>(std::move(source), *prepared, backend, cuda, result.notes);
    result.render = [prepared](int frame, RenderProgress& progress) {
        return render_prepared(*prepared, frame, progress);
    };
    return result;
}

}  // namespace cistula
