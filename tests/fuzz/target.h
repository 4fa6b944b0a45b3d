// A fuzz target: with libFuzzer a program of its own, else one of those that the program `replay` has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace cistula::fuzz {

using Target = int (*)(const uint8_t* data, size_t size);

/// The targets of `replay`, by name.
inline std::map<std::string, Target>& targets() {
    static std::map<std::string, Target> all;
    return all;
}

}  // namespace cistula::fuzz

/// Begins the function of a target, which has the bytes data[0] to data[size - 1] and returns 0.
#ifdef CISTULA_REPLAY
#define FUZZ_TARGET(name)                                                                                        \
    static int fuzz_##name(const uint8_t* data, size_t size);                                                    \
    [[maybe_unused]] static const bool has_##name = cistula::fuzz::targets().emplace(#name, fuzz_##name).second; \
    static int fuzz_##name(const uint8_t* data, size_t size)
#else
#define FUZZ_TARGET(name) extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
#endif
