// The explorer: a page that explains pixels by their rays. Its text is page.html, style.css and script.js beside this.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "render/renderer.h"
#include "render/scene.h"
#include "scene/compile/scene_source.h"

namespace cistula {

/// The files beside this, by CMake; the page has the others in it, and /*DATA*/ where data go.
extern const std::string_view explorer_page, explorer_style, explorer_script;

/// The edges of a solid as pairs of points in scene units, without those between triangles in one plane; of a sphere
/// three great circles.
using Wireframe = std::vector<std::array<glm::dvec3, 2>>;

/// The wireframe of each solid; of a mesh with over `most` edges every n-th.
std::vector<Wireframe> wireframes(const SceneSource& source, size_t most = 1500);

/// A frame of a scene that is explored. Its trees are of the rays through the middles of pixels.
class Explorer {
  public:
    /// The scene as the camera's frame has it. A target error becomes the cutoff that it implies.
    Explorer(const Scene& scene, const CameraFrame& camera, const FrameSettings& settings);

    /// All but the trees, as JSON: the picture, names, bodies and lights; points from the camera.
    std::string start(const std::string& source, const std::vector<Wireframe>& bodies, const Film& film) const;

    /// A pixel's rays as a JSON list, parents first, a ray:
    ///     [parent, kind, end, weight, adds, ledger, lights, at, what, surface]
    /// kind, end: numbers of BranchKind and BranchEnd. A color is one number where its three are equal. adds: without
    /// what the lights add. lights: [light, adds, [solid on the way, ...]]. at: where it ends, from the camera; of the
    /// background the direction. what: the number of the solid or visible light. surface: [crossing, material, angle,
    /// local, mirrored, transmitted, index before, beyond, angle beyond (-1: total reflection, 0: straight on)].
    std::string pixel(Renderer& renderer, int x, int y, StopSignal stop) const;

    struct Page {
        std::string html;
        int step;  // one pixel in step x step has its rays in it
    };
    /// The page with as fine a grid as `megabytes` (10^6) allow. Throws Error (usage) if none fits, and (interrupted).
    Page page(const std::string& start, double megabytes, const std::function<std::unique_ptr<Renderer>()>& make,
              StopSignal stop) const;

  private:
    Scene scene_;
    CameraFrame camera_;
    FrameSettings settings_;
};

}  // namespace cistula
