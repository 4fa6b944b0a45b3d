// render: renders a scene to images.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstdio>
#include <optional>

#include "apps/common/command_line.h"
#include "apps/common/interrupt.h"
#include "apps/common/programs.h"
#include "apps/common/progress_record.h"
#include "apps/common/render_options.h"
#include "apps/common/sequence_progress.h"
#include "apps/common/step_progress.h"
#include "backend_embree/embree/embree_renderer.h"
#include "base/error.h"
#include "base/stages.h"
#include "explain.h"
#include "image/exr/exr.h"
#include "render/explorer/explorer.h"
#include "render/pixel_report.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/readers/scene_formats.h"
#include "sequence/backends.h"
#include "sequence/render_sequence.h"
#include "sequence/run_files.h"
#include "sequence/snapshots.h"

namespace cistula {
namespace {

/// Runs `work` with its parallelism, and that of OpenEXR, limited to --threads.
template <class Work>
void on_threads(const RenderRequest& request, const Work& work) {
    const int threads = threads_of(request);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
    set_exr_threads(threads);
    tbb::task_arena arena(threads);
    arena.execute(work);
}

Talk talk_of(const RenderRequest& request) {
    return request.quiet ? Talk::errors : request.verbose ? Talk::much : Talk::some;
}

/// Prints warnings and remarks on a scene.
class SceneTalk : public SequenceEvents {
  public:
    explicit SceneTalk(const RenderRequest& request) : quiet_(request.quiet) {}
    void warning(const std::string& line) override { remark("warning: " + line); }
    void remark(const std::string& line) override {
        if (!quiet_) note("render: " + line);
    }

