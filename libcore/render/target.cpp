#include "render/target.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "cistula/adaptive/path_hash.h"

namespace cistula {
namespace {

/// The probability that at most k of n pixels are off, if each is with probability p.
double at_most(uint64_t k, uint64_t n, double p) {
    const auto log_factorial = [](uint64_t i) { return std::lgamma(static_cast<double>(i) + 1); };
    double sum = 0;
    for (uint64_t i = 0; i <= k; ++i)
        sum += std::exp(log_factorial(n) - log_factorial(i) - log_factorial(n - i) +
                        static_cast<double>(i) * std::log(p) + static_cast<double>(n - i) * std::log1p(-p));
    return sum;
}

std::string describe_sampling(const TargetReport& report) {
    if (report.checked == 0) return "sampling is an estimate that no pixel was there to check";
    return fmt::format(
        "sampling, an estimate, is off by more in {} of {} checked pixels: in at most {:.2g} % of all (95 %)",
        report.off, report.checked, 100 * rate_at_most(report.off, report.checked));
}

}  // namespace

double rate_at_most(uint64_t off, uint64_t checked) {
    if (off >= checked) return 1;
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) {
        const double middle = (low + high) / 2;
        (at_most(off, checked, middle) > 0.05 ? low : high) = middle;
    }
    return high;
}

std::string describe_target(const TargetReport& all, uint64_t pixels, const FrameSettings& settings,
                            Precision precision) {
    const std::string known = fmt::format(
        "truncation is proven to {} its quarter, taking {:.3g} from a pixel at most; {}; {:.3g} samples a pixel",
        all.proven() ? "reach" : "miss", all.worst_truncation, describe_sampling(all),
        static_cast<double>(all.samples) / static_cast<double>(pixels));
    if (all.missed == 0) return fmt::format("target error {:g}: {}", settings.target_error, known);
    const std::string text =
        fmt::format("target error {:g} missed in {} of {} pixels: ", settings.target_error, all.missed, pixels);
    std::vector<std::string> reasons;
    if (all.truncated > all.bushy + all.coarse)
        reasons.push_back(fmt::format("{} lose more than a quarter of it below depth {}; a larger `depth` may reach it",
                                      all.truncated - all.bushy - all.coarse, settings.depth));
    if (all.coarse != 0)
        reasons.push_back(
            fmt::format("{} lose more than a quarter of it to whole units of the sums; no setting "
                        "reaches it there",
                        all.coarse));
    if (all.bushy != 0)
        reasons.push_back(fmt::format("{} have ray trees of more than {} branches; no setting reaches it there",
                                      all.bushy, most_branches));
    if (all.undersampled != 0)
        reasons.push_back(
            fmt::format("{} want more than {} samples; raise `max_samples`", all.undersampled, settings.max_samples));
    if (all.rounded != 0)
        reasons.push_back(fmt::format("{} have borders that rounding may move by more{}", all.rounded,
                                      precision == Precision::single_ ? "; `precision` double" : ""));
    return fmt::format("{}{} ({})", text, fmt::join(reasons, "; "), known);
}

}  // namespace cistula
