// Sets of faces that touch in one plane, joined pair by pair (docs/rules.md, 11, A5). Private to libcore/scene.
#pragma once

#include <unordered_map>
#include <vector>

#include "scene/compile/contacts/flat_faces.h"
#include "scene/compile/meshes/union_find.h"

namespace cistula {

/// Faces that are to lie in one plane: that of the largest.
class PlaneSets {
  public:
    /// `exact`: how far faces may be apart if that is above 0; else what `range` and their bodies say.
    PlaneSets(const std::vector<FlatFace>& faces, const std::vector<ContactBody>& bodies,
              const std::vector<uint32_t>& body_of, const ContactRange& range, double exact)
        : faces_(faces), bodies_(bodies), body_of_(body_of), range_(range), exact_(exact), roots_(faces.size()) {}

    uint32_t root(uint32_t i) { return roots_.root(i); }

    /// Makes one set of those of two faces. False if that would take a face beyond its tolerance of the plane, or put
    /// two opposite faces of a closed body into it.
    bool join(uint32_t a, uint32_t b);

    struct Set {
        uint32_t largest;
        std::vector<uint32_t> members;
        std::unordered_map<uint32_t, bool> along;  // of closed bodies: whether their faces have the plane's direction
    };
    Set& set(uint32_t root);

    /// How far a face may be from a larger one's plane. Numbers that a file writes alike were rounded alike: faces
    /// along one axis are as far apart as they say.
    double tolerance(const FlatFace& plane, const FlatFace& face) const;
    bool is_larger(uint32_t a, uint32_t b) const {
        return faces_[a].area != faces_[b].area ? faces_[a].area > faces_[b].area : a < b;
    }
    const ContactBody& body(const FlatFace& face) const { return bodies_[body_of_[face.solid]]; }
    bool exact() const { return exact_ > 0; }

  private:
    const std::vector<FlatFace>& faces_;
    const std::vector<ContactBody>& bodies_;
    const std::vector<uint32_t>& body_of_;
    const ContactRange& range_;
    const double exact_;
    UnionFind roots_;
    std::unordered_map<uint32_t, Set> sets_;  // by root; of faces that are in pairs
};

}  // namespace cistula
