// What is told of a target error that frames were rendered with.
#pragma once

#include <cstdint>
#include <string>

#include "render/record/film.h"
#include "render/record/target_report.h"
#include "render/renderer.h"

namespace cistula {

/// The rate that is exceeded with a probability of 5 % at most, if `off` of `checked` pixels were found to be off: the
/// upper limit of the one-sided interval of Clopper and Pearson (1934). 1 if none was checked.
double rate_at_most(uint64_t off, uint64_t checked);

/// One line for all frames, of so many pixels: what is proven, what is estimated, and what would help where the target
/// was missed.
std::string describe_target(const TargetReport& all, uint64_t pixels, const FrameSettings& settings,
                            Precision precision);

}  // namespace cistula
