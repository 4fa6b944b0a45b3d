// The renderer checks itself: hard cases on the intersectors of this machine, against closed forms.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace cistula::verify {

struct Case;  // case.h

/// What finds hits. `plain` tests every primitive and nothing else: others are compared with it, and no case runs on
/// it.
enum class IntersectorKind { embree, lanes, bvh, brute, cuda, plain };
/// "embree", "lanes", "bvh", "brute", "cuda".
const char* intersector_name(IntersectorKind kind);
/// The intersectors of the CPU.
inline const std::vector<IntersectorKind> host_intersectors = {IntersectorKind::embree, IntersectorKind::lanes,
                                                               IntersectorKind::bvh, IntersectorKind::brute};
/// Those of a backend: "embree", the CPU; "cuda", a GPU; "all". Throws Error (usage).
std::vector<IntersectorKind> intersectors_of(const std::string& backend);

/// What one case found on one intersector in one precision.
struct Row {
    std::string name, group, exact;  // "geometry/fans", "geometry", what is exact
    IntersectorKind intersector = IntersectorKind::embree;
    Precision precision = Precision::single_;
    double measured = 0, bound = 0;  // failures, or the largest deviation; the most that may be, if must_fail the least
    const char* unit = "";           // of the bound: "rays", "ulps"
    bool counts = false;             // `measured` is a number of failures
    bool must_fail = false;          // built wrong on purpose
    uint64_t tried = 0;
    uint64_t failures = 0;
    uint64_t witnesses = 0;  // tries that met the hazard, in cases that count them
    uint64_t warned = 0;     // scenes that float warns of as too small for it, and was not judged by
    std::string worst_at;    // part and ray with the largest deviation; empty: none deviates
    std::string complaint;   // why it does not hold; empty: it holds
    double seconds = 0;

    bool holds() const { return complaint.empty(); }
};

/// A number as messages show it: whole ones with all digits, others with four.
std::string number_text(double value);

struct Options {
    std::vector<std::string> cases;            // names, what names begin with, patterns with * and ?; none: all
    const std::vector<Case>* table = nullptr;  // the cases there are; null: all_cases()
    bool quick = false;                        // fewer rays, smaller pictures
    uint32_t scale = 1;                        // so many times the rays
    uint64_t seed = 0;                         // of the rays' draws; scenes and pictures stay the same
    int lanes = 0;                             // the most rays that `lanes` traces at once; 0: any number
    std::vector<IntersectorKind> intersectors = host_intersectors;
    std::vector<Precision> precisions = {Precision::single_, Precision::double_};
    /// Called before a case runs in a precision, and for each of its rows.
    std::function<void(const std::string& name)> begun;
    std::function<void(const Row&)> finished;
};

struct CaseName {
    std::string name, exact;
};
/// The cases that the options choose, in order. Throws Error (usage) for a name or a pattern of none.
std::vector<CaseName> chosen_cases(const Options& options);

/// Runs the chosen cases. Returns the rows by case, then precision, then intersector; the same in every run but for
/// times. Throws Error: (usage) as above, (device) for `cuda` without a GPU, (interrupted) once progress.stop is set.
std::vector<Row> run(const Options& options, RenderProgress& progress);

}  // namespace cistula::verify
