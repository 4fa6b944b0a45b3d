#include "base/default_rounding.h"

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

namespace cistula {
namespace {

/// Restores this thread's control register.
class FormerRounding {
  public:
    FormerRounding() : before_(_mm_getcsr()) {}
    ~FormerRounding() { _mm_setcsr(before_); }
    FormerRounding(const FormerRounding&) = delete;
    FormerRounding& operator=(const FormerRounding&) = delete;

  private:
    unsigned before_;
};

}  // namespace

void call_in_default_rounding(const std::function<void()>& function) {
    const FormerRounding former;
    use_default_rounding();
    // Tasks have the mode of their context, which is that of this thread here; contexts within it inherit it. One that
    // is not isolated could be cancelled from outside before the call.
    using Context = tbb::task_group_context;
    Context context(Context::isolated, Context::default_traits | Context::fp_settings);
    tbb::parallel_for(
        0, 1, [&](int) { function(); }, tbb::simple_partitioner(), context);
}

}  // namespace cistula
