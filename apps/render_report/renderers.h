// The renderers of one scene: one for each precision and intersector that a setting asks for, made when it is first
// asked for.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/common/backends.h"
#include "record.h"
#include "scene/description/description.h"

namespace cistula::report {

/// Where frames are rendered.
struct Machine {
    Backend backend = Backend::embree;
    CudaOptions cuda;
};

/// How the host's or the device's rays find surfaces, by the name that settings have. A new one: a line in
/// renderers.cpp.
struct Intersector {
    const char* name;
    bool (*offered)(Backend);  // whether the backend has it
    std::unique_ptr<Renderer> (*make_single)(const Machine&, std::shared_ptr<const CompiledScene<float>>);
    std::unique_ptr<Renderer> (*make_double)(const Machine&, std::shared_ptr<const CompiledScene<double>>);
};
const std::vector<Intersector>& intersectors();

class Renderers {
  public:
    Renderers(const SceneDescription& scene, const Machine& machine) : scene_(scene), machine_(machine) {}

    Renderer& of(const Setting& setting);

    /// Throws Error as compile_scene does.
    const std::shared_ptr<const CompiledScene<float>>& single();
    const std::shared_ptr<const CompiledScene<double>>& twice();

    /// How long compiling and preparing took (trees, uploads), of what has been made.
    const std::vector<Stage>& stages() const { return stages_; }

  private:
    const SceneDescription& scene_;
    const Machine machine_;
    std::shared_ptr<const CompiledScene<float>> single_;
    std::shared_ptr<const CompiledScene<double>> twice_;
    std::map<std::pair<Precision, std::string>, std::unique_ptr<Renderer>> made_;
    std::vector<Stage> stages_;
};

}  // namespace cistula::report
