// Rendering of one pixel: the body of both backends' loops.
#pragma once

#include "cistula/model/camera.h"
#include "cistula/model/lattice_settings.h"
#include "cistula/transport/ray_tree.h"

namespace cistula {

/// Where primary rays start, and inside which solids.
struct CameraSide {
    Vec3<double> start;  // at the camera, or beside it if it lies on faces
    InteriorList media;  // found by camera_solids
};

/// A frame's settings for every pixel. The camera is in the scene's frame.
struct FrameView {
    static constexpr int most_planes = 3;

    Camera camera;
    /// The faces on which the camera lies, by their normals: a ray starts on the side to which it goes (docs/rules.md,
    /// 11).
    int camera_planes = 0;
    Vec3<double> camera_normals[most_planes];
    CameraSide camera_sides[1 << most_planes];  // bit i: the side of normal i; without such faces the first alone
    double unit_length = 1;                     // scene units per unit of the frame
    double half_sample = 0;                     // tangent of the angle of half a sample, at the picture's center
    bool is_far = false;                        // the camera is outside the sphere of radius 2 M
    int width = 0;
    int height = 0;
    int supersample = 1;
    TreeSettings tree;
    LatticeSettings lattice;  // if it has a target: supersample is then 16
    LayerPlan layers;
};

/// The number of the CameraSide of a ray.
CISTULA_INLINE int camera_side(const FrameView& frame, const Vec3<double>& direction) {
    int side = 0;
    for (int i = 0; i < frame.camera_planes; ++i) side |= int(dot(frame.camera_normals[i], direction) > 0) << i;
    return side;
}

/// Whether rays from a point start at the sphere of radius 2 M instead of there.
CISTULA_HD inline bool is_far(const Vec3<double>& point, double extent) {
    return dot(point, point) > 4 * extent * extent;
}

/// Whether a scene has disks.
template <class Scene>
CISTULA_HD inline bool has_disks(const Scene& scene) {
    if constexpr (requires { scene.disks; })
        return !scene.disks.empty();
    else
        return false;
}

/// Moves the origin of a ray that starts beyond the sphere of radius 2 M to where it enters that (docs/rules.md, 1), by
/// `start`. False if it misses the sphere.
CISTULA_HD inline bool enter_sphere(double extent, const Vec3<double>& direction, Vec3<double>& origin, double& start) {
    // Computed from the closest approach, so that a camera at a distance of 1e9 loses no more than its own rounding.
    const double radius = 2 * extent;
    const double square = radius * radius;
    const double along_view = dot(origin, direction);
    const Vec3<double> closest = along(origin, -along_view, direction);
    const double rest = square - dot(closest, closest);
    if (!(rest > 0) || along_view > 0) return false;
    const double half = rest > 0x1p-100 ? rest * inverse_root(rest) : 0;
    start = -along_view - half;
    origin = along(closest, -half, direction);
    return true;
}

/// Sets a ray's origin and direction, rounded to its number type.
template <class Real, class Media>
CISTULA_HD inline void place(Ray<Real, Media>& ray, const Vec3<double>& origin, const Vec3<double>& direction) {
    ray.origin = Vec3<Real>(origin);
    ray.direction = Vec3<Real>(direction);
    for (int axis = 0; axis < 3; ++axis) materialize(ray.origin[axis]), materialize(ray.direction[axis]);
}

/// Moves a ray that starts beyond the sphere of radius 2 M to where it enters that, by `start`; `after` then says that
/// disks are met from -start on. False if it meets nothing.
template <class Real, class Media, class Scene>
CISTULA_HD inline bool begin_from_afar(const Scene& scene, const Vec3<double>& direction, Vec3<double>& origin,
                                       Ray<Real, Media>& ray, double& start) {
    const bool enters = enter_sphere(double(scene.extent), direction, origin, start);
    if (enters && has_disks(scene)) ray.after.t = Real(-1 - start);
    return enters || has_disks(scene);
}

/// The primary ray, starting where it enters the sphere of radius 2 M, computed in double for either Real. `start` is
/// the distance of that point from the camera. False if the ray meets nothing.
template <class Real, class Media, class Scene>
CISTULA_HD inline bool primary_ray(const Scene& scene, const FrameView& frame, const Vec3<double>& direction,
                                   Ray<Real, Media>& ray, double& start) {
    const CameraSide& side = frame.camera_sides[camera_side(frame, direction)];
    Vec3<double> origin = side.start;
    start = 0;
    if (frame.is_far && !begin_from_afar(scene, direction, origin, ray, start)) return false;
    place(ray, origin, direction);
    assign(ray.media, side.media);
    return true;
}

/// The primary ray through the point (x, y) of the picture, and its direction in double.
template <class Real, class Media, class Scene>
CISTULA_HD inline bool primary_ray(const Scene& scene, const FrameView& frame, double x, double y,
                                   Ray<Real, Media>& ray, Vec3<double>& direction, double& start) {
    direction = camera_direction(frame.camera, x, y, frame.width, frame.height);
    return primary_ray(scene, frame, direction, ray, start);
}

/// The meshes that contain a point, found by counting the crossings of a straight ray from outside. False if there are
/// more than an interior list holds.
template <class Scene, FindsHits<typename Scene::Scalar, InteriorList> Intersector>
CISTULA_HD inline bool camera_meshes(const Scene& scene, const Intersector& intersector, const Vec3<double>& point,
                                     InteriorList& media) {
    using Real = typename Scene::Scalar;
    // A direction along no axis, edge or symmetry that a scene is likely to have.
    const Vec3<double> direction = normalized(Vec3<double>(0.36, 0.48, 0.8112));
    // The ray starts at the sphere of radius 2 M, like all rays (docs/rules.md, 1).
    const double ahead = dot(point, direction);
    const double rest = 4 * double(scene.extent) * double(scene.extent) - (dot(point, point) - ahead * ahead);
    const double distance = ahead + square_root(max_or_second(rest, 0.0));
    Ray<Real> ray;
    ray.origin = Vec3<Real>(along(point, -distance, direction));
    ray.direction = Vec3<Real>(direction);
    ray.accept_both_sides();
    bool fits = true;
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

/// The solids that contain a point. False if there are more than an interior list holds.
template <class Scene, class Intersector>
CISTULA_HD inline bool camera_solids(const Scene& scene, const Intersector& intersector, const Vec3<double>& point,
                                     InteriorList& media) {
    media = InteriorList();
    if (is_far(point, double(scene.extent))) return true;
    bool fits = true;
    bool meshes = false;
    for (uint32_t i = 0; i < scene.solids.size; ++i) {
        meshes |= scene.solids[i].kind == SolidKind::mesh;
        if (scene.solids[i].kind == SolidKind::convex && is_in_convex(scene, scene.solids[i], point))
            fits &= media.add(i, 1);
    }
    if constexpr (Intersector::Media::meshes)
        if (meshes) fits &= camera_meshes(scene, intersector, point, media);
    return fits;
}

/// Finds the solids around the camera, on each side of the faces on which it lies. False if there are more than an
/// interior list holds.
template <class Scene, class Intersector>
CISTULA_HD inline bool find_camera_solids(const Scene& scene, const Intersector& intersector, FrameView& frame) {
    bool fits = true;
    for (int i = 0; i < 1 << frame.camera_planes; ++i) {
        CameraSide& side = frame.camera_sides[i];
        fits &= camera_solids(scene, intersector, side.start, side.media);
    }
    return fits;
}

/// Records the first hit of a sample.
template <class Real>
struct FirstSeen {
    const FrameView& frame;
    const PixelWork& work;
    PixelRecord& record;
    bool middle;  // whether this sample gives the pixel's id, depth and normal

    CISTULA_INLINE void surface(const Hit<Real>& hit, const Surface<Real>& surface) const {
        ++record.hits;
        if (middle) keep(key_solid(hit.key), hit.t, surface.shading);
    }
    template <class Scene, class Media>
    CISTULA_INLINE void light(const Scene& scene, const VisibleLightHit<Real>& hit, const Ray<Real, Media>& ray) const {
        ++record.hits;
        if (middle) keep(scene.solids.size + hit.light, hit.t, visible_light_normal(scene, hit, ray));
    }

  private:
    CISTULA_INLINE void keep(uint32_t index, Real t, const Vec3<Real>& normal) const {
        record.id = int32_t(index) + 1;
        record.z = float((work.start + double(t)) * work.facing * frame.unit_length);
        for (int c = 0; c < 3; ++c) record.normal[c] = float(normal[c]);
    }
};

/// Records the first hit of a sample, and enters it into the pixel's layers.
template <class Real, class Scene>
struct LayeredFirstSeen {
    FirstSeen<Real> seen;
    const Scene& scene;
    const LayerPlan& plan;
    const PixelLayers& layers;
    uint32_t& flags;

    CISTULA_INLINE void surface(const Hit<Real>& hit, const Surface<Real>& surface) const {
        seen.surface(hit, surface);
        const uint32_t solid = key_solid(hit.key);
        const bool textured = scene.materials[surface.material].texture >= 0;
        const Vec2<Real> uv = textured ? texture_uv(scene, hit, surface.normal) : Vec2<Real>();
        enter(solid, surface.point, hit.t, uv, surface.color, surface.material + 1);
    }
    template <class Media>
    CISTULA_INLINE void light(const Scene&, const VisibleLightHit<Real>& hit, const Ray<Real, Media>& ray) const {
        seen.light(scene, hit, ray);
        enter(scene.solids.size + hit.light, along(ray.origin, hit.t, ray.direction), hit.t, Vec2<Real>(),
              Vec3<Real>(Real(0)), 0);
    }

    /// Enters a hit into the layers. `index`: PixelRecord::id of what is hit, less 1.
    CISTULA_INLINE void enter(uint32_t index, const Vec3<Real>& point, Real t, const Vec2<Real>& uv,
                              const Vec3<Real>& albedo, uint32_t material) const {
        if (plan.objects >= 0 &&
            !count_object(layers.words + plan.objects, plan.object_entries, index + 1, layers.weight))
            flags |= flag_objects_overflow;
        if (plan.first_hit < 0 || !seen.middle) return;
        FirstHit hit;
        for (int c = 0; c < 3; ++c) {
            hit.position[c] = double(point[c]);
            hit.albedo[c] = float(albedo[c]);
        }
        hit.uv[0] = float(uv.x);
        hit.uv[1] = float(uv.y);
        hit.distance = float((seen.work.start + double(t)) * seen.frame.unit_length);
        hit.material = material;
        hit.object = index + 1;
        memcpy(layers.words + plan.first_hit, &hit, sizeof hit);
    }
};

/// A pixel that is being rendered: what all its samples share. E: the effects that are compiled in.
template <class E, class Intersector, class Stack>
struct PixelTask {
    using Scene = typename Intersector::Scene;
    using Real = typename Scene::Scalar;
    using Media = typename Intersector::Media;

    const Scene& scene;
    const FrameView& frame;
    const Intersector& intersector;
    int x, y;         // the pixel, in the full frame
    PixelWork& work;  // of the pixel, or of the thread
    Stack& stack;
    PixelLayers layers = {};  // of effects with fills_layers
};

/// The samples of a pixel to render: all, or every step-th where several threads share a pixel.
struct SampleRange {
    int first = 0;
    int step = 1;
};

/// A sample of a pixel's k x k grid.
struct GridSample {
    int column, row;
    bool middle;  // gives the pixel's id, depth and normal
};

/// The direction of a sample's primary ray.
CISTULA_INLINE Vec3<double> sample_direction(const FrameView& frame, int x, int y, const GridSample& sample) {
    const int k = frame.supersample;
    // Coordinates in half samples from the middle of the picture.
    const int across = 2 * (x * k + sample.column) + 1 - frame.width * k;
    const int down = 2 * (y * k + sample.row) + 1 - frame.height * k;
    return camera_direction(frame.camera, double(across), double(down), frame.half_sample);
}

/// Sample i of a pixel, counted row by row in the k x k grid.
CISTULA_INLINE GridSample grid_sample(int i, int k) {
    const int row = k == 1 ? 0 : i / k;
    const int column = i - row * k;
    return {column, row, column == k / 2 && row == k / 2};
}

/// What a sample's tree may lose.
template <class Real, class E>
CISTULA_INLINE TreeLimit<Real, E::has(keeps_budget)> limit_of(const TreeSettings& settings,
                                                              [[maybe_unused]] const TreeThreshold& threshold) {
    if constexpr (E::has(keeps_budget))
        return {threshold.of_branches(settings), threshold.left(settings)};
    else
        return TreeLimit<Real, false>(settings);
}

/// Renders a sample and adds it to the record, and to the pixel's layers `weight` times. False if it lost too much for
/// its threshold, and was given up.
template <class E, class Intersector, class Stack>
CISTULA_INLINE bool render_sample(const PixelTask<E, Intersector, Stack>& task, const TreeThreshold& threshold,
                                  const GridSample& sample, PixelRecord& record, [[maybe_unused]] int weight = 1) {
    using Task = PixelTask<E, Intersector, Stack>;
    using Real = typename Task::Real;
    const FrameView& frame = task.frame;
    const TreeSettings& settings = frame.tree;
    Ray<Real, typename Task::Media> ray;
    const Vec3<double> direction = sample_direction(frame, task.x, task.y, sample);
    SumsOf<Real, E> sums(settings, task.scene, record, task.work.flags, limit_of<Real, E>(settings, threshold));
    [[maybe_unused]] const PixelLayers layers{task.layers.words, weight};
    if constexpr (E::has(fills_layers)) sums.divide(frame.layers, layers, task.scene.light_groups);
    ++task.work.rays.primary;
    double start;
    if (!primary_ray(task.scene, frame, direction, ray, start)) {
        sums.add(background_radiance<E>(task.scene, Vec3<Real>(direction)), LightSource::background);
        return true;
    }
    if (sample.middle) {
        task.work.start = start;
        task.work.facing = dot(direction, frame.camera.forward);
    }
    RayTree<Real, E, Intersector, Stack> tree(task.scene, task.intersector, settings.depth, sums, task.work.rays,
                                              task.stack);
    const FirstSeen<Real> seen{frame, task.work, record, sample.middle};
    if constexpr (E::has(fills_layers))
        tree.trace(
            ray, LayeredFirstSeen<Real, typename Task::Scene>{seen, task.scene, frame.layers, layers, task.work.flags});
    else if constexpr (requires { Intersector::few_are_lit; } && !E::has(keeps_budget))
        tree.trace_together(ray, seen);
    else
        tree.trace(ray, seen);
    if constexpr (E::has(keeps_budget)) return sums.left() >= 0;
    return true;
}

/// Initializes a pixel's record before its first sample; end_pixel completes it after the last.
CISTULA_INLINE void begin_pixel(PixelRecord& record) {
    record = PixelRecord();
    record.z = RealTraits<float>::infinity;
}
CISTULA_INLINE void end_pixel(PixelRecord& record, const PixelWork& work) {
    record.rays = work.rays.total();
    record.samples = work.rays.primary;
}

/// Renders a sample, and as often again as it loses too much. What was given up leaves no trace, and its rays do not
/// count.
template <class E, class Intersector, class Stack>
CISTULA_INLINE void render_within_budget(const PixelTask<E, Intersector, Stack>& task, const GridSample& sample,
                                         PixelRecord& record) {
    const PixelRecord before = record;
    const PixelRays rays = task.work.rays;
    TreeThreshold threshold{task.frame.tree.threshold};
    for (int weight = 1;;) {
        const bool holds = render_sample(task, threshold, sample, record, weight);
        if ((holds && weight > 0) || task.stack.stopped()) return;
        record = before;
        task.work.rays = rays;
        if (E::has(fills_layers) && weight > 0) {
            weight = -1;  // takes back what entered the layers
        } else {
            weight = 1;
            threshold.shrink();
        }
    }
}

/// Renders sample i, counted row by row in the k x k grid, and adds it to the record.
template <class E, class Intersector, class Stack>
CISTULA_INLINE void add_sample(const PixelTask<E, Intersector, Stack>& task, int i, PixelRecord& record) {
    const GridSample sample = grid_sample(i, task.frame.supersample);
    if constexpr (E::has(keeps_budget))
        render_within_budget(task, sample, record);
    else
        render_sample(task, {task.frame.tree.threshold}, sample, record);
}

/// Renders samples of a pixel's k x k grid of centers into its record.
template <class E, class Intersector, class Stack>
CISTULA_INLINE void render_pixel(const PixelTask<E, Intersector, Stack>& task, SampleRange samples,
                                 PixelRecord& record) {
    begin_pixel(record);
    for (int i = samples.first; i < task.frame.supersample * task.frame.supersample; i += samples.step)
        add_sample(task, i, record);
    end_pixel(record, task.work);
}

}  // namespace cistula
