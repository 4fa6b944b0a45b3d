// What --stats records: Google Benchmark's shape, a context and one entry per phase and frame.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "options.h"
#include "scene/film.h"
#include "scene/renderer.h"
#include "target.h"

namespace cistula {

/// Of one ledger over a frame: the mean and the largest pixel, per channel, in the scene's units of radiance.
struct LedgerTotals {
    std::array<double, 3> mean{}, worst{};
};

struct FrameStats {
    int frame = 0;
    std::string file, hash;  // hash: of the film's integers
    int width = 0, height = 0;
    double render_seconds = 0, encode_seconds = 0, write_seconds = 0;
    RenderTimes device;  // of a backend that has them
    RayCounts rays;
    LedgerTotals pruned, cut;  // by the cutoff, by the depth limit
    TargetReport target;       // where there is a target error
};

struct RunStats {
    double read_seconds = 0, compile_seconds = 0, tree_seconds = 0;
    std::string scene, scene_hash, intersector, driver;
    std::vector<std::string> devices;            // GPUs; empty, as the driver, where none is used
    uint32_t required_effects = 0, effects = 0;  // masks
    size_t scene_bytes = 0;                      // geometry, trees and shading data
    int threads = 0;
    std::vector<FrameStats> frames;
    std::vector<int> resumed;  // frames that --resume left alone
};

/// Sums over the pixels of a film.
LedgerTotals ledger_totals(const Film& film, int64_t (PixelRecord::*ledger)[3]);

/// The JSON text.
std::string stats_json(const RunStats& stats, const FrameSettings& settings, const RenderOptions& options);

/// Seconds that `work` takes.
template <class Work>
double seconds_of(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace cistula
