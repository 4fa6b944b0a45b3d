// All lights of a scene in the frame, those on edges included, and the faces on which they lie. Private to
// libcore/scene.
#pragma once

#include <array>
#include <vector>

#include "cistula/model/scene_view.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/contacts/contact_moves.h"
#include "scene/compile/meshes/mesh_apex.h"
#include "scene/compile/solids/placed_bodies.h"

namespace cistula {

/// A light with position and radius in the frame and radiances as described; with falloff, color is I 4^scale.
struct NormalizedLight {
    glm::dvec3 position;
    glm::dvec3 half_unit;  // of the position as written, in the frame
    glm::dvec3 color, radiance;
    double radius;
    bool shown;       // as a sphere
    bool glow_given;  // radiance is not taken from the color
    bool falloff;
    std::string place, group;
    int convex = -1;                       // the convex solid on whose edge it lies; -1: none
    std::array<uint32_t, 2> edge_faces{};  // the two faces at that edge

    bool lights() const { return color.x > 0 || color.y > 0 || color.z > 0; }
};

/// The description's lights, then those on the edges of `convex`, in file order.
std::vector<NormalizedLight> normalize_lights(const SceneSource& source, const SceneNormalization& normalization,
                                              const std::vector<ConvexSolid>& convex);

/// How far a point may be from the plane of a body's face to lie on it: as far as rounding in files may have moved the
/// two apart, or as the scene's "contact" says, within the body's reach, but no less than 16 times the rounding of the
/// distance in double. `half_unit`: of the point, in the frame; `box`: of the face or its body.
double point_tolerance(const ContactReach& reach, const PlaneEquation& plane, const glm::dvec3& point,
                       const glm::dvec3& half_unit, const Box& box);

/// No point_tolerance() of a light is more.
double largest_tolerance(const ContactReach& reach, const NormalizedLight& light);

/// A face on which a light lies.
struct LightFace {
    Incident incident;
    PlaneEquation plane;
};
/// For each light, the faces that it lies on.
using LightFaces = std::vector<std::vector<LightFace>>;

/// Adds the convex solids' faces on which lights lie: no farther from its plane than point_tolerance() or `least`,
/// which is 16 u M, inside the solid grown by as much.
void find_convex_incidents(const std::vector<NormalizedLight>& lights, const PlacedBodies& bodies, double least,
                           LightFaces& faces);

/// Adds the disks on which lights lie. `solids`: the scene's, which number their faces.
void find_disk_incidents(const std::vector<NormalizedLight>& lights, const PlacedBodies& bodies,
                         const std::vector<Solid>& solids, double least, LightFaces& faces);

/// Adds a mesh's triangles on which lights lie, found through the tree over their groups. `mesh`: in double.
void find_triangle_incidents(const std::vector<NormalizedLight>& lights, const NormalizedMesh& mesh,
                             const Groups& groups, const Tree& tree, uint32_t solid, uint32_t first_triangle,
                             const ContactReach& reach, double least, LightFaces& faces);

/// Moves the lights onto the faces on which they lie, and tells which were moved. `rounding`: what is as near to a
/// plane stays where it is.
std::vector<bool> settle_lights(std::vector<NormalizedLight>& lights, const LightFaces& faces, double rounding);

/// Whether a point lies within `tolerance` of a triangle's plane and of the triangle.
bool near_triangle(const std::array<glm::dvec3, 3>& corner, const glm::dvec3& p, double tolerance);

/// Which light lies on a face of which object, in words for explain_effects; empty if none does.
std::string light_on_face(const SceneSource& source, const std::vector<NormalizedLight>& lights,
                          const LightFaces& faces);

/// Bound on the rounding in all tests of a light or a ray's line, in units of M.
inline constexpr double light_slack = 0x1p-14;

/// Sets light_reach, light_square and lights_apart of every solid's first group. A solid without visible lights on its
/// edges gets radius 0. All reaches are infinite if any light lies on no solid or if there are too many solids to test.
/// `owners`: for each visible light the convex solid on whose edges it lies, or no_solid.
template <class Real>
void reach_edge_lights(CompiledScene<Real>& scene, const std::vector<uint32_t>& owners);

}  // namespace cistula
