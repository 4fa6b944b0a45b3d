#include "explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/shown_text.h"
#include "scene/compile/contacts/overlaps.h"

namespace cistula {
namespace {

std::string list_of(uint32_t mask) {
    return mask == 0 ? "nothing" : fmt::format("{}", fmt::join(names_of_effects(mask), ", "));
}

/// An effect's share of the time: "12.3 %", or "-" if it was not measured.
std::string text_of(const EffectCosts& costs, uint32_t effect) {
    for (const EffectCost& cost : costs.costs)
        if (cost.effect == effect && cost.share) return fmt::format("{:.1f} %", 100 * *cost.share);
    return "-";
}

constexpr size_t most_overlaps = 16;  // that are named

template <class Real>
Explanation explained(SceneSource source) {
    const auto compiled = compile_scene<Real>(std::move(source));
    Explanation explanation{std::move(compiled->effect_reasons), {}};
    const std::vector<Overlap> overlaps = find_overlaps(*compiled);
    for (size_t i = 0; i < overlaps.size() && i < most_overlaps; ++i) {
        const std::string first = one_line(compiled->solid_names[overlaps[i].first]);
        const std::string second = one_line(compiled->solid_names[overlaps[i].second]);
        explanation.overlaps.push_back(
            fmt::format("{0} and {1} overlap: {1}, the later in the file, fills what they share.", first, second));
    }
    if (overlaps.size() > most_overlaps)
        explanation.overlaps.push_back(fmt::format("So do {} other pairs.", overlaps.size() - most_overlaps));
    return explanation;
}

}  // namespace

Explanation explain_scene(SceneSource source, Precision precision) {
    return precision == Precision::double_ ? explained<double>(std::move(source)) : explained<float>(std::move(source));
}

std::string explain_table(const std::string& scene, const Explanation& explanation, Backend backend,
                          const EffectCosts* costs) {
    const std::vector<EffectReason>& reasons = explanation.effects;
    const uint32_t required = required_effects(reasons);
    const bool in_lanes = backend == Backend::embree;
    const int least = least_mask(required);
    const int chosen = in_lanes ? least_lane_mask(least) : least;
    const uint32_t mask = effect_masks[in_lanes ? lane_masks[chosen] : chosen];

    constexpr const char* row = "{:<20} {:<7} {:<9} {}{}\n";
    const auto cost_of = [&](uint32_t effect) { return costs ? fmt::format("{:<9}", text_of(*costs, effect)) : ""; };
    std::string table = fmt::format("{}\n\n", one_line(scene));
    table += fmt::format(row, "effect", "needed", "compiled", costs ? fmt::format("{:<9}", "cost") : "", "because");
    for (const EffectReason& reason : reasons)
        table += fmt::format(row, effect_names[std::countr_zero(reason.effect)], reason.needed ? "yes" : "no",
                             (mask & reason.effect) != 0 ? "in" : "left out", cost_of(reason.effect),
                             one_line(reason.because));
    table += fmt::format(
        "\nOf the {} sets of effects for which code is compiled, number {} runs, the least that has all that are "
        "needed. Left out: {}. In without need: {}; that changes no bit of the image.\n",
        in_lanes ? lane_mask_count : effect_mask_count, chosen + 1, list_of(all_effects & ~mask),
        list_of(mask & ~required));
    for (const std::string& overlap : explanation.overlaps) table += overlap + '\n';
    if (costs)
        table += fmt::format(
            "Cost: the share of the time that goes without the effect, medians of {} frames of {:.3g} ms; a few "
            "percent are noise. No scene can do without its shadows, which are not measured.\n",
            costs->runs, costs->frame_ms);
    return table;
}

}  // namespace cistula
