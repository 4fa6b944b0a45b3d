// The environment of a case of images: a renderer for any scene, on one intersector in one precision.
#pragma once

#include <functional>

#include "render/record/film.h"
#include "render/renderer.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/smallest_part.h"
#include "scene/description/description.h"

namespace cistula::verify {

class Stage {
  public:
    using Render = std::function<Film(const SceneDescription&, const FrameSettings&, int frame)>;

    Stage(bool is_quick, Precision in, std::string by, Render render)
        : quick(is_quick), precision(in), intersector(std::move(by)), render_(std::move(render)) {}

    const bool quick;
    const Precision precision;
    const std::string intersector;  // "embree", "lanes", "bvh", "brute", "cuda"

    bool in_double() const { return precision == Precision::double_; }
    /// u: half an ulp of 1.
    double unit() const { return in_double() ? 0x1p-53 : 0x1p-24; }

    /// Whether this is float and warns of the scene, whose picture then need not hold (`float_warns`).
    bool warns_of(const SceneDescription& scene) {
        const bool warns = !in_double() && smallest_part(scene).share < least_share(Precision::single_);
        warned_ += warns ? 1 : 0;
        return warns;
    }
    uint64_t warned() const { return warned_; }

    /// Renders a frame. Throws Error if the film is unreliable (film.flags).
    Film render(const SceneDescription& scene, const FrameSettings& settings, int frame = 0) const {
        return render_(scene, settings, frame);
    }
    Film render(const SceneDescription& scene, int width, int height) const {
        FrameSettings settings;
        settings.set_size(width, height);
        settings.depth = scene.depth;
        settings.cutoff = scene.cutoff;
        return render(scene, settings);
    }

  private:
    Render render_;
    uint64_t warned_ = 0;
};

}  // namespace cistula::verify
