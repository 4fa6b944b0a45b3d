// A case: its name, what is exact about it, how far off it may be, and one of two bodies.
//
// Rays (a functor, run for i in [0, count) on every intersector, on the device too):
//     struct MyCase {
//         static constexpr const char* name = "geometry/my-case";
//         static constexpr const char* exact = "what is exact, in one line";
//         static constexpr Bound bound = no_failures("rays");
//         uint32_t parameter;                        // trivially copyable members: the part's parameters
//         static void plan(Plan& plan);              // adds parts: scene, functor, points, counts (plan.h)
//         template <class Real, class Intersector>
//         CISTULA_HD void operator()(const Setup<Real>&, const Intersector&, uint64_t i, Tally&) const;
//     };
// In the place of operator(), `uint64_t fingerprint(setup, intersector, i) const` gives a word a ray that must be the
// same on all intersectors as from a plain loop over all primitives on the host.
//
// Images (a function, run with the renderer of every intersector):
//         static void render(Stage& stage, Tally& tally);   // stage.h
//
// Options, static constexpr bool: `own_traversal` (the functor asks no intersector: it runs once on the host and once
// on the device), `needs_witness` (without a try that met the hazard, tally.witness(true), the case does not hold),
// `float_warns` (some of its scenes have parts too small for float, docs/rules.md 12: in float they must be warned of,
// and the others must hold; in double all must).
#pragma once

#include <string>

#include "apps/render_verify/tally.h"

namespace cistula::verify {

enum class Measure { failures, worst };

struct Bound {
    Measure measure;
    bool must_fail;   // broken on purpose: holds only if at least `limit` tries fail
    double limit[2];  // float, double
    const char* unit;
};

/// A bound on the number of failures: none; also for bit equality.
constexpr Bound no_failures(const char* unit) {
    return {Measure::failures, false, {0, 0}, unit};
}
/// A bound on the largest deviation; expectations must hold as well.
constexpr Bound at_most(double limit, const char* unit) {
    return {Measure::worst, false, {limit, limit}, unit};
}
constexpr Bound at_most(double limit_in_float, double limit_in_double, const char* unit) {
    return {Measure::worst, false, {limit_in_float, limit_in_double}, unit};
}
/// A bound for negative controls: at least that many tries must fail.
constexpr Bound must_fail(double at_least, const char* unit) {
    return {Measure::failures, true, {at_least, at_least}, unit};
}

struct CaseInfo {
    std::string name, exact;
    Bound bound;
    bool own_traversal = false, needs_witness = false, float_warns = false;
};

class Plan;
class Stage;

template <class Case>
concept RayCase = requires(Plan& plan) {
    Case::plan(plan);
};
template <class Case>
concept ImageCase = requires(Stage& stage, Tally& tally) {
    Case::render(stage, tally);
};
template <class Case>
concept ComparedCase = RayCase<Case> && requires {
    Case::compared;
};

template <class... Cases>
struct CaseList {};

template <class Case>
CaseInfo case_info() {
    CaseInfo info{Case::name, Case::exact, Case::bound};
    if constexpr (requires { Case::own_traversal; }) info.own_traversal = Case::own_traversal;
    if constexpr (requires { Case::needs_witness; }) info.needs_witness = Case::needs_witness;
    if constexpr (requires { Case::float_warns; }) info.float_warns = Case::float_warns;
    return info;
}

}  // namespace cistula::verify
