// Tests that need a GPU: where there is none they are skipped and say so, or fail where CISTULA_REQUIRE_GPU=1 demands
// one.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "apps/common/backends.h"
#include "scene/base/error.h"

namespace cistula::test {

/// Why no test can run on a GPU here; empty where one can.
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

/// At the head of a test. tests/CMakeLists.txt looks for the words "skipped for want of a GPU".
#define CISTULA_NEEDS_GPU()                                                                          \
    do {                                                                                             \
        const std::string missing = cistula::test::missing_gpu();                                    \
        if (missing.empty()) break;                                                                  \
        if (cistula::test::gpu_required()) FAIL() << "CISTULA_REQUIRE_GPU is set, but: " << missing; \
        GTEST_SKIP() << "skipped for want of a GPU: " << missing;                                    \
    } while (false)
