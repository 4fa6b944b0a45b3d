#include "apps/common/target.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "apps/common/stats.h"
#include "cistula/adaptive/path_hash.h"
#include "cistula/model/lattice_settings.h"

namespace cistula {

void TargetReport::add(const TargetReport& other) {
    samples += other.samples;
    truncated += other.truncated;
    bushy += other.bushy;
    undersampled += other.undersampled;
    rounded += other.rounded;
    missed += other.missed;
    worst_truncation = std::max(worst_truncation, other.worst_truncation);
}

TargetReport target_report(const Film& film, const FrameSettings& settings) {
    TargetReport report;
    const double unit = film.unit();
    // If rounding moves an edge by some share of the pixel's width, the pixel changes by that share of the radiance on
    // its brighter side: at most twice the pixel's radiance, if the edge halves it and the other side is black.
    const double worth = 2 * film.rounding * unit / settings.target_error;
    for (const PixelRecord& pixel : film.pixels) {
        double truncation = 0, pruned = 0;
        for (int c = 0; c < 3; ++c) {
            pruned = std::max(pruned, static_cast<double>(pixel.pruned[c]) * unit);
            truncation = std::max(truncation, static_cast<double>(pixel.pruned[c] + pixel.cut[c]) * unit);
        }
        const bool truncated = truncation > settings.truncation();
        report.samples += pixel.samples;
        report.truncated += truncated;
        report.bushy += pruned > settings.truncation();
        report.undersampled += pixel.unmet;
        const int64_t brightest = *std::max_element(pixel.radiance, pixel.radiance + 3);
        const bool rounded = pixel.samples > least_lattice_samples &&
                             static_cast<double>(pixel.z) < worth * static_cast<double>(brightest);
        report.rounded += rounded;
        report.missed += truncated || pixel.unmet || rounded;
        report.worst_truncation = std::max(report.worst_truncation, truncation);
    }
    return report;
}

std::string describe_target(const std::vector<FrameStats>& frames, const FrameSettings& settings, Precision precision) {
    TargetReport all;
    uint64_t pixels = 0;
    for (const FrameStats& frame : frames) {
        all.add(frame.target);
        pixels += static_cast<uint64_t>(frame.width) * static_cast<uint64_t>(frame.height);
    }
    const std::string cost =
        fmt::format("{:.3g} samples a pixel; truncation takes {:.3g} from a pixel at most",
                    static_cast<double>(all.samples) / static_cast<double>(pixels), all.worst_truncation);
    if (all.missed == 0) return fmt::format("target error {:g} reached: {}", settings.target_error, cost);
    const std::string text =
        fmt::format("target error {:g} missed in {} of {} pixels: ", settings.target_error, all.missed, pixels);
    std::vector<std::string> reasons;
    if (all.truncated > all.bushy)
        reasons.push_back(fmt::format("{} lose more than a quarter of it below depth {}; a larger --depth may reach it",
                                      all.truncated - all.bushy, settings.depth));
    if (all.bushy != 0)
        reasons.push_back(fmt::format("{} have ray trees of more than {} branches; no setting reaches it there",
                                      all.bushy, most_branches));
    if (all.undersampled != 0)
        reasons.push_back(
            fmt::format("{} want more than {} samples; raise --max-samples", all.undersampled, settings.max_samples));
    if (all.rounded != 0)
        reasons.push_back(fmt::format("{} have borders that rounding may move by more{}", all.rounded,
                                      precision == Precision::single_ ? "; --precision double" : ""));
    return fmt::format("{}{} ({})", text, fmt::join(reasons, "; "), cost);
}

}  // namespace cistula