  private:
    const bool quiet_;
};

/// The precision of a scene, of which is warned here where no compilation will.
Precision warned_precision(const RenderRequest& request, const SceneSource& source) {
    SceneTalk talk(request);
    const PrecisionChoice choice = told_precision(request, source, talk);
    if (!choice.warning.empty()) talk.warning(choice.warning);
    return choice.precision;
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

/// Tells a sequence's progress and what it came to. Interruptions end it from the moment that files may be written.
class ToldSequence : public SequenceProgress {
  public:
    ToldSequence(const RenderRequest& request, RenderProgress& progress, std::string& memory_advice)
        : SequenceProgress(request.progress, talk_of(request), progress),
          request_(request),
          stop_(progress.stop),
          memory_advice_(memory_advice) {}

    void planned(const FrameSettings& settings) override {
        memory_advice_ = advice_on_memory(request_, settings);
        watch_.emplace(stop_);
    }

    void ready(const RunStats& stats) override {
        if (!request_.verbose) return;
        const StageSeconds so_far = stage_seconds();
        const auto seconds = [&](Stage stage) { return so_far[static_cast<size_t>(stage)]; };
        note(fmt::format("render: read {:.3f} s, compile {:.3f} s, tree {:.3f} s, {} bytes; scene hash {}",
                         seconds(Stage::read), seconds(Stage::compile), seconds(Stage::tree), stats.scene_bytes,
                         stats.scene_hash));
    }

    void end(const RunStats& stats, size_t done, size_t frames) override {
        SequenceProgress::end(stats, done, frames);
        const SequenceTotals& totals = stats.totals;
        if (done < frames || totals.frames == 0) return;
        if (request_.verbose)
            note(fmt::format("render: hits by {}{}; effects: {}", stats.intersector,
                             stats.lanes > 1 ? fmt::format(" of {} rays", stats.lanes) : "",
                             fmt::join(names_of_effects(stats.effects), ", ")));
        if (request_.quiet) return;
        const std::string what =
            totals.frames == 1 ? totals.first_file : fmt::format("{}: {} frames", stats.images, totals.frames);
        const double rate = totals.render_seconds > 0 ? static_cast<double>(totals.rays) / totals.render_seconds : 0;
        note(fmt::format("render: {}: {:.2f} s, {} rays, {}", what, stats.seconds, totals.rays, format_rate(rate)));
    }

  private:
    const RenderRequest& request_;
    std::atomic<bool>& stop_;
    std::string& memory_advice_;
    std::optional<StopOnInterrupt> watch_;
};

void render_scene(const RenderRequest& request, std::string& memory_advice) {
    SnapshotRequests snapshots;
    const UserSignal user_signal(snapshots);
    RenderProgress progress;  // must outlive what watches
    ToldSequence told(request, progress, memory_advice);
    on_threads(request, [&] { render_sequence(request, told, progress, &snapshots); });
}

/// The scene as the first frame that is asked for has it.
SceneDescription read_frame(const RenderRequest& request) {
    return at_frame(read_scene(request), request.frames.empty() ? 0 : request.frames.front());
}

void explain(const RenderRequest& request) {
    const SceneDescription scene = read_frame(request);
    SceneSource source = gather_scene(scene);
    const Precision precision = warned_precision(request, source);
    print(explain_table(scene.source, explain_scene(std::move(source), precision), request.backend));
}

void measure_scene(const RenderRequest& request) {
    const ChosenDevices devices = choose_devices(request.backend, request.devices);
    const SceneDescription scene = read_frame(request);
    const FrameSettings settings = frame_settings(request, scene);
    StepProgress progress(request.quiet ? ProgressStyle::none : request.progress);  // must outlive what watches
    const StopOnInterrupt watch(progress.render.stop);
    on_threads(request, [&] {
        const StopSignal stop(progress.render.stop);
        SceneSource source = gather_scene(scene, stop);
        const Precision precision = warned_precision(request, source);
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
    SceneTalk talk(request);
    const Scene scene = compile_for(request, std::move(source), talk);
    PixelTree tree = make_embree_renderer(scene)->pixel_tree(camera, settings, request.pixel.x, request.pixel.y);
    const std::string flaws = describe_flags(tree.film.flags, tree.crowd);
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
    if (!request.json.empty()) write_output(request.json, pixel_json(report));
    if (!flaws.empty())
        throw Error(ErrorKind::failed, fmt::format("{}: pixel {},{} cannot be trusted: {}", description.source,
                                                   request.pixel.x, request.pixel.y, flaws));
}

/// Adds a file that is written to those that the scene is read from, and makes its folder. Throws Error where it is one
/// of them.
void claim_output(const RenderCommand& request, const SceneSource& source, const std::string& path,
                  const char* option) {
    if (path.empty() || path == "-") return;
    RunFiles files;
    files.reads_scene(request.scene, source.files);
    files.writes(path, option);
    make_directory_of(path);
}

void report_pixel(const RenderCommand& request) {
    const SceneDescription scene = read_frame(request);
    const FrameSettings settings = frame_settings(request, scene);
    const ChosenPixel& pixel = request.pixel;
    if (pixel.x >= settings.full_width || pixel.y >= settings.full_height)
        throw Error(ErrorKind::usage,
                    fmt::format("--pixel {},{}: is outside of the frame, which is {}x{}; its last pixel is {},{}",
                                pixel.x, pixel.y, settings.full_width, settings.full_height, settings.full_width - 1,
                                settings.full_height - 1));
    const CameraFrame camera = camera_at(scene.camera, request.frames.empty() ? 0 : request.frames.front());
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(threads_of(request)));
    SceneSource source = gather_scene(scene);
    claim_output(request, source, request.json, "--json");
    report_pixel(request, scene, std::move(source), settings, camera);
}

void write_explorer(const RenderCommand& request) {
    const SceneDescription description = read_frame(request);
    FrameSettings settings = frame_settings(request, description);
    const CameraFrame camera = camera_at(description.camera, request.frames.empty() ? 0 : request.frames.front());
    RenderProgress progress;  // must outlive what watches
    const StopOnInterrupt watch(progress.stop);
    const StopSignal stop(progress.stop);
    on_threads(request, [&] {
        SceneSource source = gather_scene(description, stop);
        claim_output(request, source, request.page, "--explore");
        const std::vector<Wireframe> bodies = wireframes(source);
        SceneTalk talk(request);
        const Scene scene = compile_for(request, std::move(source), talk);
        const auto make = [&] { return make_embree_renderer(scene); };
        Film film;
        const auto renderer = make();
        render_frame(*renderer, camera, settings, film, progress);
        stop.check();
        if (film.flags != 0)
            throw Error(ErrorKind::failed, fmt::format("frame {} cannot be trusted: {}", camera.frame,
                                                       describe_flags(film.flags, *renderer, description,
                                                                      scene.precision(), camera, settings)))
                .at(description.source);
        const Explorer explorer(scene, camera, settings);
        const Explorer::Page page =
            explorer.page(explorer.start(description.source, bodies, film), request.page_mb, make, stop);
        write_output(request.page, page.html);
        if (!request.quiet)
            note(fmt::format("render: {}: {:.2f} MB, the rays of one pixel in {} x {}", request.page,
                             static_cast<double>(page.html.size()) / 1e6, page.step, page.step));
    });
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
            return print(with_options(list_devices_text()));
        case Action::pixel:
            return report_pixel(request);
        case Action::explore:
            return write_explorer(request);
        case Action::measure:
            return measure_scene(request);
        case Action::explain:
            return explain(request);
        case Action::render:
            return render_scene(request, memory_advice);
    }
}

/// The style of --progress in a command line that may be wrong otherwise.
ProgressStyle style_in(int argc, const char* const* argv) {
    RenderRequest request;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const std::string option = "--progress";
        const std::string value = word == option && i + 1 < argc   ? argv[i + 1]
                                  : word.starts_with(option + "=") ? word.substr(option.size() + 1)
                                                                   : "";
        if (value == "json" || value == "openjd") request_key("progress").set(request, value);
    }
    return request.progress;
}

/// Runs, and tells programs that read the progress of an error that ends it.
void run_and_record(int argc, const char* const* argv, const std::function<void(SceneDescription&)>& described,
                    std::string& memory_advice) {
    try {
        RenderCommand command = parse_options(argc, argv);
        command.described = described;
        run(command, memory_advice);
    } catch (const std::exception& error) {
        const Failure failure = failure_of(error, memory_advice);
        const std::string lines =
            failure_record(style_in(argc, argv), with_options(failure.text), exit_code(failure.kind));
        if (!lines.empty()) std::fputs((lines + "\n").c_str(), stdout);
        std::fflush(stdout);
        throw;
    }
}

}  // namespace

int render_program(int argc, const char* const* argv, const std::function<void(SceneDescription&)>& described) {
    std::string memory_advice = "a smaller --res or --crop needs less";
    return run_program("render", memory_advice, [&] {
        run_and_record(argc, argv, described, memory_advice);
        return static_cast<int>(ExitCode::done);
    });
}

}  // namespace cistula
