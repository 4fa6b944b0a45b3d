// A compiled scene of either precision.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_names.h"
#include "scene/compile/scene_source.h"
#include "scene/compile/solids/smallest_part.h"

namespace cistula {

class SceneFrames;

/// A compiled scene, immutable; copies share it. Renderers are made of it by make_embree_renderer and make_renderer.
/// One that keys change is compiled as a frame has it.
class Scene {
  public:
    /// Compiles in the wanted precision; without one, in float unless a part of the scene is too small for it. The
    /// description that the source is of must outlive the call. Throws Error with the place.
    explicit Scene(SceneSource source, const std::optional<Precision>& wanted = {});
    /// Compiles as was chosen.
    Scene(SceneSource source, PrecisionChoice choice);
    explicit Scene(const SceneDescription& description, const std::optional<Precision>& wanted = {},
                   StopSignal stop = {});

    /// Calls a function with the std::shared_ptr<const CompiledScene<Real>> of the precision.
    template <class Function>
    decltype(auto) visit(Function&& function) const {
        return std::visit(std::forward<Function>(function), compiled_);
    }

    Precision precision() const { return choice_.precision; }
    /// Why the precision is double where none was wanted; empty: nothing to say.
    const std::string& precision_note() const { return choice_.note; }
    /// Degenerate triangles left out, open meshes taken as sheets, a precision that is too small, ... What is said of
    /// one frame alone names it.
    const std::vector<std::string>& warnings() const { return warnings_; }
    const SceneNames& names() const { return names_; }

    /// Whether keys change it from frame to frame.
    bool moves() const { return frames_ != nullptr; }
    /// The scene as a frame has it, which does not change. Compiles it where it is another than the last. Throws Error
    /// as the constructors do.
    Scene at(int frame, StopSignal stop = {}) const;
    /// The frame that it is compiled as.
    int shown() const { return shown_; }

    /// What tells it, at each frame, from other scenes.
    FrameHashes hashes() const;
    /// Mask of the effects that the scene requires.
    uint32_t effects() const {
        return visit([](const auto& scene) { return scene->effects; });
    }
    std::shared_ptr<const LayerNames> layer_names() const {
        return visit([](const auto& scene) { return scene->layer_names; });
    }

  private:
    template <class Real>
    void compile(SceneSource source);

    PrecisionChoice choice_;
    int shown_ = 0;
    std::shared_ptr<SceneFrames> frames_;  // null: it does not change
    SceneNames names_;
    std::vector<std::string> warnings_;
    std::variant<std::shared_ptr<const CompiledScene<float>>, std::shared_ptr<const CompiledScene<double>>> compiled_;
};

/// The message as one on a frame of a scene that changes.
std::string in_frame(int frame, const std::string& message);

}  // namespace cistula
