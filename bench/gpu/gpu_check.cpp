// gpu_check: whether the GPU computes the same bits as the CPU, and how fast. `make gpu-check` runs it.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>

#include "apps/common/command_line.h"
#include "backend_cuda/host/cuda_renderer.h"
#include "bench/gpu/frame_times.h"
#include "testing/parity/function_parity.h"
#include "testing/parity/image_parity.h"
#include "testing/parity/record.h"

namespace cistula::bench {
namespace {

struct Options {
    std::string folder = ".", json;
    uint64_t functions = 0;
    uint64_t generated = 0;
    bool scenes = false;
    bool times = false;
    bool devices = false;
    int runs = 20;
};

int run(const Options& options) {
    GpuRecord record;
    if (options.times) time_frames(record, options.folder, options.runs);
    if (options.devices) time_devices(record, options.folder, 5);
    if (options.functions > 0)
        for (const FunctionParity& f : check_functions(options.functions, 1))
            record.add_parity(fmt::format("functions/{}/{}", f.name, f.precision), f.compared, f.differing,
                              {{"first", f.first_difference}});
    if (options.scenes) check_scenes(record, options.folder);
    if (options.generated > 0) check_generated(record, options.folder, options.generated);
    if (!options.json.empty()) record.write(options.json);
    fmt::print("{} values compared, {}\n", record.compared(), record.equal() ? "all equal" : "NOT ALL EQUAL");
    return int(record.equal() ? ExitCode::done : ExitCode::failed);
}

}  // namespace
}  // namespace cistula::bench

int main(int argc, char** argv) {
    using namespace cistula;
    bench::Options options;
    CLI::App app("Compares the GPU with the CPU, bit for bit, and times it.", "gpu_check");
    app.add_option("--folder", options.folder, "where scenes/ and golden/ lie");
    app.add_option("--functions", options.functions, "inputs of each function's comparison");
    app.add_flag("--scenes", options.scenes, "compare all of scenes/, and with golden/");
    app.add_option("--generated", options.generated, "generated scenes to compare");
    app.add_flag("--times", options.times, "time frames");
    app.add_flag("--devices", options.devices, "time a heavy frame on one GPU, two, ... all");
    app.add_option("--runs", options.runs, "runs of each, after warm-up")->check(CLI::Range(1, 10000));
    app.add_option("--json", options.json, "where the record goes");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : int(ExitCode::usage);
    }
    try {
        return bench::run(options);
    } catch (const Error& error) {
        std::fprintf(stderr, "gpu_check: %s\n", error.what());
        return int(exit_code(error.kind()));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gpu_check: %s\n", error.what());
        return int(ExitCode::failed);
    }
}
