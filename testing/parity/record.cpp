#include "testing/parity/record.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <thread>

#include "apps/common/build_info.h"
#include "apps/common/machine.h"
#include "backend_cuda/host/cuda_renderer.h"
#include "scene/base/atomic_file.h"

namespace cistula::bench {
double median_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const size_t half = values.size() / 2;
    return values.size() % 2 != 0 ? values[half] : (values[half - 1] + values[half]) / 2;
}

GpuRecord::GpuRecord(const std::string& program) {
    Json gpus = Json::array();
    for (const CudaDevice& device : list_cuda_devices())
        gpus.push_back({{"name", device.name},
                        {"capability", fmt::format("{}.{}", device.major, device.minor)},
                        {"memory_bytes", device.memory},
                        {"multiprocessors", device.multiprocessors}});
    all_["context"] = {{"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
                       {"executable", program},
                       {"gpu", gpus},
                       {"driver", gpu_driver_version()},
                       {"driver_cuda", cuda_driver_version()},
                       {"cpu", processor_name()},
                       {"num_cpus", std::thread::hardware_concurrency()},
                       {"compiler", __VERSION__},
                       {"cuda_compiler", CISTULA_CUDA_COMPILER},
                       {"flags", build_flags()},
                       {"cuda_flags", CISTULA_CUDA_FLAGS},
                       {"commit", build_commit()}};
    all_["benchmarks"] = Json::array();
    all_["parity"] = {{"compared", 0}, {"differing", 0}, {"cases", Json::array()}};
}

void GpuRecord::add_times(const std::string& name, const std::vector<double>& milliseconds, Json more) {
    const auto [least, most] = std::minmax_element(milliseconds.begin(), milliseconds.end());
    Json entry = {{"name", name},
                  {"run_name", name},
                  {"run_type", "iteration"},
                  {"iterations", milliseconds.size()},
                  {"real_time", median_of(milliseconds)},
                  {"time_unit", "ms"},
                  {"least", *least},
                  {"most", *most},
                  {"runs", milliseconds}};
    entry.update(more);
    fmt::print("{:<64} {:9.4f} ms  {:.4f} to {:.4f}\n", name, median_of(milliseconds), *least, *most);
    std::fflush(stdout);
    all_["benchmarks"].push_back(std::move(entry));
}

void GpuRecord::add_parity(const std::string& name, uint64_t compared, uint64_t differing, Json more) {
    Json entry = {{"case", name}, {"compared", compared}, {"differing", differing}};
    entry.update(more);
    if (differing != 0) fmt::print("{}: {} of {} differ {}\n", name, differing, compared, more.dump());
    all_["parity"]["cases"].push_back(std::move(entry));
    compared_ += compared;
    differing_ += differing;
    all_["parity"]["compared"] = compared_;
    all_["parity"]["differing"] = differing_;
}

void GpuRecord::write(const std::string& path) const {
    write_file_atomically(path, all_.dump(2) + "\n");
}

}  // namespace cistula::bench
