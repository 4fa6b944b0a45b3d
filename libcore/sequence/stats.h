// The JSON written by --stats, in Google Benchmark's format: one entry per frame, and a context with the stages.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "render/record/film.h"
#include "render/renderer.h"
#include "render/target.h"
#include "sequence/backends.h"
#include "sequence/frame_list.h"
#include "sequence/render_request.h"

namespace cistula {

/// Error bounds of a frame from one cause: mean over its pixels and largest pixel, per channel, in the scene's units of
/// radiance.
struct LedgerTotals {
    std::array<double, 3> mean{}, worst{};
};

/// What the depth may have taken from a frame, beside its brightness: the largest channels.
struct DepthLoss {
    double mean = 0, worst = 0;  // of the ledger
    double brightness = 0;       // mean radiance

    /// The loss in means of the picture that count: 1 or more is seen.
    double share() const { return std::max(64 * mean, worst) / brightness; }
    /// Whether the mean lost a step of six bits or more, or a pixel as much as the picture has in the mean.
    bool is_seen() const { return std::max(64 * mean, worst) > brightness; }
};

struct FrameStats {
    int frame = 0;
    std::string file, hash;  // hash: of the film's integers
    int width = 0;
    int height = 0;
    double render_seconds = 0, encode_seconds = 0, write_seconds = 0;
    RenderTimes device;  // zeros for backends without devices
    RayCounts rays;
    LedgerTotals pruned, cut;  // error bounds of branches pruned by the cutoff, and cut by the depth limit
    LedgerTotals units;        // error bounds of whole units of the sums
    DepthLoss depth_loss;      // for frames without a target error
    TargetReport target;       // for frames with a target error
    uint64_t clamped = 0;      // values of the file that were over the largest half
};

/// Sums over the frames of a sequence that were written.
struct SequenceTotals {
    uint64_t frames = 0;
    uint64_t pixels = 0;
    uint64_t rays = 0;
    double render_seconds = 0;
    // values over the largest half, frames that have any
    uint64_t clamped = 0;
    uint64_t clamped_frames = 0;
    TargetReport target;
    uint64_t dark_frames = 0;  // in which is seen what the depth took
    DepthLoss depth_loss;      // of the worst of them
    int depth_loss_frame = 0;
    std::string first_file;

    void add(const FrameStats& frame);
};

struct RunStats {
    Backend backend = Backend::embree;
    Precision precision = Precision::single_;
    std::string scene, scene_hash, intersector, driver;
    std::string images;                // the name or pattern of the frames' files
    double seconds = 0;                // from the first frame to the last file
    std::vector<std::string> devices;  // GPUs; empty, like the driver, if none is used
    // masks
    uint32_t required_effects = 0;
    uint32_t effects = 0;
    size_t scene_bytes = 0;  // geometry, trees and shading data
    int threads = 0;
    int lanes = 1;
    SequenceTotals totals;
    std::vector<int> resumed;  // frames that --resume skipped
};

/// The totals of one of the error ledgers over the pixels of a film: what a film's totals of it are in the scene's
/// units.
LedgerTotals ledger_totals(const Film& film, const Total (&ledger)[3]);

/// The totals of what whole units of the sums may have taken.
LedgerTotals unit_totals(const Film& film);

/// What the depth may have taken, from the totals of `cut` and of the radiance.
DepthLoss depth_loss(const LedgerTotals& cut, const LedgerTotals& radiance);

/// One line on the frame of a sequence in which the depth took the most; empty where it is not seen. `film`: the name
/// of the frames' files.
std::string describe_depth_loss(const SequenceTotals& totals, const std::string& film, int depth);

/// The file of --stats, which is written while the film renders: its frames take no memory. It is complete or, without
/// finish(), not there.
class StatsFile {
  public:
    StatsFile(const std::string& path, const FrameSettings& settings, bool has_device);

    /// Adds the entry of a frame to the benchmarks.
    void add(const FrameStats& frame);

    /// Adds the context, with the stages until now, and puts the file in its place. Throws Error (file), as all of
    /// these.
    void finish(const RunStats& stats);

  private:
    AtomicFile file_;
    const FrameSettings settings_;
    const bool has_device_;
    bool is_empty_ = true;
};

}  // namespace cistula
