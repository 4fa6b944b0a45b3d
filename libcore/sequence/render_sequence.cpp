#include "sequence/render_sequence.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <future>
#include <optional>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/stages.h"
#include "base/timing.h"
#include "image/exr/exr.h"
#include "render/record/film_picture.h"
#include "scene/description/camera_path.h"
#include "sequence/run_files.h"
#include "sequence/sequence_loop.h"
#include "sequence/snapshots.h"

namespace cistula {
namespace {

/// The files of a sequence: their names, their frames, and all others that the run reads or writes.
class SequenceFiles {
  public:
    SequenceFiles(const RenderRequest& request, const SceneDescription& scene) : request_(request), scene_(scene) {
        const std::string name = request.output.empty() ? default_output(scene, request.frames.size()) : request.output;
        image = OutputName(name, "`output`");
        if (request.tile) image = image.named(tile_name(*request.tiles, *request.tile));
        frames = frames_to_render(image, request.frames, scene.film.frames);
        if (file_kind(name) == FileKind::raw) refuse_layers_of_raw(name);
        preview = preview_name(request.preview, frames);
    }

    /// Checks the files to be written against all others, `read` among them, makes the directories of the first
    /// frames, and finds their cameras. Returns a warning, or nothing.
    std::string prepare(const std::vector<std::string>& read) {
        others_.reads_scene(request_.scene, read);
        others_.writes(request_.stats, "`stats`");
        named_ = read;
        named_.insert(named_.end(), {request_.scene, request_.stats});
        require_different_named();
        std::string warning = look_ahead(frames_from(frames, 0, stretch_length));
        if (!request_.stats.empty()) {
            make_directory_of(request_.stats);
            const AtomicFile probe(request_.stats);
        }
        return warning;
    }

    /// Checks the files of layers that have their own, whose names only a compiled scene has.
    void add_layers(std::vector<std::string> layers) {
        layers_ = std::move(layers);
        if (layers_.empty()) return;
        require_different_named();
        require_different(frames_from(frames, 0, stretch_length));
    }

    /// Checks the names of these frames against all others, creates their directories, and finds their cameras.
    /// Returns where the picture turns at once, or nothing.
    std::string look_ahead(const std::vector<int>& stretch) const {
        require_different(stretch);
        make_directories(image, stretch);
        if (!request_.preview.empty()) make_directories(preview, stretch);
        return camera_turns(scene_.camera, stretch);
    }

    OutputName image, preview;
    std::vector<int> frames;

  private:
    void refuse_layers_of_raw(const std::string& name) const {
        const auto refuse = [&](const char* setting, const char* why) {
            throw Error(ErrorKind::usage, fmt::format("`output` {}: {} needs an .exr", name, setting), why);
        };
        const OutputChannels& channels = request_.channels;
        if (channels.half) refuse("`bits` half", "raw frames have 8 bits a channel");
        if (!request_.layers.empty()) refuse("`layers`", "raw frames have none");
        if (channels.transparent) refuse("`background` transparent", "raw frames have no alpha");
        if (channels.space != &color_spaces().front()) refuse("`colorspace`", "raw frames are sRGB");
        if (channels.compression != Compression::zip) refuse("`compression`", "raw frames have none");
        if (request_.tile) refuse("`tile`", "raw frames do not say what part they are");
        if (request_.resume) refuse("`resume`", "raw frames do not say what they show");
    }

    void require_different(const std::vector<int>& some) const {
        require_different_files(others_, image, preview, some, layers_);
    }
    void require_different_named() const { require_different(frames_named_in(named_, frames)); }

