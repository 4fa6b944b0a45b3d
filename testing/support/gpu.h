// Support for tests that need a GPU. Without one they are skipped with a message, or fail if CISTULA_REQUIRE_GPU=1.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "base/error.h"
#include "sequence/backends.h"

namespace cistula::test {

/// The reason why tests cannot run on a GPU here; empty if they can.
inline std::string missing_gpu() {
    try {
        choose_devices(Backend::cuda, {});
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

inline bool gpu_required() {
    const char* text = std::getenv("CISTULA_REQUIRE_GPU");
    return text != nullptr && std::string(text) != "" && std::string(text) != "0";
}

}  // namespace cistula::test

/// Skips the test if there is no GPU; use it first in a test. tests/CMakeLists.txt looks for the words "skipped for
/// want of a GPU".
#define CISTULA_NEEDS_GPU()                                                                          \
    do {                                                                                             \
        const std::string missing = cistula::test::missing_gpu();                                    \
        if (missing.empty()) break;                                                                  \
        if (cistula::test::gpu_required()) FAIL() << "CISTULA_REQUIRE_GPU is set, but: " << missing; \
        GTEST_SKIP() << "skipped for want of a GPU: " << missing;                                    \
    } while (false)
