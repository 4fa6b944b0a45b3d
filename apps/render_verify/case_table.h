// All cases of the program. A group is one header, group_NAME.h, with `namespace cistula::verify::NAME { using Cases =
// CaseList<...>; }`; a case is a struct in a header of its own (case.h says what it holds) and a name in that list.
// CMake finds the groups (sources.cmake) and compiles them for the host, and where there is nvcc for devices.
#pragma once

#include <vector>

#include "apps/render_verify/case.h"
#include "apps/render_verify/device_run.h"
#include "apps/render_verify/host_intersectors.h"
#include "apps/render_verify/plan.h"
#include "apps/render_verify/setup.h"
#include "apps/render_verify/stage.h"

namespace cistula::verify {

/// A case of rays in one precision.
template <class Real>
struct RayMethods {
    Tally (*tally)(HostPath, const std::byte* functor, const Setup<Real>&, const PathNeeds<Real>&, uint64_t place,
                   uint64_t count) = nullptr;
    void (*words)(HostPath, const std::byte* functor, const Setup<Real>&, const PathNeeds<Real>&, uint64_t first,
                  uint64_t count, uint64_t* out) = nullptr;
    DeviceMethods<Real> device;
};

struct CaseEntry {
    CaseInfo info;
    void (*plan)(Plan&) = nullptr;             // cases of rays
    void (*render)(Stage&, Tally&) = nullptr;  // cases of images
    RayMethods<float> in_float;
    RayMethods<double> in_double;

    template <class Real>
    auto& methods() {
        if constexpr (sizeof(Real) == sizeof(float))
            return in_float;
        else
            return in_double;
    }
    template <class Real>
    const auto& methods() const {
        return const_cast<CaseEntry*>(this)->methods<Real>();
    }
};

/// All cases, in the order of the groups' names and of their lists.
const std::vector<CaseEntry>& all_cases();

}  // namespace cistula::verify
