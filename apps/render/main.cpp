// render: renders a scene to images.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstdio>
#include <filesystem>
#include <future>
#include <optional>

#include "apps/common/command_line.h"
#include "apps/common/film_progress.h"
#include "apps/common/interrupt.h"
#include "apps/common/progress_record.h"
#include "apps/common/render_options.h"
#include "apps/common/step_progress.h"
#include "backend_embree/embree/embree_renderer.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/stages.h"
#include "base/suggest.h"
#include "base/timing.h"
#include "explain.h"
#include "image/exr/exr.h"
#include "render/layer_list.h"
#include "render/pixel_report.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/compile/precision_choice.h"
#include "scene/compile/scene_source.h"
#include "scene/description/camera_turns.h"
#include "scene/readers/read_text_input.h"
#include "sequence/backends.h"
#include "sequence/film_loop.h"
#include "sequence/run_files.h"
#include "sequence/snapshots.h"

namespace cistula {
namespace {

int threads_of(const RenderRequest& request) {
    return request.threads > 0 ? request.threads : tbb::this_task_arena::max_concurrency();
}

/// Runs `work` with its parallelism, and that of OpenEXR, limited to --threads.
template <class Work>
void on_threads(const RenderRequest& request, const Work& work) {
    const int threads = threads_of(request);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
    set_exr_threads(threads);
    tbb::task_arena arena(threads);
    arena.execute(work);
}

void print_warnings(const std::vector<std::string>& warnings, const RenderRequest& request) {
    if (request.quiet) return;
    for (const std::string& warning : warnings) note(fmt::format("render: warning: {}", warning));
}

/// The precision of the frames, which is said where the scene decides it.
PrecisionChoice precision_of(const RenderRequest& request, const SceneSource& source) {
    const PrecisionChoice choice = choose_precision(request.precision, smallest_part(source));
    if (!choice.note.empty() && !request.quiet) note(fmt::format("render: {}", choice.note));
    return choice;
}

/// The precision, of which is warned here where no compilation will.
Precision warned_precision_of(const RenderRequest& request, const SceneSource& source) {
    const PrecisionChoice choice = precision_of(request, source);
    if (!choice.warning.empty()) print_warnings({choice.warning}, request);
    return choice.precision;
}

/// Compiles, and says what it found.
Scene compiled(SceneSource source, const RenderRequest& request) {
    PrecisionChoice choice = precision_of(request, source);
    Scene scene(std::move(source), std::move(choice));
    print_warnings(scene.warnings(), request);
    return scene;
}

/// Tells a film's progress, and writes its frames down for --stats.
class ToldFilm : public FilmProgress {
  public:
    ToldFilm(const RenderRequest& request, const RenderProgress& progress, StatsFile* stats)
        : FilmProgress(request.progress,
                       request.quiet     ? Talk::errors
                       : request.verbose ? Talk::much
                                         : Talk::some,
                       progress),
          stats_(stats) {}

    void written(const FrameStats& frame) override {
        if (stats_) stats_->add(frame);
        FilmProgress::written(frame);
    }

