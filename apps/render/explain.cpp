#include "explain.h"

#include <fmt/format.h>

#include <bit>

#include "scene/base/shown_text.h"

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

}  // namespace

std::string explain_table(const std::string& scene, const std::vector<EffectReason>& reasons,
                          const EffectCosts* costs) {
    const uint32_t required = required_effects(reasons);
    const int chosen = least_mask(required);
    const uint32_t mask = effect_masks[chosen];

    constexpr const char* row = "{:<20} {:<7} {:<9} {}{}\n";
    const auto cost_of = [&](uint32_t effect) { return costs ? fmt::format("{:<9}", text_of(*costs, effect)) : ""; };
    std::string table = fmt::format("{}\n\n", one_line(scene));
    table += fmt::format(row, "effect", "needed", "compiled", costs ? fmt::format("{:<9}", "cost") : "", "because");
    for (const EffectReason& reason : reasons)
        table += fmt::format(row, effect_names[std::countr_zero(reason.effect)], reason.needed ? "yes" : "no",
                             (mask & reason.effect) != 0 ? "in" : "left out", cost_of(reason.effect),
                             one_line(reason.because));
    table += fmt::format("\nMask {} of {} runs. Left out: {}. In without need: {}; never a bit of the image.\n",
                         chosen + 1, effect_mask_count, list_of(all_effects & ~mask), list_of(mask & ~required));
    if (costs)
        table += fmt::format(
            "Cost: the share of the time that goes without the effect, medians of {} frames of {:.3g} ms; a few "
            "percent are noise. Both kinds of shadow are taken out together.\n",
            costs->runs, costs->frame_ms);
    return table;
}

}  // namespace cistula
