// The floating-point mode on which every image rests.
#pragma once

#include <immintrin.h>

#include <functional>
#include <optional>

namespace cistula {

/// Makes this thread round to nearest, without flushing to zero, while it exists: other libraries may have left it
/// otherwise. Then the thread has its former mode again.
class DefaultRounding {
  public:
    DefaultRounding() : before_(_mm_getcsr()) { _mm_setcsr(0x1f80); }
    ~DefaultRounding() { _mm_setcsr(before_); }
    DefaultRounding(const DefaultRounding&) = delete;
    DefaultRounding& operator=(const DefaultRounding&) = delete;

  private:
    unsigned before_;
};

/// Calls `function`. It, and all that it gives to TBB's other threads, rounds to nearest without flushing to zero;
/// afterwards this thread has its former mode again.
void call_in_default_rounding(const std::function<void()>& function);

/// What `function` returns, computed as call_in_default_rounding() calls it.
template <class Function>
auto in_default_rounding(const Function& function) {
    std::optional<decltype(function())> result;
    call_in_default_rounding([&] { result.emplace(function()); });
    return *std::move(result);
}

}  // namespace cistula
