#include "render/frame/frame_view.h"

#include <array>
#include <vector>

#include "base/box.h"
#include "cistula/geometry/shared_plane.h"
#include "scene/compile/lights/compile_lights.h"
#include "scene/compile/solids/compile_solids.h"

namespace cistula {
namespace {

using glm::dvec3;

struct FacePlane {
    dvec3 normal;
    double offset;
    double apart;  // how far from the plane rays start
};

/// Collects the planes of the faces on which a camera lies.
template <class Real>
class FacesAtCamera {
  public:
    FacesAtCamera(const CompiledScene<Real>& scene, const dvec3& camera, const dvec3& half_unit)
        : scene_(scene),
          view_(scene.view()),
          camera_(camera),
          half_unit_(half_unit),
          unit_(double(RealTraits<Real>::unit) * double(scene.extent)) {}

    /// `is_far`: it is beyond all but planes without end.
    std::vector<FacePlane> find(bool is_far) {
        for (size_t i = 0; i < scene_.disks.size(); ++i) look_at_disk(scene_.disks[i], scene_.disk_planes[i]);
        if (is_far) return std::move(planes_);
        std::vector<bool> near(scene_.solids.size());
        for (size_t i = 0; i < scene_.solids.size(); ++i) near[i] = may_touch(scene_.hulls[i], scene_.reaches[i]);
        for (const uint32_t i : scene_.convex)
            if (near[i]) look_at_solid(i);
        for (const Cluster<Real>& cluster : scene_.clusters)
            if (near[cluster.solid]) look_at_triangles(cluster);
        return std::move(planes_);
    }

  private:
    static constexpr double touching = 16;  // times the rounding of a distance
    static constexpr double apart = 32;     // u M

    /// The rounding of a point's distance from a plane: u times the terms of the sum. A camera near a plane through the
    /// middle of a large scene knows its side better than to u M.
    double rounding_of(const dvec3& normal, const dvec3& size, double offset) const {
        double sum = magnitude(offset);
        for (int axis = 0; axis < 3; ++axis) sum += magnitude(normal[axis]) * size[axis];
        return double(RealTraits<Real>::unit) * sum;
    }
    dvec3 camera_size() const { return {magnitude(camera_.x), magnitude(camera_.y), magnitude(camera_.z)}; }

    bool may_touch(const Hull& hull, const ContactReach& reach) const {
        const double range = max_or_second(apart * unit_, reach.most);
        Box box;
        for (const Vec3<double>& p : hull.points) box.add(p);
        bool inside = !box.empty();
        for (int axis = 0; axis < 3; ++axis)
            inside = inside && camera_[axis] >= box.low[axis] - range && camera_[axis] <= box.high[axis] + range;
        return inside;
    }

    /// How far the camera may be from a face to lie on it. `rounding`: of its distance.
    double range(const PlaneEquation& plane, const Box& box, double rounding, uint32_t solid) const {
        return max_or_second(touching * rounding,
                             point_tolerance(scene_.reaches[solid], plane, camera_, half_unit_, box));
    }

    /// The rounding of a distance from a face: at least the slack of its shared plane, if it has one.
    double with_slack(double rounding, uint32_t plane) const {
        return plane == no_plane ? rounding : max_or_second(rounding, double(scene_.shared_planes[plane].slack));
    }

    void look_at_solid(uint32_t index) {
        const Solid& solid = scene_.solids[index];
        const dvec3 size = camera_size() + dvec3(square_root(double(solid.padded_square)));
        const dvec3 center(solid.center), radius(square_root(double(solid.padded_square)));
        const Box box{center - radius, center + radius};
        std::vector<FacePlane> at_camera;
        for (const SolidPlane& plane : solid_planes(view_, solid)) {
            const double outside = dot(plane.normal, camera_) - plane.offset;
            const double rounding =
                with_slack(rounding_of(plane.normal, size, plane.offset), plane_of_face(view_, index, plane.face));
            const double near = range({plane.normal, plane.offset}, box, rounding, index);
            if (outside > near) return;
            if (outside >= -near)
                at_camera.push_back({plane.normal, plane.offset, apart * max_or_second(unit_, rounding)});
        }
        for (const FacePlane& plane : at_camera) add(plane);
    }

