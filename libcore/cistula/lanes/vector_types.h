// SIMD vectors of the compilers' own vector extension.
#pragma once

#include <type_traits>

#include "cistula/numerics/portable.h"

namespace cistula {

template <class T, int n>
struct VectorOf {
    typedef T Type __attribute__((vector_size(n * sizeof(T))));
};
template <int bytes>
using SignedOf = std::conditional_t<bytes == 4, int32_t, int64_t>;

/// Vectors of T, with unsigned integers in place of signed ones, whose sums may wrap around.
template <class T, int n>
using WrappingOf = typename VectorOf<
    typename std::conditional_t<std::is_integral_v<T>, std::make_unsigned<T>, std::type_identity<T>>::type, n>::Type;

}  // namespace cistula
