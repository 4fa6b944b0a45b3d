// gpu_check_fast: the times of gpu_check's frames with approximate arithmetic, to know what exactness costs. Its images
// are worth nothing, and so nobody sees them.
#include <CLI/CLI.hpp>

#include <cstdio>

#include "apps/common/command_line.h"
#include "backend_cuda/host/cuda_renderer.h"
#include "bench/gpu/frame_times.h"

int main(int argc, char** argv) {
    using namespace cistula;
    std::string folder = ".", json;
    bool times = false;
    int runs = 20;
    CLI::App app("Times frames whose arithmetic is approximate.", "gpu_check_fast");
    app.add_option("--folder", folder, "where scenes/ lies");
    app.add_flag("--times", times, "time frames")->required();
    app.add_option("--runs", runs, "runs of each, after warm-up")->check(CLI::Range(1, 10000));
    app.add_option("--json", json, "where the record goes");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : int(ExitCode::usage);
    }
    try {
        bench::GpuRecord record("gpu_check_fast");
        bench::time_frames(record, folder, runs);
        if (!json.empty()) record.write(json);
        return int(ExitCode::done);
    } catch (const Error& error) {
        std::fprintf(stderr, "gpu_check_fast: %s\n", error.what());
        return int(exit_code(error.kind()));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gpu_check_fast: %s\n", error.what());
        return int(ExitCode::failed);
    }
}
