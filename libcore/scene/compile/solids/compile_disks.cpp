#include "scene/compile/solids/compile_disks.h"

#include <cmath>

#include "scene/compile/scene_normalization.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double square_side = 2;        // M: half the side of what stands for a plane, which reaches over the scene
constexpr double plane_radius = 0x1p12;  // M: within which every line meets a plane

/// The axes of a disk's texture: that of u is the scene's x axis, or the y axis for normals near that, turned into the
/// plane.
struct TextureAxes {
    dvec3 of[2];

    explicit TextureAxes(const dvec3& normal) {
        const dvec3 along = magnitude(normal.x) > 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
        of[0] = normalized(along - dot(along, normal) * normal);
        of[1] = cross(normal, of[0]);
    }
};

/// A texture coordinate less a whole number of its periods, where there are many: float holds the rest.
double without_periods(double shift, const TextureDescription& texture, size_t axis) {
    constexpr double many = 1024;
    const double period = (texture.wrap[axis] == TextureWrap::mirror ? 2 : 1) / texture.repeat[int(axis)];
    if (texture.wrap[axis] == TextureWrap::clamp || !(magnitude(shift) > many * period)) return shift;
    return shift - period * std::floor(shift / period);
}

}  // namespace

void add_square(SourceSolid& solid, const SceneNormalization& normalization) {
    const DiskObject& disk = *solid.disk;
    const dvec3 normal = normalized(disk.normal);
    const TextureAxes axes(normal);
    const dvec3& middle = normalization.center;
    const bool endless = disk.is_endless();
    const dvec3 center = endless ? middle - dot(normal, middle - disk.center) * normal : disk.center;
    const double half = endless ? square_side * normalization.extent / normalization.factor : disk.radius;
    for (int i = 0; i < 4; ++i)
        solid.mesh.owned_vertices.push_back(center + (i == 1 || i == 2 ? half : -half) * axes.of[0] +
                                            (i >= 2 ? half : -half) * axes.of[1]);
    solid.mesh.owned_triangles = {{0, 1, 2}, {0, 2, 3}};
    solid.mesh.view_owned();
    solid.mesh.rounding = coordinate_rounding({&disk.center, 1});
    solid.closed = false;
}

PlacedDisk::PlacedDisk(const SceneSource& source, uint32_t number, const SceneNormalization& normalization,
                       const Contacts& contacts)
    : solid(number), plane(contacts.plane_of(number, 0)), object(source.solids[number].disk) {
    const ContactPlane& on = contacts.planes[plane];
    equation = {on.normal, dot(on.normal, on.middle)};
    radius = object->radius * normalization.factor;
    center = is_endless() ? dvec3(0) : normalization.point(object->center);
    center -= equation.distance(center) * equation.normal;
}

double PlacedDisk::distance(const dvec3& point) const {
    const double above = equation.distance(point);
    const dvec3 beside = point - above * equation.normal - center;
    const double beyond = max_or_second(length(beside) - radius, 0.0);
    return square_root(above * above + beyond * beyond);
}

Box PlacedDisk::box() const {
    Box box;
    for (const double side : {-1.0, 1.0}) {
        dvec3 end = center;
        for (int axis = 0; axis < 3; ++axis) {
            const double n = equation.normal[axis];
            end[axis] += side * radius * square_root(max_or_second(1 - n * n, 0.0));
        }
        box.add(end);
    }
    return box;
}

template <class Real>
void add_disks(CompiledScene<Real>& scene, const SceneSource& source, const std::vector<PlacedDisk>& disks,
               const SceneNormalization& normalization) {
    for (const PlacedDisk& placed : disks) {
        const SharedPlane<Real>& plane = scene.shared_planes[placed.plane];
        const Solid& solid = scene.solids[placed.solid];
        const bool endless = placed.is_endless();
        const dvec3 normal = normalized(placed.object->normal);
        const double radius = endless ? plane_radius * double(scene.extent) : placed.radius;
        Disk<Real> disk{};
        disk.center = Vec3<Real>(endless ? double(plane.offset) * dvec3(plane.normal) : placed.center);
        disk.square = Real(radius * radius);
        disk.least_slope = endless ? horizon<Real> : Real(2);
        const TextureAxes axes(normal);
        const double unit = endless ? normalization.factor : 2 * placed.radius;
        const int texture = source.materials[solid.material].texture;
        for (size_t k = 0; k < 2; ++k) {
            disk.axes[k] = Vec3<Real>(axes.of[k] / unit);
            double shift =
                endless ? dot(axes.of[k], normalization.center) : 0.5 - dot(axes.of[k], placed.center) / unit;
            if (texture >= 0) shift = without_periods(shift, source.description->textures[size_t(texture)], k);
            disk.shift[k] = Real(shift);
        }
        disk.plane = placed.plane;
        disk.solid = placed.solid;
        disk.face = solid.first_triangle;
        scene.disks.push_back(disk);
        scene.disk_planes.push_back(placed.equation);
    }
}

template void add_disks(CompiledScene<float>&, const SceneSource&, const std::vector<PlacedDisk>&,
                        const SceneNormalization&);
template void add_disks(CompiledScene<double>&, const SceneSource&, const std::vector<PlacedDisk>&,
                        const SceneNormalization&);

}  // namespace cistula
