#include "testing/parity/record.h"

#include <fmt/format.h>

#include "backend_cuda/host/cuda_renderer.h"
#include "base/atomic_file.h"
#include "sequence/run_context.h"

namespace cistula::bench {

GpuRecord::GpuRecord(const char* program) {
    Json& context = all_["context"] = run_context(program);
    for (const CudaDevice& device : list_cuda_devices()) context["devices"].push_back(device.name);
    context["driver"] = cuda_driver_version();
    context["gpu_driver"] = gpu_driver_version();
    context["cuda_compiler"] = CISTULA_CUDA_COMPILER;
    context["cuda_flags"] = CISTULA_CUDA_FLAGS;
    all_["benchmarks"] = Json::array();
    all_["parity"] = {{"compared", 0}, {"differing", 0}, {"cases", Json::array()}};
}

void GpuRecord::add_times(const std::string& name, const Timing& time, Json more) {
    Json entry = {{"name", name},
                  {"run_name", name},
                  {"run_type", "iteration"},
                  {"iterations", time.runs.size()},
                  {"real_time", time.median()},
                  {"time_unit", "ms"},
                  {"repetition_times", time.runs}};
    entry.update(more);
    fmt::print("{:<64} {:9.4f} ms  {:.4f} to {:.4f}\n", name, time.median(), time.least(), time.most());
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
