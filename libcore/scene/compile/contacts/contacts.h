// Which faces of a scene's bodies touch, decided once, in double, whatever the precision: what touches is moved into
// one plane (docs/rules.md, 11, LOAD). Private to libcore/scene.
#pragma once

#include <string>
#include <vector>

#include "scene/compile/contacts/flat_faces.h"
#include "scene/compile/meshes/normalized_mesh.h"

namespace cistula {

/// The plane that faces of touching bodies share, in the frame.
struct ContactPlane {
    glm::dvec3 normal;                // unit: that of the largest face
    glm::dvec3 middle;                // a point on it: the middle of that face
    std::vector<glm::dvec3> corners;  // of all faces on it, as moved
};

/// A part of a solid's surface on a contact plane: a triangle of a mesh, or 2 slab + side of a Platonic solid.
struct PartOnPlane {
    uint32_t part, plane;
};

/// What contacts do to a solid.
struct SolidContacts {
    std::vector<glm::dvec3> points;  // its vertices in the frame, if some were moved; else none
    std::vector<PartOnPlane> parts;  // ascending
    std::vector<uint32_t> near;      // the planes of its faces and of faces that come near them, ascending
    ContactReach reach;
};

/// Two solids with faces that nearly touch.
struct NearPair {
    uint32_t solids[2];
    double gap;   // the largest distance of the smaller face's corners from the larger one's plane, in the frame
    bool joined;  // by a longer "contact", which is worth a word
};

/// The solids of a scene in its frame: which faces touch, and where their vertices then lie.
struct Contacts {
    std::vector<ContactPlane> planes;
    std::vector<SolidContacts> solids;
    uint32_t first[2] = {0, 0};   // the two solids with faces in one plane that come first; equal: one sheet
    size_t pairs = 0;             // of faces that touch
    std::vector<NearPair> near;   // the nearest faces of each two solids
    std::vector<NearPair> apart;  // two solids with faces that touch but cannot be moved into one plane
    double farthest_move = 0;     // of a vertex, in the frame
    uint32_t moved = 0;           // the solid of that vertex

    /// The contact plane of a part of a solid, or no_plane.
    uint32_t plane_of(uint32_t solid, uint32_t part) const;
};

/// The most pairs of faces of different objects, or of one open sheet.
struct ContactLimits {
    /// That may touch or nearly touch. Memory and time grow with them: many objects in one place have as many as the
    /// square of their number.
    size_t touching = 16'000'000;
    /// Whose boxes come near one another, each counted from both sides: some seconds.
    size_t boxes = 1'000'000'000;
};

/// Finds the contacts of a scene. `polyhedra`: the planes of its polyhedra, in order; `sizes`: of each solid's
/// mesh. Throws Error for more pairs than the limits allow.
Contacts find_contacts(const SceneSource& source, const SceneNormalization& normalization,
                       const std::vector<ConvexSolid>& polyhedra, const std::vector<MeshSize>& sizes,
                       const ContactLimits& limits = {});

/// The warnings of contacts, each with the place of an object.
std::vector<std::string> contact_warnings(const SceneSource& source, const SceneNormalization& normalization,
                                          const Contacts& contacts);

}  // namespace cistula