    /// On which side of a disk the camera is, double tells; rays start there in any precision (keep_sides).
    void look_at_disk(const Disk<Real>& disk, const PlaneEquation& plane) {
        constexpr double in_double = RealTraits<double>::unit / double(RealTraits<Real>::unit);
        const double rounding = rounding_of(plane.normal, camera_size(), plane.offset);
        const dvec3 off = camera_ - dvec3(disk.center);
        Box box;
        box.add(camera_);
        if (magnitude(plane.distance(camera_)) <= range(plane, box, in_double * rounding, disk.solid) &&
            (disk.is_endless() || dot(off, off) <= double(disk.square)))
            add({plane.normal, plane.offset, apart * max_or_second(unit_, with_slack(rounding, disk.plane))});
    }

    void look_at_triangles(const Cluster<Real>& cluster) {
        const double most = max_or_second(touching * unit_, scene_.reaches[cluster.solid].most);
        for (uint32_t lane = 0; lane < cluster.count; ++lane) {
            std::array<dvec3, 3> corner;
            for (size_t c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis) corner[c][axis] = double(cluster.corner[c][axis][lane]);
            if (!near_triangle(corner, camera_, most)) continue;
            const dvec3 normal = normalized(cross(corner[1] - corner[0], corner[2] - corner[0]));
            const double offset = dot(normal, corner[0]);
            dvec3 size = camera_size();
            Box box;
            for (const dvec3& p : corner) box.add(p);
            for (const dvec3& p : corner)
                for (int axis = 0; axis < 3; ++axis) size[axis] = max_or_second(size[axis], magnitude(p[axis]));
            const double rounding = with_slack(rounding_of(normal, size, offset),
                                               plane_of_face(view_, cluster.solid, cluster.triangle[lane]));
            if (magnitude(dot(normal, camera_) - offset) <= range({normal, offset}, box, rounding, cluster.solid))
                add({normal, offset, apart * max_or_second(unit_, rounding)});
        }
    }

    /// Adds a plane that is not yet among them, in either direction.
    void add(const FacePlane& plane) {
        if (planes_.size() == FrameView::most_planes) return;
        for (const FacePlane& known : planes_) {
            const dvec3 across = cross(known.normal, plane.normal);
            if (dot(across, across) < same_direction) return;
        }
        planes_.push_back(plane);
    }
    static constexpr double same_direction = 0x1p-30;  // square of a sine: planes within 2^-15 of one direction are one

    const CompiledScene<Real>& scene_;
    const SceneView<Real> view_;
    const dvec3 camera_, half_unit_;
    const double unit_;  // u M
    std::vector<FacePlane> planes_;
};

/// Moves the start of rays that rounding could put beyond a disk's plane off that, by 16 times their rounding at most:
/// lines that come near it far from the scene are then met behind their start.
template <class Real>
void keep_sides(const CompiledScene<Real>& scene, dvec3& start) {
    const double least = 8 * double(RealTraits<Real>::unit) * length(start);
    for (int round = 0; round < 3; ++round)  // a step off one plane may lead back to another
        for (size_t i = 0; i < scene.disks.size(); ++i) {
            const double distance = scene.disk_planes[i].distance(start);
            if (distance == 0) continue;
            const double side = distance > 0 ? 1 : -1;
            const double seen = side * double(distance_from(scene.shared_planes[scene.disks[i].plane],
                                                            Vec3<Real>(Vec3<double>(start))));
            if (seen < least) start += side * (2 * least - seen) * scene.disk_planes[i].normal;
        }
}

}  // namespace

template <class Real>
void set_camera_sides(const CompiledScene<Real>& scene, const dvec3& half_unit, FrameView& frame) {
    const dvec3 camera = frame.camera.position;
    std::vector<FacePlane> planes;
    planes = FacesAtCamera<Real>(scene, camera, half_unit).find(frame.is_far);
    frame.camera_planes = int(planes.size());
    for (size_t i = 0; i < planes.size(); ++i) frame.camera_normals[i] = planes[i].normal;
    for (int side = 0; side < 1 << frame.camera_planes; ++side) {
        dvec3 start = camera;
        for (int round = 0; round < 4; ++round)  // a step off one plane may lead back to another
            for (size_t i = 0; i < planes.size(); ++i) {
                const double sign = side >> i & 1 ? 1 : -1;
                const double distance = sign * (dot(planes[i].normal, start) - planes[i].offset);
                if (distance < planes[i].apart) start += (planes[i].apart - distance) * sign * planes[i].normal;
            }
        keep_sides(scene, start);
        frame.camera_sides[side].start = start;
    }
}

template void set_camera_sides(const CompiledScene<float>&, const dvec3&, FrameView&);
template void set_camera_sides(const CompiledScene<double>&, const dvec3&, FrameView&);

}  // namespace cistula
