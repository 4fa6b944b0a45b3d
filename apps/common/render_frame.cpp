#include "apps/common/render_frame.h"

#include <algorithm>

namespace cistula {
namespace {

/// Whether a pixel shows more objects than its table holds; the tables of this film and the next are then larger. One
/// entry for each sample is always enough.
bool needs_larger_tables(const Film& film, LayerRequest& layers) {
    if ((film.flags & flag_objects_overflow) == 0 || layers.object_entries >= film.samples) return false;
    layers.object_entries = std::min(4 * layers.object_entries, film.samples);
    return true;
}

}  // namespace

bool render_frame(Renderer& renderer, const CameraFrame& camera, FrameSettings& settings, Film& film,
                  RenderProgress& progress) {
    bool whole = renderer.render(camera, settings, film, progress);
    while (whole && needs_larger_tables(film, settings.layers)) {
        progress.pixels_done = 0;
        progress.rays = 0;
        whole = renderer.render(camera, settings, film, progress);
    }
    return whole;
}

}  // namespace cistula
