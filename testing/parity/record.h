// The record that gpu_check writes: Google Benchmark's JSON, with the parity of host and device beside the times.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "base/timing.h"

namespace cistula::bench {

using Json = nlohmann::ordered_json;

class GpuRecord {
  public:
    /// Starts a record with its context: GPU, driver, host, compiler, flags, commit.
    explicit GpuRecord(const char* program = "gpu_check");

    /// Adds a benchmark of several runs: their median and all of them. Prints a line.
    void add_times(const std::string& name, const Timing& time, Json more = Json::object());

    /// Adds a comparison of host and device. Prints a line if they differ.
    void add_parity(const std::string& name, uint64_t compared, uint64_t differing, Json more = Json::object());

    /// Whether no comparison found a difference.
    bool equal() const { return differing_ == 0; }
    uint64_t compared() const { return compared_; }
    void write(const std::string& path) const;

  private:
    Json all_;
    uint64_t compared_ = 0, differing_ = 0;
};

}  // namespace cistula::bench
