// The solids of a scene in its frame, in double, as both precisions have them: touching faces are moved into one plane,
// and convex solids are planes. Private to libcore/scene.
#pragma once

#include <vector>

#include "scene/compile/contacts/contacts.h"
#include "scene/compile/meshes/mesh_size.h"
#include "scene/compile/solids/compile_solids.h"

namespace cistula {

struct PlacedBodies {
    SceneNormalization normalization;
    std::vector<MeshSize> sizes;  // of each solid's mesh; of a Platonic solid nothing
    Contacts contacts;
    std::vector<ConvexSolid> convex;  // the solids that are given by planes, by number; in contact as contacts say

    explicit PlacedBodies(const SceneSource& source);

  private:
    void bind_slabs(ConvexSolid& solid) const;
    void bind_slab(ConvexSolid& solid, uint32_t slab) const;
    void follow(const ConvexSolid& solid, uint32_t face, const glm::dvec3& opposite, PlanePair& pair) const;
};

}  // namespace cistula
