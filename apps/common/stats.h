// The JSON written by --stats, in Google Benchmark's format: one entry per phase and frame, and a context.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "apps/common/film_options.h"
#include "apps/common/frame_list.h"
#include "apps/common/target.h"
#include "scene/base/atomic_file.h"
#include "scene/film/film.h"
#include "scene/film/renderer.h"

namespace cistula {

/// Error bounds of a frame from one cause: mean over its pixels and largest pixel, per channel, in the scene's units of
/// radiance.
struct LedgerTotals {
    std::array<double, 3> mean{}, worst{};
};

struct FrameStats {
    int frame = 0;
    std::string file, hash;  // hash: of the film's integers
    int width = 0, height = 0;
    double render_seconds = 0, encode_seconds = 0, write_seconds = 0;
    RenderTimes device;  // zeros for backends without devices
    RayCounts rays;
    LedgerTotals pruned, cut;  // error bounds of branches pruned by the cutoff, and cut by the depth limit
    TargetReport target;       // for frames with a target error
    uint64_t clamped = 0;      // values of the file that were over the largest half
};

/// Sums over the frames of a film that were written.
struct FilmTotals {
    uint64_t frames = 0, pixels = 0, rays = 0;
    double render_seconds = 0;
    uint64_t clamped = 0, clamped_frames = 0;  // values over the largest half, frames that have any
    TargetReport target;
    std::string first_file;

    void add(const FrameStats& frame);
};

struct RunStats {
    double read_seconds = 0, compile_seconds = 0, tree_seconds = 0;
    std::string scene, scene_hash, intersector, driver;
    std::vector<std::string> devices;            // GPUs; empty, like the driver, if none is used
    uint32_t required_effects = 0, effects = 0;  // masks
    size_t scene_bytes = 0;                      // geometry, trees and shading data
    int threads = 0, lanes = 1;
    FilmTotals totals;
    FrameList resumed;  // frames that --resume skipped
};

/// The totals of one of the error ledgers over the pixels of a film.
LedgerTotals ledger_totals(const Film& film, int64_t (PixelRecord::*ledger)[3]);

/// The file of --stats, which is written while the film renders: its frames take no memory. It is complete or, without
/// finish(), not there.
class StatsFile {
  public:
    StatsFile(const std::string& path, const FrameSettings& settings, bool has_device);

    /// Adds the entry of a phase or of a frame to the benchmarks.
    void add_phase(const std::string& name, double seconds);
    void add(const FrameStats& frame);

    /// Adds the context and puts the file in its place. Throws Error (file), as all of these.
    void finish(const RunStats& stats, const FilmOptions& options);

  private:
    void add_entry(const std::string& json);

    AtomicFile file_;
    const FrameSettings settings_;
    const bool has_device_;
    bool is_empty_ = true;
};

}  // namespace cistula
