#include "render/frame_settings.h"

#include "base/error.h"

namespace cistula {

FrameSettings frame_settings(const SceneDescription& scene) {
    FrameSettings settings;
    settings.set_size(scene.film.width, scene.film.height);
    settings.supersample = scene.film.supersample;
    settings.depth = scene.depth;
    settings.cutoff = scene.cutoff;
    return settings;
}

RayHits Renderer::intersect(std::span<const glm::dvec3>, std::span<const glm::dvec3>) {
    throw Error(ExitCode::usage, intersector() + ": this renderer tells nothing of rays");
}

std::vector<glm::dvec3> Renderer::transmittance(std::span<const glm::dvec3>, std::span<const glm::dvec3>) {
    throw Error(ExitCode::usage, intersector() + ": this renderer tells nothing of rays");
}

PixelTree Renderer::pixel_tree(const CameraFrame&, const FrameSettings&, int, int) {
    throw Error(ExitCode::usage, intersector() + ": the trees of pixels are told by the renderer of the CPU");
}

}  // namespace cistula
