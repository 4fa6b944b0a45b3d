// The context that programs' records begin with: date, machine and build.
#pragma once

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <ctime>
#include <thread>

#include "base/machine.h"

namespace cistula {

inline nlohmann::ordered_json run_context(const char* executable) {
    return {{"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
            {"host_name", host_name()},
            {"executable", executable},
            {"num_cpus", std::thread::hardware_concurrency()},
            {"cpu", processor_name()},
            {"compiler", __VERSION__},
            {"flags", build_flags()},
            {"commit", build_commit()},
            {"cistula_version", CISTULA_VERSION}};
}

}  // namespace cistula
