#include "explain.h"

#include <fmt/format.h>

#include <bit>

namespace cistula {
namespace {

std::string list_of(uint32_t mask) {
    return mask == 0 ? "nothing" : fmt::format("{}", fmt::join(names_of_effects(mask), ", "));
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
                         chosen + 1, effect_mask_count, list_of(all_effects & ~mask), list_of(mask & ~required));
    return table;
}

}  // namespace cistula
