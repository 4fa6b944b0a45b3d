// Disks and planes without end in the frame, in double: squares to what looks for contacts (docs/rules.md, 18). Private
// to libcore/scene.
#pragma once

#include "scene/compile/compiled_scene.h"
#include "scene/compile/contacts/contact_moves.h"
#include "scene/compile/contacts/contacts.h"

namespace cistula {

/// The most disks of a scene, planes too: each query tests them all.
inline constexpr size_t most_disks = 64;

/// The numbers of triangles that a disk takes: those of its square, which no cluster has.
inline constexpr uint32_t triangles_of_disk = 2;

/// Gives a source the square around a disk, or, of a plane without end, one that reaches beyond the scene's box.
void add_square(SourceSolid& solid, const SceneNormalization& normalization);

struct PlacedDisk {
    uint32_t solid = 0;  // index in the scene
    uint32_t plane = 0;  // its contact plane
    PlaneEquation equation;
    glm::dvec3 center{0};  // of a plane: its point nearest to the frame's origin
    double radius = 1;     // infinite for a plane
    const DiskObject* object;

    PlacedDisk(const SceneSource& source, uint32_t number, const SceneNormalization& normalization,
               const Contacts& contacts);

    bool is_endless() const { return object->is_endless(); }
    /// The distance of a point from the disk.
    double distance(const glm::dvec3& point) const;
    Box box() const;
};

/// Fills the scene's disks, once it has its shared planes. The solids know their numbers.
template <class Real>
void add_disks(CompiledScene<Real>& scene, const SceneSource& source, const std::vector<PlacedDisk>& disks,
               const SceneNormalization& normalization);

}  // namespace cistula
