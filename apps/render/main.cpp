// render: renders a scene to images.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstdio>
#include <filesystem>
#include <future>
#include <optional>

#include "apps/common/backends.h"
#include "apps/common/command_line.h"
#include "apps/common/film_loop.h"
#include "apps/common/film_progress.h"
#include "apps/common/interrupt.h"
#include "apps/common/layer_list.h"
#include "apps/common/pixel_report.h"
#include "apps/common/progress_record.h"
#include "apps/common/render_options.h"
#include "apps/common/run_files.h"
#include "apps/common/snapshots.h"
#include "apps/common/step_progress.h"
#include "apps/common/timing.h"
#include "apps/common/view_options.h"
#include "backend_embree/pixel_tree/embree_pixel_tree.h"
#include "explain.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/stages.h"
#include "scene/base/suggest.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/precision_choice.h"
#include "scene/compile/required_effects.h"
#include "scene/compile/scene_source.h"
#include "scene/description/camera_turns.h"
#include "scene/readers/read_text_input.h"

namespace cistula {
namespace {

int threads_of(const RenderOptions& options) {
    return options.threads > 0 ? options.threads : tbb::this_task_arena::max_concurrency();
}

/// Runs `work` with its parallelism limited to --threads.
template <class Work>
void on_threads(const RenderOptions& options, const Work& work) {
    const int threads = threads_of(options);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
    tbb::task_arena arena(threads);
    arena.execute(work);
}

void print_warnings(const std::vector<std::string>& warnings, const RenderOptions& options) {
    if (options.quiet) return;
    for (const std::string& warning : warnings) note(fmt::format("render: warning: {}", warning));
}

/// Sets the precision of the frames, and says so where the scene decides it.
void choose_precision(RenderOptions& options, const SceneSource& source) {
    const PrecisionChoice choice = choose_precision(options.wanted_precision, smallest_part(source));
    options.precision = choice.precision;
    if (!choice.warning.empty()) print_warnings({choice.warning}, options);
    if (!choice.note.empty() && !options.quiet) note(fmt::format("render: {}", choice.note));
}

/// A scene that is ready to be rendered.
struct Prepared {
    std::unique_ptr<Renderer> renderer;
    std::shared_ptr<const LayerNames> layer_names;
    FrameHashes hashes;
};

template <class Real>
Prepared prepare(SceneSource source, const RenderOptions& options, std::future<ChosenDevices> choice, RunStats& stats) {
    const StopSignal stop = source.stop;
    const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(std::move(source));
    stats.required_effects = compiled->effects;
    print_warnings(compiled->warnings, options);
    enter_stage(Stage::device);
    const ChosenDevices devices = choice.get();
    stop.check();
    stats.devices = devices.names;
    stats.driver = devices.driver;
    enter_stage(Stage::tree);
    return {make_renderer<Real>(options.backend, compiled, devices.options), compiled->layer_names, compiled->hashes};
}

/// The names of the images and previews, and their frames.
struct Outputs {
    OutputName image, preview;
    std::vector<int> frames;
    std::vector<std::string> layers;  // that have files of their own
};

/// Checks the names of these frames against all others, creates their directories, and finds their cameras. Returns
/// where the picture turns at once.
std::string look_ahead(const Outputs& outputs, const RenderOptions& options, const SceneDescription& scene,
                       const RunFiles& others, const std::vector<int>& frames) {
    require_different_files(others, outputs.image, outputs.preview, frames, outputs.layers);
    make_directories(outputs.image, frames);
    if (!options.preview.empty()) make_directories(outputs.preview, frames);
    return camera_turns(scene.camera, frames);
}

Outputs plan_outputs(const RenderOptions& options, const SceneDescription& scene) {
    Outputs outputs;
    const std::string name = options.output.empty() ? default_output(scene, options.frames.size()) : options.output;
    outputs.image = OutputName(name, "-o");
    if (options.tile) outputs.image = outputs.image.named(tile_name(options.tiles, *options.tile));
    outputs.frames = frames_to_render(outputs.image, options.frames, scene.film.frames);
    if (file_kind(name) == FileKind::raw) {
        const auto refuse = [&](const std::string& option, const char* why) {
            throw Error(ExitCode::usage, fmt::format("-o {}: {} needs an .exr; {}", name, option, why));
        };
        if (options.channels.half) refuse("--bits half", "raw frames have 8 bits a channel");
        const OutputChannels& c = options.channels;
        if (!options.layers.empty()) refuse("--layers", "raw frames have none");
        if (c.transparent) refuse("--background transparent", "raw frames have no alpha");
        if (c.space != &color_spaces().front()) refuse("--colorspace", "raw frames are sRGB");
        if (c.compression != Compression::zip) refuse("--compression", "raw frames have none");
        if (options.tile) refuse("--tile", "raw frames do not say what part they are");
        if (options.resume) refuse("--resume", "raw frames do not say what they show");
    }
    outputs.preview = preview_name(options.preview, outputs.frames);
    return outputs;
}

/// Checks the names of all frames that may be those of `others`: `paths`, the scene and the stats.
void check_names(const RenderOptions& options, const RunFiles& others, std::vector<std::string> paths,
                 const Outputs& outputs) {
    paths.insert(paths.end(), {options.scene, options.stats});
    require_different_files(others, outputs.image, outputs.preview, frames_named_in(paths, outputs.frames),
                            outputs.layers);
}

/// Checks the files to be written against all others, makes the directories of the first frames, and finds their
/// cameras.
void prepare_files(const RenderOptions& options, const SceneDescription& scene, const RunFiles& others,
                   const std::vector<std::string>& read, const Outputs& outputs) {
    check_names(options, others, read, outputs);
    const std::string turns =
        look_ahead(outputs, options, scene, others, frames_from(outputs.frames, 0, stretch_length));
    if (!turns.empty()) print_warnings({turns}, options);
    if (options.stats.empty()) return;
    make_directory_of(options.stats);
    const AtomicFile probe(options.stats);
}

void print_summary(const FilmTotals& totals, const OutputName& image, double seconds) {
    if (totals.frames == 0) return;
    const std::string what =
        totals.frames == 1 ? totals.first_file : fmt::format("{}: {} frames", image.text(), totals.frames);
    const double rate = totals.render_seconds > 0 ? static_cast<double>(totals.rays) / totals.render_seconds : 0;
    note(fmt::format("render: {}: {:.2f} s, {} rays, {}", what, seconds, totals.rays, format_rate(rate)));
}

/// Prints a warning if values of the written frames were clamped to half precision.
void warn_of_clamped(const FilmTotals& totals, const OutputName& image, const RenderOptions& options) {
    if (totals.clamped == 0) return;
    const std::string where =
        totals.frames == 1 ? totals.first_file
                           : fmt::format("{}: in {} of {} frames", image.text(), totals.clamped_frames, totals.frames);
    print_warnings({fmt::format("{}: clamped: {}", where, over_largest_half(totals.clamped))}, options);
}

/// Prints a warning if it is seen in the written frames what the depth took.
void warn_of_depth(const FilmTotals& totals, const OutputName& image, const FrameSettings& settings,
                   const RenderOptions& options) {
    const std::string warning = describe_depth_loss(totals, image.text(), settings.depth);
    if (!warning.empty()) print_warnings({warning}, options);
}

/// Prints the target report. Throws Error (target) if pixels missed the target.
void judge_target(const FilmTotals& totals, const FrameSettings& settings, const RenderOptions& options) {
    const std::string text = describe_target(totals.target, totals.pixels, settings, options.precision);
    if (totals.target.missed != 0) throw Error(ExitCode::target, text);
    if (!options.quiet) note(fmt::format("render: {}", text));
}

/// What is advised when memory runs out.
std::string advice_on_memory(const RenderOptions& options, const FrameSettings& settings) {
    const PixelRect& crop = settings.crop;
    const uint64_t pixels = static_cast<uint64_t>(crop.width) * static_cast<uint64_t>(crop.height);
    const uint64_t mebibytes = pixels * settings.kept_parts().bytes() >> 20;
    if (mebibytes < 64)
        return fmt::format("the scene and {} threads take most of it; allow more (ulimit -v), or give fewer --threads",
                           threads_of(options));
    return fmt::format("a frame of {}x{} takes {} MiB of it while it is rendered; a smaller --res or --crop needs less",
                       crop.width, crop.height, mebibytes);
}

void render_scene(RenderOptions options, std::string& memory_advice) {
    const bool explain = options.action == Action::explain;
    std::optional<UserSignal> snapshot_signal;
    if (!explain) snapshot_signal.emplace();
    // Devices take longer to begin than most scenes to be read and compiled, which goes on meanwhile.
    std::future<ChosenDevices> devices;
    if (!explain)
        devices =
            std::async(std::launch::async, [&options] { return choose_devices(options.backend, options.devices); });
    enter_stage(Stage::read);
    SceneDescription scene = read_scene(options);
    enter_stage(Stage::other);
    if (explain) {
        SceneSource source = gather_scene(scene);
        choose_precision(options, source);
        return print(explain_table(scene.source, explain_scene(std::move(source), options.precision), options.backend));
    }

    if (const std::string warning = open_config_view(options.view); !warning.empty())
        print_warnings({warning}, options);
    const FrameSettings settings = frame_settings(options, scene);
    memory_advice = advice_on_memory(options, settings);
    Outputs outputs = plan_outputs(options, scene);
    RenderProgress progress;  // must outlive the guard
    InterruptGuard guard;
    guard.watch(progress.stop);

    RunStats stats;
    stats.scene = options.scene;
    stats.threads = threads_of(options);
    on_threads(options, [&] {
        enter_stage(Stage::read);
        SceneSource source = gather_scene(scene, progress.stop);
        enter_stage(Stage::other);
        RunFiles others;
        others.reads_scene(options.scene, source.files);
        others.writes(options.stats, "--stats");
        const std::vector<std::string> read = source.files;
        prepare_files(options, scene, others, read, outputs);
        enter_stage(Stage::compile);
        choose_precision(options, source);
        Prepared prepared = options.precision == Precision::double_
                                ? prepare<double>(std::move(source), options, std::move(devices), stats)
                                : prepare<float>(std::move(source), options, std::move(devices), stats);
        enter_stage(Stage::other);
        Renderer& renderer = *prepared.renderer;
        stats.scene_hash = prepared.hashes.of(outputs.frames.empty() ? 0 : outputs.frames.front());
        std::optional<StatsFile> file;
        if (!options.stats.empty()) file.emplace(options.stats, settings, !stats.devices.empty());
        const auto write_stats = [&] {
            stats.intersector = renderer.intersector();
            stats.lanes = renderer.lanes();
            stats.effects = renderer.effects();
            stats.scene_bytes = renderer.memory();
            enter_stage(Stage::end);  // of what the renderer has, too, so that the time for that is among the stages
            prepared.renderer.reset();
            enter_stage(Stage::other);
            if (file) file->finish(stats, options);
        };
        if (options.verbose) {
            const StageSeconds so_far = stage_seconds();
            const auto seconds = [&](Stage stage) { return so_far[static_cast<size_t>(stage)]; };
            note(fmt::format("render: read {:.3f} s, compile {:.3f} s, tree {:.3f} s, {} bytes; scene hash {}",
                             seconds(Stage::read), seconds(Stage::compile), seconds(Stage::tree), renderer.memory(),
                             stats.scene_hash));
        }
        FilmJob job{options, scene, prepared.hashes, settings, outputs.image, outputs.preview, outputs.frames};
        job.layer_names = prepared.layer_names;
        job.snapshot_signal = &*snapshot_signal;
        require_light_layers(options.channels, *job.layer_names);
        outputs.layers = layers_with_files(job);
        if (!outputs.layers.empty()) {  // their names are known only now
            check_names(options, others, read, outputs);
            require_different_files(others, outputs.image, outputs.preview,
                                    frames_from(outputs.frames, 0, stretch_length), outputs.layers);
        }
        if (file) job.written = [&](const FrameStats& frame) { file->add(frame); };
        job.look_ahead = [&](const std::vector<int>& frames) {
            return look_ahead(outputs, options, scene, others, frames);
        };
        double seconds = 0;
        try {
            seconds = seconds_of([&] { render_film(job, renderer, progress, stats); });
        } catch (const Error&) {
            warn_of_clamped(stats.totals, outputs.image, options);
            try {
                write_stats();        // of the finished frames
            } catch (const Error&) {  // the original error is the one to report
            }
            throw;
        }
        warn_of_clamped(stats.totals, outputs.image, options);
        warn_of_depth(stats.totals, outputs.image, settings, options);
        write_stats();
        if (options.verbose && stats.totals.frames > 0)  // the renderer knows which effects it used
            note(fmt::format("render: effects: {}", fmt::join(names_of_effects(stats.effects), ", ")));
        if (!options.quiet) print_summary(stats.totals, outputs.image, seconds);
        if (settings.adaptive() && stats.totals.frames > 0) judge_target(stats.totals, settings, options);
    });
}

template <class Real>
std::unique_ptr<Renderer> renderer_of(const SceneDescription& scene, const RenderOptions& options,
                                      const CudaOptions& cuda, StopSignal stop) {
    return make_renderer<Real>(options.backend,
                               std::shared_ptr<const CompiledScene<Real>>(compile_scene<Real>(scene, stop)), cuda);
}

void measure_scene(RenderOptions options) {
    const ChosenDevices devices = choose_devices(options.backend, options.devices);
    const SceneDescription scene = read_scene(options);
    const FrameSettings settings = frame_settings(options, scene);
    StepProgress progress(options.quiet ? ProgressStyle::none : options.progress);  // must outlive the guard
    InterruptGuard guard;
    guard.watch(progress.render.stop);
    on_threads(options, [&] {
        const StopSignal stop(progress.render.stop);
        SceneSource source = gather_scene(scene, stop);
        choose_precision(options, source);
        const Explanation explanation = explain_scene(std::move(source), options.precision);
        const auto make = [&](const SceneDescription& of) {
            return options.precision == Precision::double_ ? renderer_of<double>(of, options, devices.options, stop)
                                                           : renderer_of<float>(of, options, devices.options, stop);
        };
        const int frame = options.frames.empty() ? 0 : options.frames.front();
        const EffectCosts costs = measure_effects(scene, explanation.effects, frame, settings, make, progress);
        print(explain_table(scene.source, explanation, options.backend, &costs));
    });
}

template <class Real>
void report_pixel(const RenderOptions& options, const SceneDescription& scene, SceneSource source,
                  const FrameSettings& settings, const CameraFrame& camera) {
    const SceneNames names = name_scene(source);
    const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(std::move(source));
    print_warnings(compiled->warnings, options);
    const PixelTree tree = embree_pixel_tree<Real>(compiled, camera, settings, options.pixel.x, options.pixel.y);
    const PixelReport report{options.pixel.x,
                             options.pixel.y,
                             options.precision,
                             scene,
                             names,
                             settings,
                             camera,
                             tree,
                             compiled->hashes.of(camera.frame)};
    if (options.json != "-") print(pixel_text(report, options.verbose));
    if (options.json == "-")
        print(pixel_json(report));
    else if (!options.json.empty())
        write_file_atomically(options.json, pixel_json(report));
    if (tree.film.flags != 0)
        throw Error(ExitCode::failed,
                    fmt::format("{}: pixel {},{} cannot be trusted: {}", scene.source, options.pixel.x, options.pixel.y,
                                describe_flags(tree.film.flags, scene)));
}

void report_pixel(RenderOptions options) {
    const SceneDescription scene = read_scene(options);
    const FrameSettings settings = frame_settings(options, scene);
    const CameraFrame camera = camera_at(scene.camera, options.frames.empty() ? 0 : options.frames.front());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(threads_of(options)));
    SceneSource source = gather_scene(scene);
    if (!options.json.empty() && options.json != "-") {
        RunFiles files;
        files.reads_scene(options.scene, source.files);
        files.writes(options.json, "--json");
        make_directory_of(options.json);
    }
    choose_precision(options, source);
    if (options.precision == Precision::double_)
        report_pixel<double>(options, scene, std::move(source), settings, camera);
    else
        report_pixel<float>(options, scene, std::move(source), settings, camera);
}

void run(const RenderOptions& options, std::string& memory_advice) {
    switch (options.action) {
        case Action::print_help:
            return print(help_text());
        case Action::print_version:
            return print("render (Cistula) " CISTULA_VERSION "\n");
        case Action::print_template:
            return print(text_input_template());
        case Action::list_devices:
            return print(list_devices_text());
        case Action::pixel:
            return report_pixel(options);
        case Action::measure:
            return measure_scene(options);
        case Action::explain:
        case Action::render:
            return render_scene(options, memory_advice);
    }
}

/// Runs, and tells programs that read the progress of an error that ends it.
void run_and_record(const RenderOptions& options, std::string& memory_advice) {
    try {
        run(options, memory_advice);
    } catch (const std::exception& error) {
        const Failure failure = failure_of(error, memory_advice);
        const std::string lines = failure_record(options.progress, failure.text, failure.code);
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
        run_and_record(parse_options(argc, argv), memory_advice);
        return static_cast<int>(ExitCode::done);
    });
}
