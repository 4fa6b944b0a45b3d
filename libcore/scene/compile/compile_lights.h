// All lights of a scene in the frame, those on edges included, and the faces on which they lie. Private to
// libcore/scene.
#pragma once

#include <array>
#include <vector>

#include "cistula/model/scene_view.h"
#include "scene/compile/clusters.h"
#include "scene/compile/compile_solids.h"
#include "scene/compile/scene_normalization.h"

namespace cistula {

/// A light with position and radius in the frame and radiances as described; with falloff, color is I 4^scale.
struct NormalizedLight {
    glm::dvec3 position;
    glm::dvec3 color, radiance;
    double radius;
    bool falloff;
    std::string place, group;
    int convex = -1;                       // the convex solid on whose edge it lies; -1: none
    std::array<uint32_t, 2> edge_faces{};  // the two faces at that edge

    bool lights() const { return color.x > 0 || color.y > 0 || color.z > 0; }
};

/// The description's lights, then those on the edges of `convex`, in file order.
std::vector<NormalizedLight> normalize_lights(const SceneSource& source, const SceneNormalization& normalization,
                                              const std::vector<ConvexSolid>& convex);

/// For each light, the faces that it lies on, in the order of solids and faces.
using IncidentLists = std::vector<std::vector<Incident>>;

/// Adds the convex solids' faces on which lights lie: |n.l - h| <= 16 u M inside the solid grown by as much, u and
/// rounding those of the scene's precision.
template <class Real>
void find_convex_incidents(const std::vector<NormalizedLight>& lights, const std::vector<ConvexSolid>& convex,
                           double extent, IncidentLists& incidents);

/// Adds a mesh's triangles on which lights lie, found through the tree over their groups.
template <class Real>
void find_triangle_incidents(const std::vector<NormalizedLight>& lights, const NormalizedMesh& mesh,
                             const Groups& groups, const Tree& tree, uint32_t solid, uint32_t first_triangle,
                             double extent, IncidentLists& incidents);

/// Whether a point lies within `tolerance` of a triangle's plane and of the triangle.
bool near_triangle(const std::array<glm::dvec3, 3>& corner, const glm::dvec3& p, double tolerance);

/// Which light lies on a face of which object, in words for explain_effects; empty if none does.
std::string light_on_face(const SceneSource& source, const std::vector<NormalizedLight>& lights,
                          const IncidentLists& incidents);

}  // namespace cistula
