// What the benchmark programs share: Google Benchmark with a full context, interleaved repetitions and plain errors.
#pragma once

#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>
#include <vector>

namespace cistula::bench {

/// Runs the registered benchmarks as `repetitions` repetitions each, interleaved, so that a noisy minute of the machine
/// hits all of them alike. The command line comes last and wins. `register_all` gets the arguments that are not flags.
/// Returns the exit code.
int run_program(int argc, char** argv, int repetitions,
                void (*register_all)(const std::vector<std::string>& arguments));

/// Standard output and standard error of a command of the shell together. Throws Error (failed) with its last line if
/// it does not exit with 0.
std::string output_of(const std::string& command);

/// Largest resident set of this process so far, in bytes (VmHWM).
double peak_memory();

inline std::filesystem::path scene_file(const std::string& name) {
    return std::filesystem::path(CISTULA_SOURCE_DIR) / "scenes" / name;
}

}  // namespace cistula::bench
