// The objects and lights of a scene that change, frame by frame. Private to libcore/scene.
#pragma once

#include <functional>
#include <vector>

#include "base/box.h"
#include "scene/assets/assets.h"
#include "scene/description/description.h"

namespace cistula {

struct SceneSource;

/// Where everything that changes is, at each frame from the first to the last at keys.
class MovingParts {
  public:
    /// `gather`: makes solids of a description without mesh files. Throws Error with the frame.
    MovingParts(const SceneDescription& description, const SceneAssets& assets,
                const std::function<SceneSource(const SceneDescription&)>& gather, StopSignal stop);

    Box box;  // around all that changes, in all frames, in scene units: of meshes around a sphere that turns with them

    /// The frames, but those at keys, at which something that changes is smaller than at all keys. `source`: the scene
    /// at any frame.
    std::vector<int> frames_of_smaller(const SceneSource& source) const;
    /// The frames, but those at keys, at which something that changes comes within `reach`, in scene units, of anything
    /// else, by its box.
    std::vector<int> frames_of_meetings(const SceneSource& source, double reach) const;

  private:
    struct Part {
        Box box;  // empty: a plane without end
        double size;
    };
    /// The frames that are no keys' for which asks(parts) holds.
    template <class Asks>
    std::vector<int> frames_between(const Motion& motion, const Asks& asks) const;

    int first_;
    std::vector<std::vector<Part>> frames_;  // of each frame the objects, then the lights, as Motion lists them
};

}  // namespace cistula