  private:
    StatsFile* const stats_;  // null: nobody asked
};

/// A renderer on the devices that are being made ready.
std::unique_ptr<Renderer> renderer_of(const Scene& scene, const RenderRequest& request,
                                      std::future<ChosenDevices> choice, StopSignal stop, RunStats& stats) {
    stats.required_effects = scene.effects();
    enter_stage(Stage::device);
    const ChosenDevices devices = choice.get();
    stop.check();
    stats.devices = devices.names;
    stats.driver = devices.driver;
    enter_stage(Stage::tree);
    return make_renderer(request.backend, scene, devices.options);
}

/// The names of the images and previews, and their frames.
struct Outputs {
    OutputName image, preview;
    std::vector<int> frames;
    std::vector<std::string> layers;  // that have files of their own
};

/// Checks the names of these frames against all others, creates their directories, and finds their cameras. Returns
/// where the picture turns at once.
std::string look_ahead(const Outputs& outputs, const RenderRequest& request, const SceneDescription& scene,
                       const RunFiles& others, const std::vector<int>& frames) {
    require_different_files(others, outputs.image, outputs.preview, frames, outputs.layers);
    make_directories(outputs.image, frames);
    if (!request.preview.empty()) make_directories(outputs.preview, frames);
    return camera_turns(scene.camera, frames);
}

Outputs plan_outputs(const RenderRequest& request, const SceneDescription& scene) {
    Outputs outputs;
    const std::string name = request.output.empty() ? default_output(scene, request.frames.size()) : request.output;
    outputs.image = OutputName(name, "-o");
    if (request.tile) outputs.image = outputs.image.named(tile_name(*request.tiles, *request.tile));
    outputs.frames = frames_to_render(outputs.image, request.frames, scene.film.frames);
    if (file_kind(name) == FileKind::raw) {
        const auto refuse = [&](const std::string& option, const char* why) {
            throw Error(ExitCode::usage, fmt::format("-o {}: {} needs an .exr; {}", name, option, why));
        };
        if (request.channels.half) refuse("--bits half", "raw frames have 8 bits a channel");
        const OutputChannels& c = request.channels;
        if (!request.layers.empty()) refuse("--layers", "raw frames have none");
        if (c.transparent) refuse("--background transparent", "raw frames have no alpha");
        if (c.space != &color_spaces().front()) refuse("--colorspace", "raw frames are sRGB");
        if (c.compression != Compression::zip) refuse("--compression", "raw frames have none");
        if (request.tile) refuse("--tile", "raw frames do not say what part they are");
        if (request.resume) refuse("--resume", "raw frames do not say what they show");
    }
    outputs.preview = preview_name(request.preview, outputs.frames);
    return outputs;
}

/// Checks the names of all frames that may be those of `others`: `paths`, the scene and the stats.
void check_names(const RenderRequest& request, const RunFiles& others, std::vector<std::string> paths,
                 const Outputs& outputs) {
    paths.insert(paths.end(), {request.scene, request.stats});
    require_different_files(others, outputs.image, outputs.preview, frames_named_in(paths, outputs.frames),
                            outputs.layers);
}

/// Checks the files to be written against all others, makes the directories of the first frames, and finds their
/// cameras.
void prepare_files(const RenderRequest& request, const SceneDescription& scene, const RunFiles& others,
                   const std::vector<std::string>& read, const Outputs& outputs) {
    check_names(request, others, read, outputs);
    const std::string turns =
        look_ahead(outputs, request, scene, others, frames_from(outputs.frames, 0, stretch_length));
    if (!turns.empty()) print_warnings({turns}, request);
    if (request.stats.empty()) return;
    make_directory_of(request.stats);
    const AtomicFile probe(request.stats);
}

void print_summary(const FilmTotals& totals, const OutputName& image, double seconds) {
    if (totals.frames == 0) return;
    const std::string what =
        totals.frames == 1 ? totals.first_file : fmt::format("{}: {} frames", image.text(), totals.frames);
    const double rate = totals.render_seconds > 0 ? static_cast<double>(totals.rays) / totals.render_seconds : 0;
    note(fmt::format("render: {}: {:.2f} s, {} rays, {}", what, seconds, totals.rays, format_rate(rate)));
}

/// Prints a warning if values of the written frames were clamped to half precision.
void warn_of_clamped(const FilmTotals& totals, const OutputName& image, const RenderRequest& request) {
    if (totals.clamped == 0) return;
    const std::string where =
        totals.frames == 1 ? totals.first_file
                           : fmt::format("{}: in {} of {} frames", image.text(), totals.clamped_frames, totals.frames);
    print_warnings({fmt::format("{}: clamped: {}", where, over_largest_half(totals.clamped))}, request);
}

/// Prints a warning if it is seen in the written frames what the depth took.
void warn_of_depth(const FilmTotals& totals, const OutputName& image, const FrameSettings& settings,
                   const RenderRequest& request) {
    const std::string warning = describe_depth_loss(totals, image.text(), settings.depth);
    if (!warning.empty()) print_warnings({warning}, request);
}

/// Prints the target report. Throws Error (target) if pixels missed the target.
void judge_target(const FilmTotals& totals, const FrameSettings& settings, Precision precision,
                  const RenderRequest& request) {
    const std::string text = describe_target(totals.target, totals.pixels, settings, precision);
    if (totals.target.missed != 0) throw Error(ExitCode::target, text);
    if (!request.quiet) note(fmt::format("render: {}", text));
}

/// What is advised when memory runs out.
std::string advice_on_memory(const RenderRequest& request, const FrameSettings& settings) {
    const PixelRect& crop = settings.crop;
    const uint64_t pixels = static_cast<uint64_t>(crop.width) * static_cast<uint64_t>(crop.height);
    const uint64_t mebibytes = pixels * settings.kept_parts().bytes() >> 20;
    if (mebibytes < 64)
        return fmt::format("the scene and {} threads take most of it; allow more (ulimit -v), or give fewer --threads",
                           threads_of(request));
    return fmt::format("a frame of {}x{} takes {} MiB of it while it is rendered; a smaller --res or --crop needs less",
                       crop.width, crop.height, mebibytes);
}

void render_scene(RenderCommand request, std::string& memory_advice) {
    const bool explain = request.action == Action::explain;
    SnapshotRequests snapshot_requests;
    std::optional<UserSignal> user_signal;
    if (!explain) user_signal.emplace(snapshot_requests);
    // Devices take longer to begin than most scenes to be read and compiled, which goes on meanwhile.
    std::future<ChosenDevices> devices;
    if (!explain)
        devices =
            std::async(std::launch::async, [&request] { return choose_devices(request.backend, request.devices); });
    enter_stage(Stage::read);
    SceneDescription scene = read_scene(request);
    enter_stage(Stage::other);
    if (explain) {
        SceneSource source = gather_scene(scene);
        const Precision precision = warned_precision_of(request, source);
        return print(explain_table(scene.source, explain_scene(std::move(source), precision), request.backend));
    }

    if (const std::string warning = open_config_view(request.view); !warning.empty())
        print_warnings({warning}, request);
    const FrameSettings settings = frame_settings(request, scene);
    memory_advice = advice_on_memory(request, settings);
    Outputs outputs = plan_outputs(request, scene);
    RenderProgress progress;  // must outlive the guard
    InterruptGuard guard;
    guard.watch(progress.stop);

    RunStats stats;
    stats.scene = request.scene;
    stats.backend = request.backend;
    stats.threads = threads_of(request);
    on_threads(request, [&] {
        enter_stage(Stage::read);
        SceneSource source = gather_scene(scene, progress.stop);
        enter_stage(Stage::other);
        RunFiles others;
        others.reads_scene(request.scene, source.files);
        others.writes(request.stats, "--stats");
        const std::vector<std::string> read = source.files;
        prepare_files(request, scene, others, read, outputs);
        enter_stage(Stage::compile);
        std::optional<Scene> made_scene = compiled(std::move(source), request);
        const Precision precision = stats.precision = made_scene->precision();
        std::unique_ptr<Renderer> made = renderer_of(*made_scene, request, std::move(devices), progress.stop, stats);
        Renderer& renderer = *made;
        const std::shared_ptr<const LayerNames> layer_names = made_scene->layer_names();
        const FrameHashes hashes = made_scene->hashes();
        made_scene.reset();  // the renderer keeps what it needs
        enter_stage(Stage::other);
        stats.scene_hash = hashes.of(outputs.frames.empty() ? 0 : outputs.frames.front());
        std::optional<StatsFile> file;
        if (!request.stats.empty()) file.emplace(request.stats, settings, !stats.devices.empty());
        const auto write_stats = [&] {
            stats.intersector = renderer.intersector();
            stats.lanes = renderer.lanes();
            stats.effects = renderer.effects();
            stats.scene_bytes = renderer.memory();
            enter_stage(Stage::end);  // of what the renderer has, too, so that the time for that is among the stages
            made.reset();
            enter_stage(Stage::other);
            if (file) file->finish(stats);
        };
        if (request.verbose) {
            const StageSeconds so_far = stage_seconds();
            const auto seconds = [&](Stage stage) { return so_far[static_cast<size_t>(stage)]; };
            note(fmt::format("render: read {:.3f} s, compile {:.3f} s, tree {:.3f} s, {} bytes; scene hash {}",
                             seconds(Stage::read), seconds(Stage::compile), seconds(Stage::tree), renderer.memory(),
                             stats.scene_hash));
        }
        ToldFilm report(request, progress, file ? &*file : nullptr);
        FilmJob job{request,         scene,          hashes, settings, outputs.image,
                    outputs.preview, outputs.frames, report, precision};
        job.layer_names = layer_names;
        job.snapshot_requests = &snapshot_requests;
        require_light_layers(request.channels, *job.layer_names);
        outputs.layers = layers_with_files(job);
        if (!outputs.layers.empty()) {  // their names are known only now
            check_names(request, others, read, outputs);
            require_different_files(others, outputs.image, outputs.preview,
                                    frames_from(outputs.frames, 0, stretch_length), outputs.layers);
        }
        job.look_ahead = [&](const std::vector<int>& frames) {
            return look_ahead(outputs, request, scene, others, frames);
        };
        double seconds = 0;
        try {
            seconds = seconds_of([&] { render_film(job, renderer, progress, stats); });
        } catch (const Error&) {
            warn_of_clamped(stats.totals, outputs.image, request);
            try {
                write_stats();        // of the finished frames
            } catch (const Error&) {  // the original error is the one to report
            }
            throw;
        }
        warn_of_clamped(stats.totals, outputs.image, request);
        warn_of_depth(stats.totals, outputs.image, settings, request);
        write_stats();
        if (request.verbose && stats.totals.frames > 0)  // the renderer knows which effects it used
            note(fmt::format("render: effects: {}", fmt::join(names_of_effects(stats.effects), ", ")));
        if (!request.quiet) print_summary(stats.totals, outputs.image, seconds);
        if (settings.adaptive() && stats.totals.frames > 0) judge_target(stats.totals, settings, precision, request);
    });
}

void measure_scene(const RenderRequest& request) {
    const ChosenDevices devices = choose_devices(request.backend, request.devices);
    const SceneDescription scene = read_scene(request);
    const FrameSettings settings = frame_settings(request, scene);
    StepProgress progress(request.quiet ? ProgressStyle::none : request.progress);  // must outlive the guard
    InterruptGuard guard;
    guard.watch(progress.render.stop);
    on_threads(request, [&] {
        const StopSignal stop(progress.render.stop);
        SceneSource source = gather_scene(scene, stop);
        const Precision precision = warned_precision_of(request, source);
        const Explanation explanation = explain_scene(std::move(source), precision);
        const auto make = [&](const SceneDescription& of) {
            return make_renderer(request.backend, Scene(of, precision, stop), devices.options);
        };
        const int frame = request.frames.empty() ? 0 : request.frames.front();
        const EffectCosts costs = measure_effects(scene, explanation.effects, frame, settings, make, progress);
        print(explain_table(scene.source, explanation, request.backend, &costs));
    });
}

void report_pixel(const RenderCommand& request, const SceneDescription& description, SceneSource source,
                  const FrameSettings& settings, const CameraFrame& camera) {
    const Scene scene = compiled(std::move(source), request);
    PixelTree tree = make_embree_renderer(scene)->pixel_tree(camera, settings, request.pixel.x, request.pixel.y);
    const std::string flaws = describe_flags(tree.film.flags, description);
    const PixelReport report{request.pixel.x,
                             request.pixel.y,
                             scene.precision(),
                             description.source,
                             scene.names(),
                             settings,
                             camera,
                             std::move(tree),
                             scene.hashes().of(camera.frame),
                             flaws};
    if (request.json != "-") print(pixel_text(report, request.verbose));
    if (request.json == "-")
        print(pixel_json(report));
    else if (!request.json.empty())
        write_file_atomically(request.json, pixel_json(report));
    if (!flaws.empty())
        throw Error(ExitCode::failed, fmt::format("{}: pixel {},{} cannot be trusted: {}", description.source,
                                                  request.pixel.x, request.pixel.y, flaws));
}

void report_pixel(const RenderCommand& request) {
    const SceneDescription scene = read_scene(request);
    const FrameSettings settings = frame_settings(request, scene);
    const ChosenPixel& pixel = request.pixel;
    if (pixel.x >= settings.full_width || pixel.y >= settings.full_height)
        throw Error(ExitCode::usage,
                    fmt::format("--pixel {},{}: is outside of the frame, which is {}x{}; its last pixel is {},{}",
                                pixel.x, pixel.y, settings.full_width, settings.full_height, settings.full_width - 1,
                                settings.full_height - 1));
    const CameraFrame camera = camera_at(scene.camera, request.frames.empty() ? 0 : request.frames.front());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(threads_of(request)));
    SceneSource source = gather_scene(scene);
    if (!request.json.empty() && request.json != "-") {
        RunFiles files;
        files.reads_scene(request.scene, source.files);
        files.writes(request.json, "--json");
        make_directory_of(request.json);
    }
    report_pixel(request, scene, std::move(source), settings, camera);
}

void run(const RenderCommand& request, std::string& memory_advice) {
    switch (request.action) {
        case Action::print_help:
            return print(help_text());
        case Action::print_version:
            return print("render (Cistula) " CISTULA_VERSION "\n");
        case Action::print_template:
            return print(text_input_template());
        case Action::list_devices:
            return print(list_devices_text());
        case Action::pixel:
            return report_pixel(request);
        case Action::measure:
            return measure_scene(request);
        case Action::explain:
        case Action::render:
            return render_scene(request, memory_advice);
    }
}

/// The style of --progress in a command line that may be wrong otherwise.
ProgressStyle style_in(int argc, char** argv) {
    RenderRequest request;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i], option = "--progress";
        const std::string value = word == option && i + 1 < argc   ? argv[i + 1]
                                  : word.starts_with(option + "=") ? word.substr(option.size() + 1)
                                                                   : "";
        if (value == "json" || value == "openjd") request_key("progress").set(request, value);
    }
    return request.progress;
}

/// Runs, and tells programs that read the progress of an error that ends it.
void run_and_record(int argc, char** argv, std::string& memory_advice) {
    try {
        run(parse_options(argc, argv), memory_advice);
    } catch (const std::exception& error) {
        const Failure failure = failure_of(error, memory_advice);
        const std::string lines = failure_record(style_in(argc, argv), failure.text, failure.code);
        if (!lines.empty()) std::fputs((lines + "\n").c_str(), stdout);
        std::fflush(stdout);
        throw;
    }
}

}  // namespace
}  // namespace cistula

int main(int argc, char** argv) {
    using namespace cistula;
    std::string memory_advice = "a smaller --res or --crop needs less";
    return run_program("render", memory_advice, [&] {
        run_and_record(argc, argv, memory_advice);
        return static_cast<int>(ExitCode::done);
    });
}
