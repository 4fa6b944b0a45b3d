// Balls in the frame, in double, and what a scene's precision makes of them: families of balls that coincide, and what
// is near each (docs/rules.md, 14). Private to libcore/scene.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/box.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/contacts/contact_moves.h"
#include "scene/compile/scene_normalization.h"

namespace cistula {

struct PlacedBall {
    uint32_t solid = 0;  // index in the scene
    glm::dvec3 center{0};
    double radius = 1;
    std::array<glm::dvec3, 3> axes;  // of its longitudes and latitudes
    const SphereObject* given;       // as the file has it

    PlacedBall(const SphereObject& object, uint32_t number, const SceneNormalization& normalization);

    Box box() const { return {center - glm::dvec3(radius), center + glm::dvec3(radius)}; }
    /// The distance of a point from the ball's surface.
    double distance(const glm::dvec3& point) const;
    /// The distance of centers plus that of radii, of the numbers in the file; 0 where their rounding may make it.
    double apart(const PlacedBall& other) const;
};

/// Two balls that float takes for one, though their numbers tell them apart.
struct BallCoat {
    uint32_t solids[2];
    double distance;  // in the frame
};

/// The two with the least distance. Throws Error where double would take them for one, too.
std::optional<BallCoat> thinnest_coat(const SceneSource& source, const std::vector<PlacedBall>& balls,
                                      const SceneNormalization& normalization);

/// Adds balls to a scene's solids, each with the center and radius of its family.
template <class Real>
void add_balls(CompiledScene<Real>& scene, const std::vector<PlacedBall>& balls);

/// Notes which closed meshes and flat sheets are near the scene's balls, once all solids are compiled. `boxes`: of each
/// solid; `planes`: of each flat sheet.
template <class Real>
void find_near_balls(CompiledScene<Real>& scene, const std::vector<PlacedBall>& balls, const std::vector<Box>& boxes,
                     const std::vector<std::optional<PlaneEquation>>& planes);

}  // namespace cistula
