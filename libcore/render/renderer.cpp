#include "render/renderer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/shown_text.h"
#include "cistula/geometry/ray.h"
#include "cistula/model/pixel_record.h"

namespace cistula {

RayHits Renderer::intersect(std::span<const glm::dvec3>, std::span<const glm::dvec3>) {
    throw Error(ErrorKind::usage, intersector() + ": this renderer tells nothing of rays");
}

std::vector<glm::dvec3> Renderer::transmittance(std::span<const glm::dvec3>, std::span<const glm::dvec3>) {
    throw Error(ErrorKind::usage, intersector() + ": this renderer tells nothing of rays");
}

PixelTree Renderer::pixel_tree(const CameraFrame&, const FrameSettings&, int, int, const PixelTreeLimits&) {
    throw Error(ErrorKind::usage, intersector() + ": the trees of pixels are told by the renderer of the CPU");
}

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

std::string describe_flags(uint32_t flags, const std::vector<std::string>& crowd) {
    std::vector<std::string> parts;
    if (flags & flag_not_finite) parts.push_back("a radiance was infinite or not a number");
    if (flags & flag_media_overflow)
        parts.push_back(fmt::format(
            "a ray was inside more than {} solids at once, which is all it can list{}{}; take some away",
            InteriorList::capacity, crowd.empty() ? "" : ": ", one_line(fmt::format("{}", fmt::join(crowd, ", ")))));
    if (flags & flag_stack_overflow) parts.push_back("a ray's tree had more branches waiting than there is room for");
    if (flags & flag_too_many_crossings) parts.push_back("a straight ray crossed more faces than the limit");
    if (flags & flag_objects_overflow) parts.push_back("a pixel showed more objects than its table holds");
    return fmt::format("{}", fmt::join(parts, "; "));
}

FrameSettings frame_settings(const SceneDescription& scene) {
    FrameSettings settings;
    settings.set_size(scene.film.width, scene.film.height);
    settings.supersample = scene.film.supersample;
    settings.depth = scene.depth;
    settings.cutoff = scene.cutoff;
    return settings;
}

}  // namespace cistula
