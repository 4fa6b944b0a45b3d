#include "backend_embree/native/native_triangles.h"

#include "scene/compile/solid_planes.h"

namespace cistula {
namespace {

using Point = Vec3<double>;
using Polygon = std::vector<Point>;

/// A square in the plane, around the projection of `center` on it and larger than any solid; counter-clockwise seen
/// against the normal.
Polygon square_on(const SolidPlane& plane, const Point& center, double half) {
    const Point& n = plane.normal;
    const Point axis = magnitude(n.x) < 0.5 ? Point(1, 0, 0) : Point(0, 1, 0);
    const Point a = normalized(cross(axis, n)), b = cross(n, a);
    const Point middle = along(center, plane.offset - dot(n, center), n);
    return {middle - (a + b) * half, middle + (a - b) * half, middle + (a + b) * half, middle - (a - b) * half};
}

/// The part of a convex polygon in a half-space (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, const SolidPlane& by) {
    Polygon kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double at_p = dot(by.normal, p) - by.offset, at_q = dot(by.normal, q) - by.offset;
        if (at_p <= 0) kept.push_back(p);
        if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) kept.push_back(along(p, at_p / (at_p - at_q), q - p));
    }
    return kept;
}

/// The corners of a solid. Rounded planes give slightly different coordinates for each face at a corner, but triangles
/// must share them.
class Corners {
  public:
    explicit Corners(double tolerance) : square_(tolerance * tolerance) {}

    Point weld(const Point& p) {
        for (const Point& known : known_)
            if (dot(p - known, p - known) <= square_) return known;
        known_.push_back(p);
        return p;
    }

  private:
    double square_;
    std::vector<Point> known_;
};

template <class Real>
void append_convex(const SceneView<Real>& scene, uint32_t index, std::vector<NativeTriangle>& triangles) {
    const Solid& solid = scene.solids[index];
    const std::vector<SolidPlane> planes = solid_planes(scene, solid);
    const double extent = double(scene.extent);
    Corners corners(double(incidence<Real>) * extent);
    for (const SolidPlane& plane : planes) {
        Polygon polygon = square_on(plane, Point(solid.center), 4 * extent);
        for (const SolidPlane& other : planes)
            if (other.face != plane.face) polygon = clipped(polygon, other);
        Polygon face;
        for (const Point& p : polygon)
            if (const Point corner = corners.weld(p); face.empty() || corner != face.back()) face.push_back(corner);
        while (face.size() > 1 && face.back() == face.front()) face.pop_back();
        for (size_t i = 2; i < face.size(); ++i)
            triangles.push_back(
                {{Vec3<float>(face[0]), Vec3<float>(face[i - 1]), Vec3<float>(face[i])}, index, plane.face, 0});
    }
}

}  // namespace

template <class Real>
std::vector<NativeTriangle> native_triangles(const SceneView<Real>& scene) {
    std::vector<NativeTriangle> triangles;
    for (uint32_t i = 0; i < scene.clusters.size; ++i) {
        const Cluster<Real>& cluster = scene.clusters[i];
        for (uint32_t lane = 0; lane < cluster.count; ++lane) {
            NativeTriangle triangle{{}, cluster.solid, cluster.triangle[lane], i * uint32_t(cluster_lanes) + lane};
            for (int c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis) triangle.corner[c][axis] = float(cluster.corner[c][axis][lane]);
            triangles.push_back(triangle);
        }
    }
    for (const uint32_t index : scene.convex) append_convex(scene, index, triangles);
    return triangles;
}

template std::vector<NativeTriangle> native_triangles(const SceneView<float>&);
template std::vector<NativeTriangle> native_triangles(const SceneView<double>&);

}  // namespace cistula
