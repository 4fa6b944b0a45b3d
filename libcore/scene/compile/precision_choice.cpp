#include "scene/compile/precision_choice.h"

#include <fmt/format.h>

namespace cistula {
namespace {

/// "float: /objects/1: pebble: its inradius is 7.9e-07 of the scene's extent; float holds from 1.2e-04 on".
std::string verdict(Precision chosen, const SmallestPart& part, Precision judged) {
    return fmt::format("{}: {} is {:.1e} of the scene's extent; {} holds from {:.1e} on", precision_name(chosen),
                       part.what, part.share, precision_name(judged), least_share(judged));
}

}  // namespace

PrecisionChoice choose_precision(const std::optional<Precision>& wanted, const SmallestPart& part) {
    const auto holds = [&](Precision precision) { return part.share >= least_share(precision); };
    PrecisionChoice choice;
    choice.precision = wanted.value_or(holds(Precision::single_) ? Precision::single_ : Precision::double_);
    if (!holds(choice.precision)) {
        choice.warning = verdict(choice.precision, part, choice.precision);
        if (choice.precision == Precision::single_) choice.warning += "; take `precision` double";
    } else if (!wanted && choice.precision == Precision::double_) {
        choice.note = verdict(Precision::double_, part, Precision::single_);
    }
    return choice;
}

}  // namespace cistula
