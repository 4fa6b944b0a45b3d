#include "sweep_plan.h"

#include <algorithm>

namespace cistula::report {
namespace {

class Plan {
  public:
    PlannedSetting& add(const Setting& setting) {
        for (PlannedSetting& one : all)
            if (one.setting == setting) return one;
        all.push_back({setting, {}});
        return all.back();
    }

    std::vector<PlannedSetting> all;
};

Setting with(Setting setting, int depth, double cutoff, Precision precision, int supersample) {
    setting.depth = depth;
    setting.cutoff = cutoff;
    setting.precision = precision;
    setting.supersample = supersample;
    return setting;
}

std::vector<int> with_value(std::vector<int> values, int value) {
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
    std::sort(values.begin(), values.end());
    return values;
}

}  // namespace

const std::vector<Knob>& knobs() {
    static const std::vector<Knob> all = {
        {"depth", "Depth", "surfaces along a path", false, [](const Setting& s) { return double(s.depth); }},
        {"cutoff", "Cutoff", "radiance that a pixel may lose", true, [](const Setting& s) { return s.cutoff; }},
        {"samples", "Samples", "samples per pixel", true,
         [](const Setting& s) { return double(s.supersample) * s.supersample; }},
        {"precision", "Precision", "surfaces along a path", false, [](const Setting& s) { return double(s.depth); }},
        {"target", "Target error", "target error", true, [](const Setting& s) { return s.target_error; }},
    };
    return all;
}

Setting reference_setting(const Setting& base, bool quick) {
    return with(base, deepest, quick ? quick_reference_cutoff : reference_cutoff, Precision::double_,
                reference_supersample);
}

std::vector<PlannedSetting> plan_sweep(const Setting& base, bool quick) {
    constexpr Precision single = Precision::single_, twice = Precision::double_;
    Plan plan;
    plan.add(base);

    // All knobs together, as candidates for the Pareto front.
    const std::vector<int> depths =
        with_value(quick ? std::vector<int>{1, 2, 4, 8, 16} : std::vector<int>{1, 2, 4, 8, 16, 32, 64}, base.depth);
    const std::vector<int> lattices = quick ? std::vector<int>{1, 2, 4} : std::vector<int>{1, 2, 4, 8};
    const std::vector<double> cutoffs = quick ? std::vector<double>{0, 0.002} : std::vector<double>{0, 0.02, 0.002};
    for (const int lattice : lattices)
        for (const int depth : depths)
            for (const double cutoff : cutoffs) plan.add(with(base, depth, cutoff, single, lattice));
    for (const int lattice : {1, 4})
        for (const int depth : depths)
            if (lattice == 1 || !quick) plan.add(with(base, depth, 0, twice, lattice));

    // Each knob alone.
    const Setting whole = with(base, deepest, knob_reference_cutoff, single, 1);
    for (const int depth : with_value(quick ? std::vector<int>{1, 2, 3, 4, 6, 8, 12, 16}
                                            : std::vector<int>{1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64},
                                      base.depth))
        plan.add(with(base, depth, 0, single, 1)).alone["depth"] = whole;
    for (const double cutoff : quick ? std::vector<double>{1e-1, 1e-2, 1e-3, 1e-4}
                                     : std::vector<double>{1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6})
        plan.add(with(base, deepest, cutoff, single, 1)).alone["cutoff"] = whole;
    for (const int lattice : quick ? std::vector<int>{1, 2, 4, 8} : std::vector<int>{1, 2, 3, 4, 6, 8, 12})
        plan.add(with(base, base.depth, 0, single, lattice)).alone["samples"] =
            with(base, base.depth, 0, single, reference_supersample);
    for (const int depth : depths)
        plan.add(with(base, depth, 0, single, 1)).alone["precision"] = with(base, depth, 0, twice, 1);
    // A target covers all of the error. For comparison with small targets: the whole lattice without a target, with
    // more or equal truncation.
    for (const double cutoff : cutoffs)
        if (cutoff > 0) plan.add(with(base, deepest, cutoff, single, reference_supersample));
    for (const double target : quick ? std::vector<double>{0.1, 0.05, 0.02, 0.01, 0.004}
                                     : std::vector<double>{0.3, 0.1, 0.05, 0.02, 0.01, 0.004, 0.002, 0.001}) {
        plan.add(with_target(base, target)).alone["target"] = reference_setting(base, quick);
        if (target > 0.05) continue;
        if (target <= 0.004) plan.add(with(base, deepest, target / 4, single, reference_supersample));
        // Where rounding moves edges, no number of samples in float meets a target.
        Setting exact = with_target(base, target);
        exact.precision = twice;
        plan.add(exact);
    }
    return plan.all;
}

}  // namespace cistula::report