    const RenderRequest& request_;
    const SceneDescription& scene_;
    RunFiles others_;
    std::vector<std::string> named_;   // paths that may be those of a frame
    std::vector<std::string> layers_;  // that have files of their own
};

/// Renders the frames of a compiled scene.
void render_compiled(const RenderRequest& request, const SceneDescription& description, std::optional<Scene> scene,
                     const ChosenDevices& devices, SequenceFiles& files, SequenceEvents& events,
                     RenderProgress& progress, SnapshotRequests* snapshots, const FrameSettings& settings,
                     RunStats& stats) {
    stats.precision = scene->precision();
    stats.required_effects = scene->effects();
    stats.devices = devices.names;
    stats.driver = devices.driver;
    enter_stage(Stage::tree);
    std::unique_ptr<Renderer> renderer = make_renderer(request.backend, *scene, devices.options);
    const std::shared_ptr<const LayerNames> layer_names = scene->layer_names();
    const FrameHashes hashes = scene->hashes();
    scene.reset();  // the renderer keeps what it needs
    enter_stage(Stage::other);
    stats.scene_hash = hashes.of(files.frames.empty() ? 0 : files.frames.front());
    stats.scene_bytes = renderer->memory();
    events.ready(stats);

    std::optional<StatsFile> file;
    if (!request.stats.empty()) file.emplace(request.stats, settings, !stats.devices.empty());
    const SequenceJob job{.request = request,
                          .scene = description,
                          .hashes = hashes,
                          .settings = settings,
                          .output = files.image,
                          .preview = files.preview,
                          .frames = files.frames,
                          .events = events,
                          .precision = stats.precision,
                          .layer_names = layer_names,
                          .look_ahead = [&](const std::vector<int>& some) { return files.look_ahead(some); },
                          .stats_file = file ? &*file : nullptr,
                          .snapshot_requests = snapshots};
    require_light_layers(request.channels, *layer_names);
    files.add_layers(layers_with_files(job));
    const auto finish = [&] {
        stats.scene_bytes = renderer->memory();
        enter_stage(Stage::end);  // of what the renderer has, too, so that the time for that is among the stages
        renderer.reset();
        enter_stage(Stage::other);
        if (file) file->finish(stats);
    };
    try {
        render_frames(job, *renderer, progress, stats);
    } catch (const Error&) {
        try {
            finish();             // with the finished frames
        } catch (const Error&) {  // the original error is the one to report
        }
        throw;
    }
    finish();
}

}  // namespace

int threads_of(const RenderRequest& request) {
    return request.threads > 0 ? request.threads : tbb::this_task_arena::max_concurrency();
}

PrecisionChoice told_precision(const RenderRequest& request, const SceneSource& source, SequenceEvents& events) {
    PrecisionChoice choice = choose_precision(request.precision, smallest_part(source));
    if (!choice.note.empty()) events.remark(choice.note);
    return choice;
}

Scene compile_for(const RenderRequest& request, SceneSource source, SequenceEvents& events) {
    PrecisionChoice choice = told_precision(request, source, events);
    Scene scene(std::move(source), std::move(choice));
    for (const std::string& warning : scene.warnings()) events.warning(warning);
    return scene;
}

RunStats render_sequence(const RenderRequest& asked, SequenceEvents& events, RenderProgress& progress,
                         SnapshotRequests* snapshots) {
    RenderRequest request = asked;
    // Devices take longer to begin than most scenes to be read and compiled, which goes on meanwhile.
    std::future<ChosenDevices> devices =
        std::async(std::launch::async, [&request] { return choose_devices(request.backend, request.devices); });
    enter_stage(Stage::read);
    SceneDescription description = read_scene(request);
    enter_stage(Stage::other);
    if (const std::string warning = open_config_view(request.view); !warning.empty()) events.warning(warning);
    const FrameSettings settings = frame_settings(request, description);
    SequenceFiles files(request, description);
    if (description.motion && !files.frames.empty()) description.motion->set(description, files.frames.front());
    RunStats stats;
    stats.scene = request.scene;
    stats.images = files.image.text();
    stats.backend = request.backend;
    stats.threads = threads_of(request);
    events.planned(settings);

    tbb::task_arena arena(stats.threads);
    arena.execute([&] {
        enter_stage(Stage::read);
        SceneSource source = gather_scene(description, progress.stop);
        enter_stage(Stage::other);
        events.read(source.files);
        if (const std::string turns = files.prepare(source.files); !turns.empty()) events.warning(turns);
        enter_stage(Stage::compile);
        Scene scene = compile_for(request, std::move(source), events);
        enter_stage(Stage::device);
        const ChosenDevices chosen = devices.get();
        StopSignal(progress.stop).check();
        render_compiled(request, description, std::move(scene), chosen, files, events, progress, snapshots, settings,
                        stats);
    });
    return stats;
}

}  // namespace cistula
