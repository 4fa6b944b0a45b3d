// Function parity, the host's side: compiled by g++ with the flags of cistula::contract, as the CPU backend is.
#include "testing/parity/function_parity.h"

#include "testing/parity/function_compare.h"

namespace cistula {

std::vector<parity::CaseRunner> parity::host_cases() {
    return host_runners(AllCases());
}

std::vector<FunctionParity> check_functions(uint64_t inputs_per_case, uint64_t seed) {
    const std::vector<parity::CaseRunner> host = parity::host_cases(), device = parity::device_cases();
    std::vector<FunctionParity> results;
    for (size_t i = 0; i < host.size(); ++i)
        results.push_back(parity::compare_case(host[i], device[i], inputs_per_case, seed));
    constexpr int range = parity::reciprocal_range;
    const float low = parity::two_to<float>(-range), high = parity::two_to<float>(range);
    results.push_back(parity::reciprocal_parity(parity::try_every_reciprocal(low, high), low, high));
    return results;
}

}  // namespace cistula
