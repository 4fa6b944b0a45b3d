// All lights of a scene, those on edges too, in the frame; and the faces that they lie on. Inside libcore/scene.
#pragma once

#include <array>
#include <vector>

#include "cistula/model/scene_view.h"
#include "scene/compile/clusters.h"
#include "scene/compile/compile_solids.h"
#include "scene/compile/frame.h"

namespace cistula {

/// Position and radius in the frame, radiances as described; with falloff, color is I 4^scale.
struct FramedLight {
    glm::dvec3 position;
    glm::dvec3 color, radiance;
    double radius;
    bool falloff;
    std::string place;
    int convex = -1;                       // on an edge of this one of the convex solids
    std::array<uint32_t, 2> edge_faces{};  // faces of its shape

    bool lights() const { return color.x > 0 || color.y > 0 || color.z > 0; }
};

/// The description's lights, then those on the edges of `convex`, in file order.
std::vector<FramedLight> frame_lights(const SceneSource& source, const Frame& frame,
                                      const std::vector<ConvexSolid>& convex);

/// Incident faces of each light, in the order of solids and faces.
using IncidentLists = std::vector<std::vector<Incident>>;

/// |n.l - h| <= 16 u M within the solid grown by as much, u and rounding those of the scene's precision.
template <class Real>
void find_convex_incidents(const std::vector<FramedLight>& lights, const std::vector<ConvexSolid>& convex,
                           double extent, IncidentLists& incidents);

/// Incident triangles of a mesh by the rule of find_convex_incidents, through the tree over their groups.
template <class Real>
void find_triangle_incidents(const std::vector<FramedLight>& lights, const FramedMesh& mesh, const Groups& groups,
                             const Tree& tree, uint32_t solid, uint32_t first_triangle, double extent,
                             IncidentLists& incidents);

/// Incident triangles of a mesh without a tree, numbering its own triangles.
template <class Real>
void find_triangle_incidents(const std::vector<FramedLight>& lights, const FramedMesh& mesh, uint32_t solid,
                             double extent, IncidentLists& incidents);

/// Which lamp lies on a face, and of what, in words for explain_effects; empty if none does.
std::string lamp_on_face(const SceneSource& source, const std::vector<FramedLight>& lights,
                         const IncidentLists& incidents);

}  // namespace cistula
