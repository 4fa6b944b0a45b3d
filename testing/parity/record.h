// The record that gpu_check writes: Google Benchmark's JSON, with the parity of host and device beside the times.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cistula::bench {

using Json = nlohmann::ordered_json;

class GpuRecord {
  public:
    /// Starts a record with its context: GPU, driver, host, compiler, flags, commit.
    explicit GpuRecord(const std::string& program = "gpu_check");

    /// Adds a benchmark of several runs: median, least and most, all runs. Prints a line.
    void add_times(const std::string& name, const std::vector<double>& milliseconds, Json more = Json::object());

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

double median_of(std::vector<double> values);

}  // namespace cistula::bench
