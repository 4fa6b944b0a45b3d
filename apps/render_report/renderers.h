// The renderers of one scene: one for each precision in use, created on first use.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "record.h"
#include "scene/description/description.h"
#include "sequence/backends.h"

namespace cistula::report {

/// The devices on which frames are rendered.
struct Machine {
    Backend backend = Backend::embree;
    CudaOptions cuda;
};

class Renderers {
  public:
    Renderers(const SceneDescription& scene, const Machine& machine) : scene_(scene), machine_(machine) {}

    Renderer& of(const Setting& setting);

    /// The compiled scene in float. Throws Error as compile_scene does.
    const std::shared_ptr<const CompiledScene<float>>& single();
    const std::shared_ptr<const CompiledScene<double>>& twice();

    /// Times of compilation and preparation (trees, uploads) for what has been created.
    const std::vector<Stage>& stages() const { return stages_; }

  private:
    const SceneDescription& scene_;
    const Machine machine_;
    std::shared_ptr<const CompiledScene<float>> single_;
    std::shared_ptr<const CompiledScene<double>> twice_;
    std::map<Precision, std::unique_ptr<Renderer>> made_;
    std::vector<Stage> stages_;
};

}  // namespace cistula::report
