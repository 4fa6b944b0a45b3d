// seed_baseline: times the course work's algorithm on scenes/benchmark.json, on the GPU or in its loop on the CPU.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/common/command_line.h"
#include "base/atomic_file.h"
#include "base/timing.h"
#include "bench/seed_baseline_run.h"
#include "bench/seed_baseline_scene.h"
#include "scene/readers/read_scene.h"
#include "sequence/run_context.h"

namespace cistula::seed {
namespace {

using Json = nlohmann::ordered_json;

constexpr int warm_ups = 2;

struct Options {
    std::string scene = CISTULA_SOURCE_DIR "/scenes/benchmark.json";
    std::string resolution = "3840x2160";
    std::vector<int> depths = {4, 8};
    std::vector<int> grids = {16, 64, 256};
    int repetitions = 0;  // 0: 20 on the GPU, 3 on the CPU
    bool cpu = false;
    std::string json;
    int width = 0;
    int height = 0;
};

void declare(CLI::App& app, Options& options) {
    app.add_option("--scene", options.scene, "Scene file");
    app.add_option("--res", options.resolution, "Picture, WIDTHxHEIGHT")->capture_default_str();
    app.add_option("--depth", options.depths, "Depths, of 1, 2, 4 and 8, between commas")
        ->delimiter(',')
        ->check(CLI::IsMember(std::vector<int>(std::begin(depths), std::end(depths))))
        ->capture_default_str();
    app.add_option("--grid", options.grids, "G for grids of G x G blocks of 16 x 16 threads, between commas")
        ->delimiter(',')
        ->check(CLI::Range(1, 65535))
        ->capture_default_str();
    app.add_option("--repetitions", options.repetitions, "Timed runs after warm-up (20; of the CPU's loop 3)")
        ->check(CLI::Range(1, 100000));
    app.add_flag("--cpu", options.cpu, "The loop on the CPU, one thread, instead of the GPU");
    app.add_option("--json", options.json, "Record, in the shape of Google Benchmark's");
}

void check(Options& options) {
    const std::string& text = options.resolution;
    const size_t x = std::min(text.find('x'), text.size());
    const auto width = whole_number<int>(text.substr(0, x));
    const auto height = whole_number<int>(x < text.size() ? text.substr(x + 1) : "");
    if (!width || !height || *width < 1 || *height < 1 || *width > 16384 || *height > 16384)
        fail_usage(fmt::format("--res {}: must be WIDTHxHEIGHT, each from 1 to 16384, as in 1280x720", text));
    options.width = *width;
    options.height = *height;
    if (options.repetitions == 0) options.repetitions = options.cpu ? 3 : 20;
}

Json context_of(const Options& options) {
    Json context = run_context("seed_baseline");
    context["scene"] = std::filesystem::path(options.scene).filename().string();
    context["resolution"] = {options.width, options.height};
    context["flags"] = options.cpu ? SEED_HOST_FLAGS : SEED_CUDA_FLAGS;
    if (options.cpu) return context;
    const DeviceDescription device = describe_device();
    context["gpu"] = device.name;
    context["gpu_capability"] = fmt::format("{}.{}", device.major, device.minor);
    context["driver"] = gpu_driver_version();
    context["cuda_driver"] = device.driver;
    context["cuda_runtime"] = device.runtime;
    context["compiler"] = device.compiler;
    return context;
}

Json entry(const std::string& name, const Timing& time) {
    print(fmt::format("{:<36} {:10.3f} ms   {:.3f} to {:.3f}\n", name, time.median(), time.least(), time.most()));
    return {{"name", name},
            {"run_name", name},
            {"run_type", "iteration"},
            {"iterations", time.runs.size()},
            {"real_time", time.median()},
            {"time_unit", "ms"},
            {"repetition_times", time.runs}};
}

void time_on_host(const Options& options, const OwnedScene& scene, const View& view, int depth, const std::string& name,
                  Json& records) {
    std::vector<Pixel> pixels(static_cast<size_t>(view.width) * static_cast<size_t>(view.height));
    Timing time;
    for (int i = 0; i < options.repetitions; ++i)
        time.runs.push_back(1e3 * seconds_of([&] { render_on_host(depth, scene.view(), view, pixels.data()); }));
    records.push_back(entry(name + "/cpu", time));
}

void time_on_device(const Options& options, const OwnedScene& scene, const View& view, int depth,
                    const std::string& name, Json& records) {
    std::vector<Pixel> pixels;
    for (const int grid : options.grids) {
        DeviceRun run = render_on_device(depth, grid, warm_ups, options.repetitions, scene, view);
        records.push_back(entry(fmt::format("{}/grid:{}", name, grid), run.time));
        if (!pixels.empty() && pixels != run.pixels)
            throw Error(ErrorKind::failed, fmt::format("{}: the picture of grid {} is another one", name, grid));
        pixels = std::move(run.pixels);
    }
}

int run(int argc, char** argv) {
    CLI::App app(
        "Times the algorithm of the course work that Cistula grew from: double precision, every ray against every "
        "triangle, template recursion.",
        "seed_baseline");
    Options options;
    declare(app, options);
    const auto extra = [](const std::string& text) { return text + ": only options are taken; --help lists them"; };
    if (!parse_command_line(app, argc, argv, extra)) {
        print(app.help());
        return 0;
    }
    check(options);
    Json record = {{"context", context_of(options)}, {"benchmarks", Json::array()}};
    const SceneDescription description = read_scene(options.scene);
    const OwnedScene scene = make_scene(description);
    const View view = make_view(camera_at(description.camera, 0), options.width, options.height);
    for (const int depth : options.depths) {
        const std::string name = fmt::format("seed/{}x{}/depth:{}", view.width, view.height, depth);
        const auto time = options.cpu ? time_on_host : time_on_device;
        time(options, scene, view, depth, name, record["benchmarks"]);
    }
    if (!options.json.empty()) write_file_atomically(options.json, record.dump(2) + "\n");
    return 0;
}

}  // namespace
}  // namespace cistula::seed

int main(int argc, char** argv) {
    return cistula::run_program("seed_baseline", "a smaller --res needs less",
                                [&] { return cistula::seed::run(argc, argv); });
}
