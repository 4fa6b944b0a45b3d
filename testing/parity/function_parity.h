// Function parity: compares the shared functions, by case and precision, between the host as g++ compiles them and the
// GPU.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cistula {

struct FunctionParity {
    std::string name, precision;
    uint64_t compared = 0, differing = 0;
    std::string
        first_difference;  // the first few inputs that differ, with the words of both sides; empty where none does
};

/// Runs every case on inputs [0, inputs_per_case), random and adversarial ones mixed, as `seed` determines them; then
/// the device's reciprocal of every float in its range. Throws Error (device) if the current GPU fails.
std::vector<FunctionParity> check_functions(uint64_t inputs_per_case, uint64_t seed);

namespace parity {

/// A case on one side. run() writes the words of inputs [first, first + count), input by input.
struct CaseRunner {
    std::string name, precision;
    int words;
    void (*run)(uint64_t seed, uint64_t first, uint64_t count, uint64_t* out);
};

/// The cases of host and device, in the same order.
std::vector<CaseRunner> host_cases();
std::vector<CaseRunner> device_cases();

/// Result of try_every_reciprocal. It counts equal results instead of different ones: a kernel that does nothing finds
/// none.
struct ReciprocalTally {
    unsigned long long equal = 0;
    unsigned long long first_difference = ~0ull;  // smallest different argument: its bits, then the result's
};

/// reciprocal() of all floats of magnitudes in [low, high] against the GPU's own division, which IEEE 754 defines.
ReciprocalTally try_every_reciprocal(float low, float high);

}  // namespace parity
}  // namespace cistula
