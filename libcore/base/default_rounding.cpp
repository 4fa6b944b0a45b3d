#include "base/default_rounding.h"

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

namespace cistula {
void call_in_default_rounding(const std::function<void()>& function) {
    const DefaultRounding rounding;
    // Tasks have the mode of their context, which is that of this thread here; contexts within it inherit it. One that
    // is not isolated could be cancelled from outside before the call.
    using Context = tbb::task_group_context;
    Context context(Context::isolated, Context::default_traits | Context::fp_settings);
    tbb::parallel_for(
        0, 1, [&](int) { function(); }, tbb::simple_partitioner(), context);
}

}  // namespace cistula
