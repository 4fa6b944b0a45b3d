#include "render/record/target_report.h"

#include <algorithm>

namespace cistula {

void TargetReport::add(const TargetReport& other) {
    samples += other.samples;
    truncated += other.truncated;
    coarse += other.coarse;
    bushy += other.bushy;
    undersampled += other.undersampled;
    rounded += other.rounded;
    missed += other.missed;
    checked += other.checked;
    off += other.off;
    worst_truncation = std::max(worst_truncation, other.worst_truncation);
}

TargetReport target_report(const Film& film, const FrameSettings& settings) {
    TargetReport report;
    const double unit = film.unit();
    // If rounding moves an edge by some share of the pixel's width, the pixel changes by that share of the radiance on
    // its brighter side: at most twice the pixel's radiance, if the edge halves it and the other side is black.
    const double worth = 2 * film.rounding * unit / settings.target_error;
    for (const PixelRecord& pixel : film.pixels) {
        const double lost = static_cast<double>(film.units_lost(pixel)) * unit;
        double truncation = 0, pruned = 0;
        for (int c = 0; c < 3; ++c) {
            pruned = std::max(pruned, static_cast<double>(pixel.pruned[c]) * unit);
            truncation = std::max(truncation, static_cast<double>(pixel.pruned[c] + pixel.cut[c]) * unit + lost);
        }
        const bool coarse = lost > settings.truncation();
        const bool truncated = truncation > settings.truncation();
        report.samples += pixel.samples;
        report.truncated += truncated;
        report.coarse += coarse;
        report.bushy += !coarse && pruned > settings.truncation();
        report.undersampled += pixel.unmet;
        report.checked += pixel.checked;
        report.off += pixel.off;
        const int64_t brightest = *std::max_element(pixel.radiance, pixel.radiance + 3);
        const bool rounded = pixel.samples > least_lattice_samples &&
                             static_cast<double>(pixel.z) < worth * static_cast<double>(brightest);
        report.rounded += rounded;
        report.missed += truncated || pixel.unmet || rounded;
        report.worst_truncation = std::max(report.worst_truncation, truncation);
    }
    return report;
}

}  // namespace cistula
