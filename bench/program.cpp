#include "program.h"

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <exception>
#include <memory>

#include "apps/common/command_line.h"
#include "base/machine.h"

namespace cistula::bench {

std::string output_of(const std::string& command) {
    const auto close = [](FILE* stream) { pclose(stream); };
    std::unique_ptr<FILE, decltype(close)> pipe(popen((command + " 2>&1").c_str(), "r"), close);
    if (!pipe) throw Error(ErrorKind::failed, "cannot run " + command);
    std::string text;
    std::array<char, 4096> buffer;
    while (const size_t count = fread(buffer.data(), 1, buffer.size(), pipe.get())) text.append(buffer.data(), count);
    const int status = pclose(pipe.release());
    if (status == 0) return text;
    while (!text.empty() && text.back() == '\n') text.pop_back();
    const size_t line = text.rfind('\n');
    throw Error(ErrorKind::failed, command + " failed: " + (line == text.npos ? text : text.substr(line + 1)));
}

double peak_memory() {
    return std::stod(table_value("/proc/self/status", "VmHWM")) * 1024;
}

int run_program(int argc, char** argv, int repetitions, void (*register_all)(const std::vector<std::string>&)) {
    std::vector<std::string> flags = {argv[0], "--benchmark_repetitions=" + std::to_string(repetitions),
                                      "--benchmark_enable_random_interleaving=true",
                                      "--benchmark_display_aggregates_only=true"};
    flags.insert(flags.end(), argv + 1, argv + argc);
    std::vector<char*> pointers;
    for (std::string& flag : flags) pointers.push_back(flag.data());
    int count = int(pointers.size());
    benchmark::Initialize(&count, pointers.data());
    std::vector<std::string> arguments;
    for (int i = 1; i < count; ++i) {
        arguments.emplace_back(pointers[size_t(i)]);
        if (arguments.back().rfind("-", 0) == 0) {
            fprintf(stderr, "%s: unknown option %s; --help shows those there are\n", argv[0], arguments.back().c_str());
            return int(ExitCode::usage);
        }
    }
    benchmark::AddCustomContext("cpu", processor_name());
    benchmark::AddCustomContext("compiler", __VERSION__);
    benchmark::AddCustomContext("flags", build_flags());
    benchmark::AddCustomContext("commit", build_commit());
    try {
        register_all(arguments);
        benchmark::RunSpecifiedBenchmarks();
        benchmark::Shutdown();
    } catch (const Error& error) {
        fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return int(exit_code(error.kind()));
    } catch (const std::exception& error) {
        fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return int(ExitCode::failed);
    }
    return int(ExitCode::done);
}

}  // namespace cistula::bench
