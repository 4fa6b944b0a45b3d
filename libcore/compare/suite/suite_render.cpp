#include "compare/suite/suite_render.h"

#include <fmt/format.h>

#include "base/timing.h"
#include "image/picture/picture_hash.h"
#include "render/record/film_picture.h"
#include "render/record/frame_header.h"
#include "scene/readers/read_scene.h"
#include "sequence/frame_writer.h"
#include "sequence/sequence_loop.h"

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
    if (!whole) throw Error(ErrorKind::interrupted, "interrupted");
    if (film.flags != 0)
        throw Error(ErrorKind::failed,
                    fmt::format("frame {} cannot be trusted: {}", frame, describe_flags(film.flags, prepared.scene)))
            .at(prepared.scene.source);
    uint64_t clamped = 0;
    LayeredPicture& picture = result.picture;
    picture = to_layers(film, one.channels, &clamped);
    if (clamped > 0) result.notes.push_back("clamped: " + over_largest_half(clamped));
    round_to_stored(picture);
    picture.attributes.merge(
        header_attributes(film, prepared.scene.film, prepared.hashes, prepared.settings, prepared.precision, camera));
    result.film_hash = film_hash(film);
    return result;
}

}  // namespace

FrameSettings settings_of(const SuiteCase& one, const SceneDescription& scene) {
    try {
        return frame_settings(one, scene);
    } catch (const Error& error) {
        throw error.named(quoted_name).at(one.place);
    }
}

SuiteScene prepare_case(const SuiteCase& one, const std::string& folder, Backend backend, const CudaOptions& cuda,
                        StopSignal stop) {
    SuiteScene result;
    const auto prepared = std::make_shared<PreparedCase>();
    prepared->one = one;
    prepared->scene = read_scene(one.scene_path(folder));
    prepared->settings = settings_of(one, prepared->scene);
    const Scene scene(prepared->scene, one.precision, stop);
    if (!scene.precision_note().empty()) result.notes.push_back(scene.precision_note());
    result.notes.insert(result.notes.end(), scene.warnings().begin(), scene.warnings().end());
    require_light_layers(one.channels, *scene.layer_names());
    result.precision = prepared->precision = scene.precision();
    prepared->hashes = scene.hashes();
    prepared->renderer = make_renderer(backend, scene, cuda);
    result.render = [prepared](int frame, RenderProgress& progress) {
        return render_prepared(*prepared, frame, progress);
    };
    return result;
}

}  // namespace cistula
