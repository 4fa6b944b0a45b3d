// One pixel: the body of both backends' loops.
#pragma once

#include "cistula/camera.h"
#include "cistula/ray_tree.h"

namespace cistula {

/// What a frame asks of every pixel. The camera is in the scene's frame.
struct FrameView {
    Camera camera;
    MediaList camera_media;  // the solids that contain the camera (camera_solids)
    double unit_length = 1;  // scene units per unit of the frame
    double half_sample = 0;  // tangent between the middle of the picture and half a sample beside it
    int width = 0, height = 0;
    int supersample = 1;
    TreeSettings tree;
};

/// The ray from the camera, from where it enters the sphere of radius 2 M (NUMERICS, 1), in double for either Real.
/// `start` is how far from the camera that is. False: it passes the scene by.
template <class Real, class Media, class Scene>
CISTULA_HD inline bool primary_ray(const Scene& scene, const FrameView& frame,
                                   const Vec3<double>& direction, Ray<Real, Media>& ray, double& start) {
    Vec3<double> origin = frame.camera.position;
    const double radius = 2 * double(scene.extent), square = radius * radius;
    start = 0;
    if (dot(origin, origin) > square) {
        // By the closest approach: a camera 1e9 away loses no more than its own rounding.
        const double along_view = dot(origin, direction);
        const Vec3<double> closest = along(origin, -along_view, direction);
        const double rest = square - dot(closest, closest);
        if (!(rest > 0) || along_view > 0) return false;
        const double half = square_root(rest);
        start = -along_view - half;
        origin = along(closest, -half, direction);
    }
    ray.origin = Vec3<Real>(origin);
    ray.direction = Vec3<Real>(direction);
    assign(ray.media, frame.camera_media);
    return true;
}

/// The same through the point (x, y) of the picture, whose direction it gives too.
template <class Real, class Media, class Scene>
CISTULA_HD inline bool primary_ray(const Scene& scene, const FrameView& frame, double x, double y,
                                   Ray<Real, Media>& ray, Vec3<double>& direction, double& start) {
    direction = camera_direction(frame.camera, x, y, frame.width, frame.height);
    return primary_ray(scene, frame, direction, ray, start);
}

/// The solids that contain a point: planes for convex ones, crossings of a straight ray from outside for meshes.
template <class Scene, class Intersector>
CISTULA_HD inline bool camera_solids(const Scene& scene, const Intersector& intersector,
                                     const Vec3<double>& point, MediaList& media) {
    using Real = typename Scene::Scalar;
    media = MediaList();
    if (dot(point, point) > 4 * double(scene.extent) * double(scene.extent)) return true;
    bool fits = true;
    bool meshes = false;
    for (uint32_t i = 0; i < scene.solids.size; ++i) {
        meshes |= scene.solids[i].kind == SolidKind::mesh;
        if (scene.solids[i].kind == SolidKind::convex && inside_convex(scene, scene.solids[i], Vec3<Real>(point)))
            fits &= media.add(i, 1);
    }
    if (!meshes) return fits;
    // Through no axis, edge or symmetry that a scene is likely to have.
    const Vec3<double> direction = normalized(Vec3<double>(0.36, 0.48, 0.8112));
    // From the sphere of radius 2 M, as all rays (NUMERICS, 1).
    const double ahead = dot(point, direction);
    const double rest = 4 * double(scene.extent) * double(scene.extent) - (dot(point, point) - ahead * ahead);
    const double distance = ahead + square_root(greatest(rest, 0.0));
    Ray<Real> ray;
    ray.origin = Vec3<Real>(along(point, -distance, direction));
    ray.direction = Vec3<Real>(direction);
    for (;;) {
        const Hit<Real> hit = intersector.closest(ray);
        if (!(double(hit.t) < distance)) return fits;
        const uint32_t solid = key_solid(hit.key);
        const int change = media_change(key_kind(hit.key));
        if (change != 0) ray.media.add(solid, change);
        if (scene.solids[solid].kind == SolidKind::mesh) fits &= media.add(solid, change);
        ray.after = {hit.t, hit.key};
    }
}

/// All samples of pixel (px, py), the k x k grid of centers. Adds to `rays`; returns RenderFlag bits. Branches that `stack`
/// gives away are missing from the record: resume_branch adds them.
template <class Real, class E, class Intersector, class Stack, class Scene>
CISTULA_INLINE uint32_t render_pixel(const Scene& scene, const FrameView& frame,
                                        const Intersector& intersector, int px, int py, PixelRecord& record,
                                        RayCounts& rays, Stack& stack) {
    record = PixelRecord();
    record.z = RealTraits<float>::infinity;
    uint32_t flags = 0;
    RayCounts own;
    const int k = frame.supersample, chosen = (k / 2) * k + k / 2;
    for (int sample = 0; sample < k * k; ++sample) {
        Ray<Real, typename Intersector::Media> ray;
        double start;
        // In half samples from the middle of the picture.
        const int across = 2 * (px * k + sample % k) + 1 - frame.width * k;
        const int down = 2 * (py * k + sample / k) + 1 - frame.height * k;
        const Vec3<double> direction = camera_direction(frame.camera, double(across), double(down), frame.half_sample);
        PixelSums<Real> sums(frame.tree, scene.bound, record, flags);
        ++own.primary;
        if (!primary_ray(scene, frame, direction, ray, start)) {
            sums.add(scene.background);
            continue;
        }
        TreeRays tree_rays;
        RayTree<Real, E, Intersector, Stack> tree(scene, intersector, frame.tree.depth, sums, tree_rays, stack);
        tree.trace(ray, [&](bool anything, const Hit<Real>* surface) {
            record.hits += anything ? 1 : 0;
            if (sample != chosen || !surface) return;
            record.id = int32_t(key_solid(surface->key)) + 1;
            record.z = float((start + double(surface->t)) * dot(direction, frame.camera.forward) * frame.unit_length);
            const Vec3<Real> normal = normal_at(scene, *surface);
            for (int c = 0; c < 3; ++c) record.normal[c] = float(normal[c]);
        });
        own.add(tree_rays);
    }
    record.rays = uint32_t(least(own.total(), uint64_t(0xffffffffu)));
    rays.add(own);
    return flags;
}

/// The same with a stack of its own.
template <class Real, class E, class Intersector, class Scene>
CISTULA_INLINE uint32_t render_pixel(const Scene& scene, const FrameView& frame,
                                        const Intersector& intersector, int px, int py, PixelRecord& record,
                                        RayCounts& rays) {
    BranchStack<Real, typename Intersector::Media> stack;
    return render_pixel<Real, E>(scene, frame, intersector, px, py, record, rays, stack);
}

/// The rest of a tree from a branch that another stack gave away; `record` gets sums and rays of its own.
template <class Real, class E, class Intersector, class Stack, class Scene>
CISTULA_INLINE uint32_t resume_branch(const Scene& scene, const FrameView& frame,
                                         const Intersector& intersector,
                                         Branch<Real, typename Intersector::Media>& branch, PixelRecord& record,
                                         RayCounts& rays, Stack& stack) {
    record = PixelRecord();
    uint32_t flags = 0;
    PixelSums<Real> sums(frame.tree, scene.bound, record, flags);
    TreeRays tree_rays;
    RayTree<Real, E, Intersector, Stack> tree(scene, intersector, frame.tree.depth, sums, tree_rays, stack);
    tree.resume(branch);
    RayCounts own;
    own.add(tree_rays);
    record.rays = uint32_t(own.total());
    rays.add(own);
    return flags;
}

}  // namespace cistula
