// The precision of a run: the wanted one, or the one that the scene needs.
#pragma once

#include <optional>
#include <string>

#include "scene/compile/solids/smallest_part.h"

namespace cistula {

/// A precision and what is to be said about it; empty texts: nothing.
struct PrecisionChoice {
    Precision precision = Precision::single_;
    std::string note;     // why `auto` is double
    std::string warning;  // why the precision does not hold
};

/// The wanted precision; without one, float unless the scene's smallest part is too small for it.
PrecisionChoice choose_precision(const std::optional<Precision>& wanted, const SmallestPart& part);

}  // namespace cistula
