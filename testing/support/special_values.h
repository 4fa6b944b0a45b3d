// What is no finite number.
#pragma once

#include <limits>

namespace cistula::test {

inline constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();

}  // namespace cistula::test
