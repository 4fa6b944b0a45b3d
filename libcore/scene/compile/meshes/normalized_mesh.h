// A mesh in the frame. Private to libcore/scene.
#pragma once

#include "cistula/numerics/vec.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/mesh_source.h"

namespace cistula {

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

}  // namespace cistula
