// Sums that hold what is lit beside lights that could be far brighter; what truncation takes is in the ledger.
#pragma once

#include "apps/render_verify/sums/lamps.h"
#include "apps/render_verify/sums/ledger.h"

namespace cistula::verify::sums {

using Cases = CaseList<TinyLamp, ManyTinyLamps, LampInTorus, HiddenLamp, TargetError, Sun, SunInMirrors, CoarseUnits,
                       DepthCut, Cutoff, BrokenUnits>;

}  // namespace cistula::verify::sums
