// Runs cases on the intersectors of this machine and judges their results.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/common/step_progress.h"
#include "apps/render_verify/case.h"
#include "render/renderer.h"

namespace cistula::verify {

const char* intersector_name(IntersectorKind kind);

/// The result of one case on one intersector in one precision.
struct Outcome {
    const Case* of = nullptr;
    IntersectorKind intersector = IntersectorKind::embree;
    Precision precision = Precision::single_;
    Tally tally;
    std::string worst_label;  // part and ray with the largest deviation; empty: none deviates
    std::string problem;      // reason why it could not be judged; it then fails
    uint64_t warned = 0;      // scenes of a `float_warns` case that float warns of, and was not judged by
    uint64_t left_out = 0;    // parts of the case that are not traced in lanes, nor judged
    double seconds = 0;

    double limit() const { return of->bound.limit[precision == Precision::double_]; }
    /// The value that is compared with the limit.
    double measured() const;
    bool holds() const;
    /// Whether it must warn of scenes: a `float_warns` case in float.
    bool must_warn() const { return of->is(float_warns) && precision == Precision::single_; }
};

struct RunSettings {
    bool quick = false;
    int lanes = 0;  // the most of the intersector `lanes`; 0: any number
    std::vector<IntersectorKind> intersectors;
    std::vector<Precision> precisions;
};

/// Runs cases. Calls `done` after each outcome, in the order of the cases, then precisions, then intersectors.
/// `progress` shows the current case.
std::vector<Outcome> run_cases(const std::vector<const Case*>& cases, const RunSettings& settings,
                               StepProgress& progress, const std::function<void(const Outcome&)>& done);

}  // namespace cistula::verify
