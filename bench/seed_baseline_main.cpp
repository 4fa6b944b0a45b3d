// seed_baseline: times the course work's algorithm on scenes/benchmark.json, on the GPU or in its loop on the CPU.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "apps/common/build_info.h"
#include "apps/common/command_line.h"
#include "apps/common/machine.h"
#include "bench/seed_baseline_run.h"
#include "bench/seed_baseline_scene.h"
#include "scene/base/atomic_file.h"
#include "scene/image/picture_io.h"
#include "scene/image/raw_picture.h"
#include "scene/readers/read_scene.h"

namespace cistula::seed {
namespace {

using Json = nlohmann::ordered_json;

constexpr int warm_ups = 2;

struct Options {
    std::string scene = CISTULA_SOURCE_DIR "/scenes/benchmark.json", resolution = "3840x2160";
    std::vector<int> depths = {4, 8}, grids = {16, 64, 256};
    int repetitions = 0;  // 0: 20 on the GPU, 3 on the CPU
    bool cpu = false;
    std::string json, image, reference;
    int width = 0, height = 0;
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
    app.add_option("--image", options.image, "The picture, as a raw frame (.data); one depth only");
    app.add_option("--compare", options.reference,
                   "A picture by Cistula (.exr, .data) to compare with; one depth only");
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
    if (options.depths.size() != 1 && !(options.image.empty() && options.reference.empty()))
        fail_usage("--image and --compare are of one picture: give one --depth");
    if (options.repetitions == 0) options.repetitions = options.cpu ? 3 : 20;
}

Json context_of(const Options& options) {
    Json context = {{"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
                    {"host_name", host_name()},
                    {"executable", "seed_baseline"},
                    {"num_cpus", std::thread::hardware_concurrency()},
                    {"cpu", processor_name()},
                    {"commit", build_commit()},
                    {"scene", std::filesystem::path(options.scene).filename().string()},
                    {"resolution", {options.width, options.height}}};
    if (options.cpu) {
        context["compiler"] = __VERSION__;
        context["flags"] = SEED_HOST_FLAGS;
        return context;
    }
    const DeviceDescription device = describe_device();
    context["gpu"] = device.name;
    context["gpu_capability"] = fmt::format("{}.{}", device.major, device.minor);
    context["driver"] = gpu_driver_version();
    context["cuda_driver"] = device.driver;
    context["cuda_runtime"] = device.runtime;
    context["compiler"] = device.compiler;
    context["flags"] = SEED_CUDA_FLAGS;
    return context;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

Json entry(const std::string& name, const std::vector<double>& milliseconds) {
    const double time = median(milliseconds);
    const auto [least, most] = std::minmax_element(milliseconds.begin(), milliseconds.end());
    print(fmt::format("{:<36} {:10.3f} ms   {:.3f} to {:.3f}\n", name, time, *least, *most));
    return {{"name", name},
            {"run_name", name},
            {"run_type", "iteration"},
            {"iterations", milliseconds.size()},
            {"real_time", time},
            {"time_unit", "ms"},
            {"repetition_times", milliseconds}};
}

std::vector<Pixel> time_on_host(const Options& options, const OwnedScene& scene, const View& view, int depth,
                                const std::string& name, Json& records) {
    std::vector<Pixel> pixels(static_cast<size_t>(view.width) * static_cast<size_t>(view.height));
    std::vector<double> milliseconds;
    for (int i = 0; i < options.repetitions; ++i) {
        const auto start = std::chrono::steady_clock::now();
        render_on_host(depth, scene.view(), view, pixels.data());
        milliseconds.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    records.push_back(entry(name + "/cpu", milliseconds));
    return pixels;
}

std::vector<Pixel> time_on_device(const Options& options, const OwnedScene& scene, const View& view, int depth,
                                  const std::string& name, Json& records) {
    std::vector<Pixel> pixels;
    for (const int grid : options.grids) {
        DeviceRun run = render_on_device(depth, grid, warm_ups, options.repetitions, scene, view);
        Json record = entry(fmt::format("{}/grid:{}", name, grid), run.milliseconds);
        record["warm_ups"] = warm_ups;
        record["registers"] = run.registers;
        record["local_bytes"] = run.local_bytes;
        records.push_back(record);
        if (!pixels.empty() && pixels != run.pixels)
            throw Error(ExitCode::failed, fmt::format("{}: the picture of grid {} is another one", name, grid));
        pixels = std::move(run.pixels);
    }
    return pixels;
}

void use_picture(const Options& options, const ColorPicture& picture, Json& record) {
    if (!options.image.empty()) write_raw_picture(options.image, picture);
    if (options.reference.empty()) return;
    const ColorPicture reference = read_texture(options.reference);
    if (reference.width != picture.width || reference.height != picture.height)
        fail_usage(fmt::format("--compare {}: is {}x{} and this picture {}x{}; they must be of one size",
                               options.reference, reference.width, reference.height, picture.width, picture.height));
    const Difference difference = compare(picture, reference);
    print(fmt::format("{}: mean absolute difference {:.4f}/255, {:.3f} % of the pixels within 2/255, worst {}/255\n",
                      options.reference, difference.mean, 100 * difference.within, difference.worst));
    record["comparison"] = {{"mean_difference", difference.mean / 255},
                            {"share_within_2_of_255", difference.within},
                            {"worst_difference", difference.worst / 255.0}};
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
    std::vector<Pixel> pixels;
    for (const int depth : options.depths) {
        const std::string name = fmt::format("seed/{}x{}/depth:{}", view.width, view.height, depth);
        const auto time = options.cpu ? time_on_host : time_on_device;
        pixels = time(options, scene, view, depth, name, record["benchmarks"]);
    }
    use_picture(options, picture_of(view, pixels), record);
    if (!options.json.empty()) write_file_atomically(options.json, record.dump(2) + "\n");
    return 0;
}

}  // namespace
}  // namespace cistula::seed

int main(int argc, char** argv) {
    return cistula::run_program("seed_baseline", "a smaller --res needs less",
                                [&] { return cistula::seed::run(argc, argv); });
}
