#include "explain.h"

#include <fmt/format.h>

#include <bit>

namespace cistula {
namespace {

std::string names_of(uint32_t mask) {
    std::vector<std::string> names;
    for (int i = 0; i < effect_count; ++i)
        if (mask >> i & 1) names.push_back(effect_names[i]);
    return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string explain_table(const std::string& scene, const std::vector<EffectReason>& reasons) {
    uint32_t required = 0;
    for (const EffectReason& reason : reasons)
        if (reason.needed) required |= reason.effect;
    const int chosen = least_mask(required);
    const uint32_t mask = effect_masks[chosen];

    constexpr const char* row = "{:<20} {:<7} {:<9} {}\n";
    std::string table = fmt::format("{}\n\n", scene);
    table += fmt::format(row, "effect", "needed", "compiled", "because");
    for (const EffectReason& reason : reasons)
        table += fmt::format(row, effect_names[std::countr_zero(reason.effect)], reason.needed ? "yes" : "no",
                             (mask & reason.effect) != 0 ? "in" : "left out", reason.because);
    table += fmt::format("\nMask {} of {} runs. Left out: {}. In without need: {}; never a bit of the image.\n",
                         chosen + 1, effect_mask_count, names_of(all_effects & ~mask), names_of(mask & ~required));
    return table;
}

}  // namespace cistula
