// Rounding up to a precision.
#pragma once

#include <cmath>

#include "cistula/numerics/real.h"

namespace cistula {

/// The least number of type Real that is not below x.
template <class Real>
Real rounded_up(double x) {
    const auto r = static_cast<Real>(x);
    return r < x ? std::nextafter(r, RealTraits<Real>::infinity) : r;
}

}  // namespace cistula
