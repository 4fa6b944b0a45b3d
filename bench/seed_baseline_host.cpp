// The course work's loop on the CPU: one thread, -O3, none of the floating-point contract's flags.
#include "bench/seed_baseline_run.h"

namespace cistula::seed {

void render_on_host(int depth, const Scene& scene, const View& view, Pixel* pixels) {
    switch (depth) {
        case 1:
            return render_on_host<1>(scene, view, pixels);
        case 2:
            return render_on_host<2>(scene, view, pixels);
        case 4:
            return render_on_host<4>(scene, view, pixels);
        case 8:
            return render_on_host<8>(scene, view, pixels);
    }
}

}  // namespace cistula::seed
