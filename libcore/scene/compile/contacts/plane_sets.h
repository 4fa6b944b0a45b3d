// Sets of faces that touch in one plane, joined pair by pair (docs/rules.md, 11, A5). Private to libcore/scene.
#pragma once

#include <unordered_map>
#include <vector>

#include "scene/compile/contacts/near_faces.h"
#include "scene/compile/meshes/union_find.h"

namespace cistula {

/// Faces that are to lie in one plane: that of the largest.
class PlaneSets {
  public:
    PlaneSets(const FaceList& faces, const FaceTest& test) : faces_(faces), test_(test), roots_(faces.size()) {}

    uint32_t root(uint32_t i) { return roots_.root(i); }

    /// Says that two faces lie over one another and do not touch: no set has both.
    void part(uint32_t a, uint32_t b) { apart_[a].push_back(b), apart_[b].push_back(a); }

    /// Makes one set of those of two faces. False if that would take a face beyond its tolerance of the plane, or onto
    /// or past one that it is parted from, or put two opposite faces of a closed body into it.
    bool join(uint32_t a, uint32_t b);

    struct Set {
        uint32_t largest;
        std::vector<uint32_t> members;
        std::unordered_map<uint32_t, bool> along;  // of closed bodies: whether their faces have the plane's direction
    };
    Set& set(uint32_t root);

  private:
    /// Whether a face that is moved into a plane still lies on its side of one that it is parted from.
    bool stays_apart(const FlatFace& face, const FlatFace& plane, uint32_t other);

    const FaceList& faces_;
    const FaceTest& test_;
    UnionFind roots_;
    std::unordered_map<uint32_t, Set> sets_;  // by root; of faces that are in pairs
    std::unordered_map<uint32_t, std::vector<uint32_t>> apart_;
};

}  // namespace cistula
