// Function parity, the host's side: runs cases over TBB and compares two sides of one.
#pragma once

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <string>
#include <vector>

#include "testing/parity/function_cases.h"
#include "testing/parity/function_parity.h"

namespace cistula::parity {

inline constexpr uint64_t inputs_at_once = uint64_t{1} << 20;
inline constexpr size_t differences_shown = 3;

template <class Case>
void run_on_host(uint64_t seed, uint64_t first, uint64_t count, uint64_t* out) {
    tbb::parallel_for(tbb::blocked_range<uint64_t>(0, count, 4096), [&](const auto& range) {
        _mm_setcsr(0x1f80);  // rounds to nearest, flushes nothing
        for (uint64_t i = range.begin(); i != range.end(); ++i) run_case<Case>(first + i, seed, out + i * Case::words);
    });
}

template <class... Cases>
std::vector<CaseRunner> host_runners(CaseList<Cases...>) {
    return {{Cases::name, RealTraits<typename Cases::Number>::name, Cases::words, &run_on_host<Cases>}...};
}

inline std::string words_text(const uint64_t* words, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += fmt::format(" {:016x}", words[i]);
    return text;
}

inline FunctionParity compare_case(const CaseRunner& host, const CaseRunner& device, uint64_t inputs, uint64_t seed) {
    FunctionParity result{host.name, host.precision, 0, 0, {}};
    const size_t words = size_t(host.words);
    std::vector<uint64_t> ours(std::min(inputs, inputs_at_once) * words), theirs(ours.size());
    for (uint64_t first = 0; first < inputs; first += inputs_at_once) {
        const uint64_t count = std::min(inputs_at_once, inputs - first);
        // Different initial values, so that outputs that neither side writes do not compare equal.
        std::fill(ours.begin(), ours.end(), ~uint64_t{0});
        std::fill(theirs.begin(), theirs.end(), 0);
        device.run(seed, first, count, theirs.data());
        host.run(seed, first, count, ours.data());
        result.compared += count;
        if (std::memcmp(ours.data(), theirs.data(), count * words * sizeof(uint64_t)) == 0) continue;
        for (uint64_t i = 0; i < count; ++i) {
            const uint64_t *a = ours.data() + i * words, *b = theirs.data() + i * words;
            if (std::equal(a, a + words, b)) continue;
            if (result.differing++ < differences_shown)
                result.first_difference +=
                    fmt::format("{}input {} (seed {}): host{}, device{}", result.first_difference.empty() ? "" : "; ",
                                first + i, seed, words_text(a, host.words), words_text(b, host.words));
        }
    }
    return result;
}

inline FunctionParity reciprocal_parity(const ReciprocalTally& tally, float low, float high) {
    FunctionParity result{"reciprocal, every float", RealTraits<float>::name, 0, 0, {}};
    result.compared = 2 * (uint64_t(bits_as<uint32_t>(high)) - bits_as<uint32_t>(low) + 1);
    result.differing = result.compared - tally.equal;
    if (result.differing == 0) return result;
    const uint32_t x = uint32_t(tally.first_difference >> 32), ours = uint32_t(tally.first_difference);
    result.first_difference = fmt::format("input {:08x}: reciprocal {:08x}, quotient {:08x}", x, ours,
                                          bits_as<uint32_t>(1.0f / bits_as<float>(x)));
    return result;
}

}  // namespace cistula::parity
