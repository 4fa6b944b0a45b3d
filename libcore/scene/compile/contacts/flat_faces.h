// Bodies as contacts see them: vertices in the frame and flat faces, in double and before anything is moved or rounded
// to a scene's precision (docs/rules.md, 11, LOAD). Private to libcore/scene.
#pragma once

#include <span>
#include <vector>

#include "base/box.h"
#include "scene/compile/scene_source.h"
#include "scene/compile/solids/compile_solids.h"
#include "scene/trees/tree_build.h"

namespace cistula {

/// A solid that comes near another one.
struct ContactBody {
    uint32_t solid;
    bool closed;  // it has an inside
    ContactReach reach;
    const ConvexSolid* planes = nullptr;  // of a Platonic solid, as given; null: it is a mesh
    bool moved = false;                   // some points are not where they were given
    bool flat = false;                    // a sheet in one plane whose faces are joined
    std::vector<glm::dvec3> points;       // vertices in the frame
    std::vector<uint32_t> welded;         // for each point the first at its position
    std::vector<TriangleCorners> facets;  // triangles of all its surface
    std::vector<uint32_t> near;           // facets of a mesh that come near another solid
    std::vector<uint32_t> numbers;        // what its faces list
};

/// A flat face of a solid: triangles of a mesh that lie in one plane and are joined by edges, or a Platonic solid's
/// face.
struct FlatFace {
    const ContactBody* body;
    uint32_t solid, number;             // in the list that it is in
    int level;                          // the axis along which all corners have one coordinate; -1: none
    std::span<const uint32_t> parts;    // numbers of triangles of the mesh; of a Platonic solid 2 slab + side
    std::span<const uint32_t> corners;  // vertices of the body, each position once, ascending; of a Platonic solid in
                                        // order
    glm::dvec3 normal;                  // unit; outward, as wound
    double offset;                      // normal.x of its middle
    double area;
    glm::dvec3 middle;  // of the corners
    Box box;
};

/// The lengths within which things touch, in the frame.
struct ContactRange {
    double touching;  // that the scene gives, or 2^-20 M: tau
    bool given;       // by the scene: what files may have rounded away does not count
    double near;      // up to which gaps are told of: 16 tau, or the largest tolerance if that is more

    explicit ContactRange(const SceneSource& source, const SceneNormalization& normalization);
    /// The tolerance where coordinates may be off by `rounding`, and thin bodies allow no more than `most`.
    double tolerance(double rounding, double most) const {
        return min_or_second(given ? touching : max_or_second(touching, rounding), most);
    }
};

/// How far rounding may have moved a plane.
double rounding_along(const glm::dvec3& normal, const glm::dvec3& half_unit);

/// The largest sheet that is searched for faces of its own that overlap, in triangles.
inline constexpr uint32_t most_with_own = 4096;

/// Whether two boxes, each grown by `pad`, touch.
bool touch(const Box& a, const Box& b, double pad);
Box padded(const Box& box, double pad);

/// Finds solids whose boxes come within `pad` of another's.
class NearSolids {
  public:
    /// `boxes`: of each solid in the frame.
    NearSolids(std::vector<Box> boxes, double pad);
    bool meets_another(const Box& box, uint32_t solid) const;

  private:
    std::vector<Box> boxes_;
    double pad_;
    Tree tree_;
};

/// Makes faces of the triangles of a mesh that come near others: the largest triangle begins one, its neighbors join
/// while their corners lie within twice the tolerance of its plane and they face alike. A face has the direction of its
/// area. If a corner then lies farther than twice the tolerance from the face, its triangles are faces by themselves.
/// The faces list numbers that the body keeps, in place of those of before.
std::vector<FlatFace> joined_faces(ContactBody& body);

/// The corners of one of a body's facets.
std::array<glm::dvec3, 3> points_of(const ContactBody& body, uint32_t facet);

/// Makes a face of each triangle of a mesh.
std::vector<FlatFace> single_faces(ContactBody& body);

/// The faces of a polyhedron; if it was moved, as its corners say.
std::vector<FlatFace> polyhedron_faces(const ContactBody& body, const SolidObject& solid);

/// The largest distance of a face's corners from a plane.
double farthest_from(const glm::dvec3& normal, double offset, const FlatFace& face);

/// Whether two triangles of one plane overlap by more than `least` in every direction.
bool overlap(const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b, double least);

}  // namespace cistula
