// The headers come with the contract: C++20, the baseline's instructions, GLM without its SIMD types, no contraction.
#include <cstdio>

#include "cistula/numerics/vec.h"

#if !defined(__FMA__) || !defined(__AVX2__) || !defined(GLM_FORCE_PURE) || __cplusplus < 202002L
#error "the floating-point contract did not come with the package"
#endif

int main(int argc, char**) {
    // (1 + e)^2 - (1 + 2e) is 0 when the product is rounded and e^2 when the compiler contracts it.
    const float e = 0x1p-12f * float(argc), a = 1 + e;
    const float contracted = a * a - (1 + 2 * e);
    const cistula::Vec3<float> v(3, 0, 4);
    if (contracted != 0 || cistula::length(v) != 5) {
        std::fprintf(stderr, "contracted %a, length %a\n", double(contracted), double(cistula::length(v)));
        return 1;
    }
}
