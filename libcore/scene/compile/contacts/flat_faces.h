// Bodies as contacts see them: vertices in the frame and flat faces, in double and before anything is moved or rounded
// to a scene's precision (docs/rules.md, 11, LOAD). Private to libcore/scene.
#pragma once

#include <span>
#include <vector>

#include "base/box.h"
#include "cistula/geometry/ray.h"
#include "scene/compile/scene_source.h"
#include "scene/compile/solids/compile_solids.h"
#include "scene/trees/tree_build.h"

namespace cistula {

/// Where a body is by its own numbers alone, times the frame's factor, which is a power of two: nothing that is
/// elsewhere in the scene changes it.
struct BodyPlace {
    glm::dvec3 anchor{0};                 // a point of it, from the file's origin
    Box span;                             // around it, from the anchor; of a plane without end empty
    double largest = 0;                   // coordinate from the file's origin
    double scaled = 0;                    // radius of a described solid
    const DiskObject* endless = nullptr;  // the plane without end that it is, if it is one

    BodyPlace() = default;
    BodyPlace(const SourceSolid& solid, double factor);
    /// Its vertices from the anchor, in the order of the solid's own.
    std::vector<glm::dvec3> vertices(const SourceSolid& solid, double factor) const;
    /// Half the longest side of its span.
    double half_side() const;
};

/// A solid that comes near another one.
struct ContactBody {
    uint32_t solid = 0;
    bool closed = false;  // it has an inside
    ContactReach reach;
    const BodyPlace* place = nullptr;
    double pad = 0;                       // by how much its boxes are grown where what comes near is looked for
    const ConvexSolid* planes = nullptr;  // of a Platonic solid, as given; null: it is a mesh
    bool moved = false;                   // some points are not where they were given
    bool flat = false;                    // a sheet in one plane whose faces are joined
    std::vector<glm::dvec3> given;        // vertices from the place's anchor
    std::vector<glm::dvec3> points;       // vertices in the frame
    std::vector<uint32_t> welded;         // for each vertex the first at its position
    std::vector<TriangleCorners> facets;  // triangles of all its surface
    std::vector<uint32_t> near;           // facets of a mesh of which faces are made
    std::vector<uint32_t> numbers;        // what its faces list
};

/// A flat face of a solid: triangles of a mesh that lie in one plane and are joined by edges, or a Platonic solid's
/// face.
struct FlatFace {
    const ContactBody* body;
    uint32_t solid, number;             // in the list that it is in
    bool as_given;                      // from the body's anchor, before anything is moved; else in the frame
    int level;                          // the axis along which all corners have one coordinate; -1: none
    std::span<const uint32_t> parts;    // numbers of triangles of the mesh; of a Platonic solid 2 slab + side
    std::span<const uint32_t> corners;  // vertices of the body, each position once, ascending; of a Platonic solid in
                                        // order
    glm::dvec3 normal;                  // unit; outward, as wound
    double offset;                      // normal.x of its middle
    double area;                        // of a plane without end, as given, infinite
    glm::dvec3 middle;                  // of the corners
    Box box, in_frame;                  // the same where it is not as given

    const std::vector<glm::dvec3>& points() const { return as_given ? body->given : body->points; }
    bool is_endless() const { return as_given && body->place->endless; }
};

/// From where a's coordinates are counted to where b's are.
inline glm::dvec3 way_between(const FlatFace& a, const FlatFace& b) {
    return a.as_given ? b.body->place->anchor - a.body->place->anchor : glm::dvec3(0);
}

/// The lengths within which bodies touch, in the frame (docs/rules.md, 11, A3).
class ContactRange {
  public:
    ContactRange(const SceneSource& source, double factor);

    bool given() const { return contact_.has_value(); }
    /// 2^-20 of half the longest side of the box around two bodies, or around one and itself; of two planes without
    /// end 16 ulps.
    double tau(const BodyPlace& a, const BodyPlace& b) const;
    /// The tolerance of two bodies where coordinates may be off by `rounding`, and thin ones allow no more than `most`.
    double tolerance(const BodyPlace& a, const BodyPlace& b, double rounding, double most) const;

  private:
    static constexpr double share = 0x1p-20;
    /// 16 ulps of the largest coordinate of two bodies.
    static double ulps(const BodyPlace& a, const BodyPlace& b);

    std::optional<double> contact_;  // that the scene gives: what files may have rounded away does not count
};

/// The most that rounding may have moved a plane far beyond its corners, in what it may have moved these.
inline constexpr double most_leverage = 32;

/// How far rounding may have moved a plane at its corners.
double rounding_along(const glm::dvec3& normal, const glm::dvec3& half_unit);

/// The largest sheet that is searched for faces of its own that overlap, and the largest mesh of which all triangles
/// are joined to faces, whatever is near them; in triangles.
inline constexpr uint32_t most_in_full = 4096;

/// Whether two boxes, one of them grown by `pad`, touch.
bool touch(const Box& a, const Box& b, double pad);
Box padded(const Box& box, double pad);
Box moved(const Box& box, const glm::dvec3& way);

/// Finds solids whose boxes, each grown by its own pad, meet another's.
class NearSolids {
  public:
    /// `boxes`: of each solid in the frame.
    NearSolids(std::vector<Box> boxes, std::vector<double> pads);
    bool meets_another(const Box& box, uint32_t solid) const {
        return any_near(box, solid, [](uint32_t) { return true; });
    }
    /// Whether found(other) holds for another solid whose box meets one that is grown by a solid's pad, if it is of
    /// one; asks no further once it does.
    template <class Found>
    bool any_near(const Box& box, uint32_t solid, const Found& found) const {
        if (box.empty()) return false;
        const Box grown = padded(box, solid == no_solid ? 0 : pads_[solid]);
        return any_in_box(tree_, grown, [&](uint32_t other) {
            return other != solid && touch(grown, boxes_[other], pads_[other]) && found(other);
        });
    }

  private:
    std::vector<Box> boxes_;
    std::vector<double> pads_;
    Tree tree_;
};

/// Makes faces, as given, of the triangles of a mesh: the largest triangle begins one, its neighbors join
/// while their corners lie within twice the tolerance of its plane and they face alike. A face has the direction of its
/// area. If a corner then lies farther than twice the tolerance from the face, its triangles are faces by themselves.
/// The faces list numbers that the body keeps, in place of those of before.
std::vector<FlatFace> joined_faces(ContactBody& body);

/// The corners of a triangle.
std::array<glm::dvec3, 3> points_of(std::span<const glm::dvec3> points, const TriangleCorners& corners);

/// Makes a face of each of the triangles of a mesh, in the frame.
std::vector<FlatFace> single_faces(ContactBody& body);

/// The faces of a polyhedron, as given or in the frame; if it was moved, as its corners say.
std::vector<FlatFace> polyhedron_faces(const ContactBody& body, const SolidObject& solid, bool as_given);

/// The one face of a plane without end, as given.
std::vector<FlatFace> endless_faces(ContactBody& body);

/// A face as it is given, or in the frame.
FlatFace seen(const FlatFace& face, bool as_given, const SourceSolid& solid);

/// How far a point of `of` lies beyond a plane, both as given or both in the frame.
double signed_distance(const FlatFace& plane, const FlatFace& of, const glm::dvec3& point);

/// The largest distance of a face's corners from another's plane, both as given or both in the frame.
double farthest_from(const FlatFace& plane, const FlatFace& face);

/// Whether two triangles of one plane overlap by more than `least` in every direction.
bool overlap(const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b, double least);

}  // namespace cistula
