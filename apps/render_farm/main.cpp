// render-farm: writes a film as tasks for many machines.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <filesystem>

#include "apps/common/command_line.h"
#include "apps/common/interrupt.h"
#include "backend_embree/embree/embree_renderer.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "job_files.h"
#include "measure.h"
#include "options.h"
#include "render/record/film_picture.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_source.h"
#include "scene/compile/solids/smallest_part.h"
#include "sequence/sequence_loop.h"

namespace cistula {
namespace {

namespace fs = std::filesystem;

/// The name of a job: letters, digits and a few signs of the scene's name.
std::string job_name(const std::string& scene) {
    constexpr size_t longest = 60;
    std::string name;
    for (const char c : fs::path(scene).stem().string().substr(0, longest))
        name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.' ? c : '_';
    return name.empty() || name[0] == '-' ? "film" + name : name;
}

std::string folder_of_programs() {
    std::error_code error;
    return fs::read_symlink("/proc/self/exe", error).parent_path().string();
}

void check_output(const RenderRequest& request, const OutputName& output, const std::vector<int>& frames) {
    if (file_kind(output.text()) == FileKind::raw)
        throw Error(ErrorKind::usage,
                    fmt::format("-o {}: tasks go on from what is complete, and raw frames do not say what they show; "
                                "name it *.exr",
                                output.text()));
    preview_name(request.preview, frames);
}

/// The names of the film's images, as sha256sum reads them from xargs -0: a zero byte after each.
std::string names_of_files(const OutputName& output, const std::vector<int>& frames,
                           const std::vector<std::string>& layers) {
    std::string text;
    const auto add = [&](const std::string& path) { text += path + '\0'; };
    for (size_t i = 0; i < frames.size(); ++i) {
        add(output.for_frame(frames[i]));
        for (const std::string& layer : layers) add(output.for_layer(frames[i], layer));
    }
    return text;
}

void write_job(const FarmOptions& farm) {
    const RenderRequest& request = farm.render;
    const SceneDescription scene = read_scene(request);
    const FrameSettings settings = frame_settings(request, scene);
    const OutputName output(request.output.empty() ? default_output(scene, request.frames.size()) : request.output,
                            "-o");
    const std::vector<int> frames = frames_to_render(output, request.frames, scene.film.frames);
    check_output(request, output, frames);
    const TileGrid grid = request.tiles.value_or(TileGrid());
    (void)tile_rect(settings.crop, grid, 0);

    StepProgress progress(request.quiet ? ProgressStyle::none : ProgressStyle::automatic);
    InterruptGuard guard;
    guard.watch(progress.render.stop);
    const std::optional<tbb::global_control> limit =
        request.threads > 0
            ? std::optional<tbb::global_control>(std::in_place, tbb::global_control::max_allowed_parallelism,
                                                 static_cast<size_t>(request.threads))
            : std::nullopt;
    const Scene compiled(scene, request.precision, progress.render.stop);
    require_light_layers(request.channels, *compiled.layer_names());
    const std::unique_ptr<Renderer> renderer = make_embree_renderer(compiled);
    const MeasuredFrames measured = measure_tiles(*renderer, scene, settings, frames, grid, progress);

    const OutputName none;
    SequenceEvents nothing;
    SequenceJob job{request, scene, FrameHashes(), settings, output, none, frames, nothing, compiled.precision()};
    job.layer_names = compiled.layer_names();
    FarmJob farm_job{job_name(request.scene),
                     fs::current_path().string(),
                     folder_of_programs(),
                     request.scene,
                     output.text(),
                     farm.passed,
                     farm.merged,
                     request.tiles,
                     frames,
                     {}};
    farm_job.tasks = plan_tasks(frames, static_cast<size_t>(grid.count()), measured, farm.task_seconds,
                                static_cast<size_t>(farm.most_tasks));
    const std::string folder = farm.folder.empty() ? farm_job.name + ".farm" : farm.folder;
    double seconds = 0;
    for (const FarmTask& task : farm_job.tasks) seconds += task.seconds;
    std::vector<JobFile> files = job_files(farm_job);
    files.push_back({"files.txt", names_of_files(output, frames, layers_with_files(job))});
    for (const JobFile& file : files) {
        const std::string path = (fs::path(folder) / file.name).string();
        make_directory_of(path);
        write_file_atomically(path, file.text);
    }
    if (!request.quiet)
        progress.say(fmt::format("render-farm: {}: {} tasks, {} frames, {} tiles each; about {} on this machine",
                                 folder, farm_job.tasks.size(), frames.size(), grid.count(), format_duration(seconds)));
}

void run(const FarmOptions& options) {
    switch (options.action) {
        case FarmAction::print_help:
            return print(farm_help_text());
        case FarmAction::print_version:
            return print("render-farm (Cistula) " CISTULA_VERSION "\n");
        case FarmAction::write:
            return write_job(options);
    }
}

}  // namespace
}  // namespace cistula

int main(int argc, char** argv) {
    using namespace cistula;
    return run_program("render-farm", "a smaller --res needs less", [&] {
        run(parse_farm_options(argc, argv));
        return static_cast<int>(ExitCode::done);
    });
}
