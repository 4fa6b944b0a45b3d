// Cases on the host: a functor run over TBB on one of the host's intersectors. Included by case_table.cpp.in only.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <cstring>

#include "apps/render_verify/case_table.h"
#include "apps/render_verify/host_intersectors.h"
#include "base/default_rounding.h"

namespace cistula::verify {

template <class Case>
Case functor_of(const std::byte* bytes) {
    Case functor;
    std::memcpy(static_cast<void*>(&functor), bytes, sizeof(Case));
    return functor;
}

template <class Case, class Real>
Tally tally_on_host(HostPath path, const std::byte* bytes, const Setup<Real>& setup, const PathNeeds<Real>& needs,
                    uint64_t place, uint64_t count) {
    const Case functor = functor_of<Case>(bytes);
    Tally all;
    with_intersector<Real>(path, setup.scene, needs, [&](const CalledIntersector<Real>& intersector) {
        all = tbb::parallel_reduce(
            tbb::blocked_range<uint64_t>(0, count, 64), Tally(),
            [&](const auto& range, Tally tally) {
                const DefaultRounding rounding;
                for (uint64_t i = range.begin(); i != range.end(); ++i) {
                    tally.place = place + i;
                    functor(setup, intersector, i, tally);
                }
                return tally;
            },
            [](Tally a, const Tally& b) {
                a.merge(b);
                return a;
            });
    });
    return all;
}

template <class Case, class Real>
void words_on_host(HostPath path, const std::byte* bytes, const Setup<Real>& setup, const PathNeeds<Real>& needs,
                   uint64_t first, uint64_t count, uint64_t* out) {
    const Case functor = functor_of<Case>(bytes);
    with_intersector<Real>(path, setup.scene, needs, [&](const CalledIntersector<Real>& intersector) {
        tbb::parallel_for(tbb::blocked_range<uint64_t>(0, count, 64), [&](const auto& range) {
            const DefaultRounding rounding;
            for (uint64_t i = range.begin(); i != range.end(); ++i)
                out[i] = functor.fingerprint(setup, intersector, first + i);
        });
    });
}

template <class Case, class Real>
RayMethods<Real> methods_of() {
    RayMethods<Real> methods;
    if constexpr (ComparedCase<Case>)
        methods.words = &words_on_host<Case, Real>;
    else if constexpr (RayCase<Case>)
        methods.tally = &tally_on_host<Case, Real>;
    return methods;
}

/// A case, without its launchers on devices.
template <class Case>
CaseEntry entry_of() {
    static_assert(RayCase<Case> != ImageCase<Case>, "a case has either plan() or render()");
    CaseEntry entry;
    entry.info = case_info<Case>();
    if constexpr (RayCase<Case>) entry.plan = [](Plan& plan) { Case::plan(plan); };
    if constexpr (ImageCase<Case>) entry.render = [](Stage& stage, Tally& tally) { Case::render(stage, tally); };
    entry.in_float = methods_of<Case, float>();
    entry.in_double = methods_of<Case, double>();
    return entry;
}

/// Adds the cases of a list, with their launchers on devices in its order; empty: there are none.
template <class... Cases>
void add_entries(CaseList<Cases...>, const std::vector<DeviceMethods<float>>& device_float,
                 const std::vector<DeviceMethods<double>>& device_double, std::vector<CaseEntry>& entries) {
    const size_t first = entries.size();
    (entries.push_back(entry_of<Cases>()), ...);
    for (size_t i = 0; i < device_float.size(); ++i) entries[first + i].in_float.device = device_float[i];
    for (size_t i = 0; i < device_double.size(); ++i) entries[first + i].in_double.device = device_double[i];
}

}  // namespace cistula::verify
