// A mesh in the frame: how it is rendered, how thin it is, and how small its triangles are. Private to libcore/scene.
#pragma once

#include "base/box.h"
#include "cistula/numerics/vec.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/mesh_source.h"

namespace cistula {

struct SourceSolid;

/// A mesh as it is rendered: in the frame, moved by contacts, rounded to the scene's precision.
class NormalizedMesh {
  public:
    /// `moved`: the vertices in the frame, if contacts moved some; else empty.
    NormalizedMesh(const MeshSource& source, const SceneNormalization& normalization,
                   const std::vector<glm::dvec3>& moved, bool single_precision)
        : source_(source), normalization_(normalization), moved_(moved), single_(single_precision) {}

    uint32_t size() const { return static_cast<uint32_t>(source_.triangles.size()); }

    const TriangleCorners& corners(uint32_t triangle) const { return source_.triangles[triangle]; }
    Vec3<double> vertex(uint32_t number) const {
        const Vec3<double> p = moved_.empty() ? normalization_.point(source_.vertices[number]) : moved_[number];
        return single_ ? Vec3<double>(Vec3<float>(p)) : p;
    }
    std::array<Vec3<double>, 3> triangle(uint32_t number) const {
        const TriangleCorners& c = corners(number);
        return {vertex(c[0]), vertex(c[1]), vertex(c[2])};
    }

  private:
    const MeshSource& source_;
    const SceneNormalization& normalization_;
    const std::vector<glm::dvec3>& moved_;
    bool single_;
};

/// Sizes of a mesh in the frame, over its triangles with an area and finite corners.
struct MeshSize {
    Box box;
    size_t triangles = 0;
    double half_width = 0;    // area / 2 over the diagonal of the box
    double least_height = 0;  // of a triangle that is higher than asked for; infinity: there is none
};

MeshSize mesh_size(const MeshSource& mesh, const SceneNormalization& normalization, double least_height);

/// The least distance of two triangles that are sides of a wall: they look at or away from each other (of a sheet also
/// the same way), are more than `least` and less than `most` apart, and are no edge of the mesh: neither flat faces
/// with a common edge, nor joined by triangles within 32 times their distance of where they are nearest. Infinity:
/// none.
double thinnest_wall(const SourceSolid& solid, const SceneNormalization& normalization, double least, double most);

/// The least distance of a point from the planes of those triangles that it lies over, of all that are more than
/// `least`; infinity if none is less than `most`.
double distance_to_triangles(const MeshSource& mesh, const SceneNormalization& normalization, const glm::dvec3& point,
                             double least, double most);

}  // namespace cistula
