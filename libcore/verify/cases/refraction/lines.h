// The straight lines of a light path, as the ray tree follows them, recorded by an intersector that notes its queries;
// in scenes in which every face transmits all light or, beyond the critical angle, reflects all.
#pragma once

#include "cistula/transport/pixel.h"
#include "cistula/transport/ray_tree.h"
#include "verify/cases/refraction/interfaces.h"

namespace cistula::verify::refraction {

template <class Real>
struct Lines {
    static constexpr int capacity = 12;

    Vec3<Real> origin[capacity], direction[capacity];
    double index[capacity];     // of the medium in which the line starts
    Hit<Real> first[capacity];  // the first hit, shaded or not
    InteriorList media[capacity];
    int count = 0;
    uint32_t flags = 0;  // RenderFlag bits
    bool cut = false;    // the path is longer than `capacity`

    CISTULA_HD bool whole() const { return flags == 0 && !cut; }
};

template <class Real, class Tracer>
struct Watched {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const Scene& scene;
    const Tracer& inner;
    Lines<Real>& lines;

    template <class E = Effects<all_effects>>
    CISTULA_HD Hit<Real> closest(const Ray<Real>& ray) const {
        const Hit<Real> hit = inner.closest(ray);
        const int last = lines.count - 1;
        const bool asked_before =
            last >= 0 && ray.origin == lines.origin[last] && ray.direction == lines.direction[last];
        if (!ray.fresh() || asked_before || lines.count == Lines<Real>::capacity) return hit;
        lines.origin[lines.count] = ray.origin;
        lines.direction[lines.count] = ray.direction;
        lines.index[lines.count] = index_of(scene, ray.media);
        lines.first[lines.count] = hit;
        lines.media[lines.count] = ray.media;
        ++lines.count;
        return hit;
    }
    template <class E>
    CISTULA_HD Throughput<Real, E> transmittance(const ShadowRay<Real>&) const {
        return Throughput<Real, E>(Real(0));
    }
};

/// An observer of the ray tree that records nothing.
struct Unnoted {
    template <class Hit, class Normal>
    CISTULA_HD void surface(const Hit&, const Normal&) const {}
};

/// Follows the ray's tree. Not inlined: every case calls it, and a tree is much code.
template <class Real, class Tracer>
CISTULA_NOINLINE void trace(const Setup<Real>& setup, const Tracer& intersector, const Ray<Real>& ray,
                            Lines<Real>& lines) {
    using Glass = Effects<effect_reflection | effect_transmission | effect_refraction | effect_insides |
                          effect_contacts | effect_solids | effect_triangles | effect_spheres>;
    using Stack = StackOf<Real, Glass, InteriorList>;
    using Tree = RayTree<Real, Glass, Watched<Real, Tracer>, Stack>;
    TreeSettings settings;
    settings.depth = Lines<Real>::capacity;
    settings.fixed_scale = 0x1p62;
    settings.fixed_unit = 0x1p-62;
    PixelRecord record = PixelRecord();
    const struct {
        Vec3<Real> bound = Vec3<Real>(Real(1));
        Real largest_bound = Real(1);
    } any_scene;
    PixelSums<Real> sums(settings, any_scene, record, lines.flags);
    PixelRays rays;
    typename Stack::Storage storage;
    Stack stack(storage);
    lines.count = 0;
    const Watched<Real, Tracer> watched{setup.scene, intersector, lines};
    Tree(setup.scene, watched, settings.depth, sums, rays, stack).trace(ray, Unnoted());
    lines.cut = record.cut[0] != 0;
}

/// Total reflection in the ray tree: from inside a cube in a larger one, with faces perpendicular to the axes and exact
/// normals.
struct CriticalAngleTraced {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        Draw draw = setup.draw(i);
        // From close to the face that lies against the normal, about its middle.
        const double inner = 0.5 * setup.factor;
        const double gap = draw.unit<double>() * 0.125 + 0.0625;
        const Vec3<double> beside = draw.in_cube<double>(0.25);
        Vec3<Real> origin;
        for (int k = 0; k < 3; ++k)
            origin[k] =
                Real(inner * (record.normal()[k] == Real(0) ? beside[k] : -double(record.normal()[k]) * (1 - gap)));
        const Ray<Real> ray = inside(inside(ray_from(origin, record.direction()), 0), 1);
        Lines<Real> lines;
        trace(setup, intersector, ray, lines);
        tally.expect(lines.flags == 0 && lines.count >= 2 && lines.index[0] == record.from() &&
                     lines.index[1] == (record.total() ? record.from() : record.to()));
        tally.witness(record.total());
    }
};

// ---- bodies between planes x = begin and x = end

/// The first twelve numbers of a part: the position of x = y = z = 0 in the frame and the three axes.
CISTULA_HD inline Vec3<double> placed(const Span<double>& numbers, double x, double y, double z) {
    Vec3<double> p(numbers[0], numbers[1], numbers[2]);
    for (int k = 0; k < 3; ++k) p[k] += x * numbers[3 + k] + y * numbers[6 + k] + z * numbers[9 + k];
    return p;
}

struct PlaceOnFace {
    double y, z;
};

/// A random point: within `reach` of the x axis, on it, or on a diagonal of a mesh's faces.
CISTULA_HD inline PlaceOnFace place_on_face(Draw& draw, double reach) {
    double y = draw.centered<double>(reach), z = draw.centered<double>(reach);
    const int where = draw.between(0, 5);
    if (where == 0) y = z = 0;
    if (where == 1) y = z;
    if (where == 2) y = -z;
    return {y, z};
}

/// Sets the media around the ray's origin to the solids of these bits.
template <class Real>
CISTULA_HD inline void surround(Ray<Real>& ray, uint32_t solids) {
    for (uint32_t solid = 0; solid < 8; ++solid)
        if ((solids >> solid & 1u) != 0) ray.media.add(solid, 1);
}

/// Rays through faces that are all perpendicular to one axis; the sequence of indices follows from the intervals alone.
/// Numbers: the place; the number of intervals, the greatest distance of rays from the x axis, the sine of their
/// greatest angle to it in air; then for every interval its ends, its index, the solids there as bits.
struct MediaSequence {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        const Span<double>& numbers = setup.numbers;
        const auto at = [&](double x, double y, double z) { return placed(numbers, x, y, z); };
        const uint32_t count = uint32_t(numbers[12]);
        const double reach = numbers[13];
        const double sine = numbers[14];
        const auto interval = [&](uint32_t k) { return numbers.data + 15 + 4 * k; };
        Draw draw = setup.draw(i);
        const uint32_t start = draw.below(count - 1);
        const double* from = interval(start);
        const auto [y, z] = place_on_face(draw, reach);  // the next one
        const Vec3<double> slope = in_ball(draw) * (sine / from[2]);
        const double across = square_root(1 - slope.y * slope.y - slope.z * slope.z);
        const double back = (from[1] - from[0]) * (0.0625 + 0.875 * draw.unit<double>()) / across;
        const Vec3<Real> target(at(from[1], y, z));
        const Vec3<Real> origin(at(from[1] - back * across, y - back * slope.y, z - back * slope.z));
        Ray<Real> ray = ray_from(origin, normalized(target - origin));
        surround(ray, uint32_t(from[3]));
        Lines<Real> lines;
        trace(setup, intersector, ray, lines);
        bool same = lines.whole();
        int line = 0;
        for (uint32_t k = start; k < count && same; ++k) {
            if (k > start && interval(k)[2] == interval(k - 1)[2]) continue;
            same = line < lines.count && lines.index[line] == interval(k)[2];
            ++line;
        }
        tally.expect(same && line == lines.count);
    }
};

/// Eight cubes of one glass that share faces, edges and a corner act as one cube: a ray inside is in one medium,
/// however it is reflected.
struct Octants {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> target = setup.any_point(draw);
        const Vec3<double> way = on_sphere(draw);
        const Vec3<Real> origin(Vec3<double>(target) + way * (setup.numbers[0] * (2.5 + draw.unit<double>())));
        Lines<Real> lines;
        trace(setup, intersector, ray_from(origin, normalized(target - origin)), lines);
        bool one_body = lines.flags == 0 && lines.count >= 2 && lines.index[0] == 1 && lines.index[1] == 1.5;
        for (int k = 2; k < lines.count; ++k) one_body = one_body && lines.index[k] <= lines.index[k - 1];
        tally.expect(one_body && (lines.cut || lines.index[lines.count - 1] == 1));
    }
};

/// Faces shared by bodies, hit at any slant: a line is refracted or reflected there once, and the next face is far
/// away. Rays start a little before the face, at its center. Numbers: the place; the face, the direction through it (1
/// or -1), the indices before and behind it, the solids before it as bits.
struct Grazing {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        const Span<double>& numbers = setup.numbers;
        const auto at = [&](double x, double y, double z) { return placed(numbers, x, y, z); };
        const double face = numbers[12];
        const double onward = numbers[13];
        const double before = numbers[14];
        const double behind = numbers[15];
        const uint32_t solids = uint32_t(numbers[16]);
        Draw draw = setup.draw(i);
        const auto [y, z] = place_on_face(draw, 0.2);
        // A cosine between 1 and 2^-8 before the face or behind it.
        const double cosine = (0.5 + 0.5 * draw.unit<double>()) / (1 << draw.between(0, 7));
        double sine = square_root(1 - cosine * cosine);
        if (draw.one_in(2) && sine * behind < before) sine = sine * behind / before;
        const double beyond = sine * before / behind;
        if (magnitude(beyond - 1) < 0x1p-16) return;  // nearer to the critical angle cosines are less
        const double slope = square_root(1 - sine * sine);
        const double back = 0.05 + 0.1 * draw.unit<double>();
        const Vec3<double> aside = on_sphere(draw);
        const double across = sine / square_root(aside.y * aside.y + aside.z * aside.z);
        const Vec3<Real> target(at(face, y, z));
        const Vec3<Real> origin(
            at(face - back * slope * onward, y - back * across * aside.y, z - back * across * aside.z));
        Ray<Real> ray = ray_from(origin, normalized(target - origin));
        surround(ray, solids);
        Lines<Real> lines;
        trace(setup, intersector, ray, lines);
        bool good = lines.flags == 0 && lines.count >= 2 && lines.index[0] == before &&
                    lines.index[1] == (beyond > 1 ? before : behind);
        // The middle of a face is at least 0.5 away from what else there is.
        good = good && apart(setup, lines.origin[1], target) < 0.01;
        if (good && lines.count > 2) good = apart(setup, lines.origin[2], lines.origin[1]) > 0.1;
        tally.witness(beyond > 1);
        tally.expect(good);
    }

  private:
    /// Distance of two points in scene units.
    template <class Real>
    CISTULA_HD static double apart(const Setup<Real>& setup, const Vec3<Real>& a, const Vec3<Real>& b) {
        return length(Vec3<double>(a) - Vec3<double>(b)) / setup.factor;
    }
};

// ---- other bodies

/// A camera inside a solid must see what a ray from outside sees as it continues from there: the same media, next face
/// and refraction.
struct CameraInside {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> target(in_ball(draw) * 1.0), origin(on_sphere(draw) * (2 * double(setup.extent())));
        Lines<Real> lines;
        trace(setup, intersector, ray_from(origin, normalized(target - origin)), lines);
        if (lines.count < 2) return;
        const int line = int(draw.below(uint32_t(lines.count)));
        const Hit<Real> ahead = lines.first[line];
        const Vec3<Real> direction = lines.direction[line];
        // Well between two faces.
        const Real gone = ahead.found() ? ahead.t * Real(0.25 + 0.5 * draw.unit<double>()) : Real(0.5);
        if (!(gone > Real(0x1p-7)) || edge_ahead(setup, intersector, lines, line)) return;
        const Vec3<double> camera = along(Vec3<double>(lines.origin[line]), double(gone), Vec3<double>(direction));
        InteriorList around;
        bool same = camera_solids(setup.scene, intersector, camera, around);
        for (uint32_t solid = 0; solid < setup.scene.solids.size; ++solid)
            same = same && around.count(solid) == lines.media[line].count(solid);
        Ray<Real> view = ray_from(Vec3<Real>(camera), direction);
        view.media = around;
        Lines<Real> seen;
        trace(setup, intersector, view, seen);
        same = same && seen.flags == 0 && seen.first[0].key == ahead.key;
        // A face that is passed without shading does not start a new line.
        if (line + 1 < lines.count && seen.count > 1 && same)
            same = seen.direction[1] == lines.direction[line + 1] && seen.index[1] == lines.index[line + 1];
        tally.expect(same);
        tally.witness(!around.empty());
    }

    /// Whether lines beside this one, farther away than rounding moves it, hit something else: an edge or a silhouette.
    template <class Real, class Tracer>
    CISTULA_HD static bool edge_ahead(const Setup<Real>& setup, const Tracer& intersector, const Lines<Real>& lines,
                                      int line) {
        Vec3<Real> origin = lines.origin[line];
        const Real beside = Real(256) * RealTraits<Real>::unit * setup.extent();
        for (int k = 0; k < 6; ++k) {
            Ray<Real> ray = ray_from(origin, lines.direction[line]);
            ray.origin[k / 2] += k % 2 != 0 ? beside : -beside;
            ray.media = lines.media[line];
            // Not from the face itself, which lines on its wrong side would hit: from a little farther on.
            ray.origin = along(ray.origin, min_or_second(lines.first[line].t * Real(0.125), Real(0.0625)),
                               lines.direction[line]);
            if (intersector.closest(ray).key != lines.first[line].key) return true;
        }
        return false;
    }
};

/// A prism deviates light least when the path is symmetric. Numbers: unit directions in, out and along the edge; the
/// point of entry of the symmetric path; the cosine of the deviation; a length.
struct PrismDeviation {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        const Vec3<double> in = setup.vector(0);
        const Vec3<double> out = setup.vector(3);
        const Vec3<double> edge = setup.vector(6);
        const Vec3<double> entry = setup.vector(9);
        const double least_cosine = setup.numbers[12];
        const double reach = setup.numbers[13];
        Draw draw = setup.draw(i);
        const bool symmetric = draw.one_in(2);
        const double turn = symmetric ? 0.0 : draw.sign() * magnitude(draw.scaled<double>(-24, -7));
        const double sideways = draw.centered<double>(0.25 * reach);
        const Vec3<Real> way(normalized(in + turn * cross(edge, in)));
        const Vec3<double> from = entry + sideways * edge - Vec3<double>(way) * (0.5 * reach);
        Lines<Real> lines;
        trace(setup, intersector, ray_from(Vec3<Real>(from), way), lines);
        tally.expect(lines.whole() && lines.count == 3);
        if (lines.count != 3) return;
        const Vec3<double> left(lines.direction[2]), came(way);
        const double unit = double(RealTraits<Real>::unit);
        const double cosine = dot(left, came);
        tally.expect(dot(left, out) > 0.99);
        tally.measure(max_or_second(cosine - least_cosine, 0.0) / unit);
        if (symmetric) tally.measure(magnitude(cosine - least_cosine) / unit);
        tally.witness(turn != 0 && cosine < least_cosine);
    }
};

/// A ray from outside through a face of a cube, and where it leaves. Points: the centers of the faces, then the center.
/// Numbers: the index, half of the side.
template <class Real>
struct SlabRay {
    Lines<Real> lines;
    Vec3<double> normal, to;  // outward at the face of entry; direction after the cube
};
/// False for a ray that does not leave by the opposite face, and is no witness.
template <class Real, class Tracer>
CISTULA_HD inline bool pass_slab(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, SlabRay<Real>& ray,
                                 Tally& tally) {
    Draw draw = setup.draw(i);
    const uint32_t face = draw.below(6);
    const Vec3<double> middle = setup.points[6];
    ray.normal = normalized(setup.points[face] - middle);
    // Aimed at a place near the middle of the face, at a sine of 15/16 at most.
    Vec3<double> tangent = in_ball(draw) * 0.9375;
    tangent -= dot(tangent, ray.normal) * ray.normal;
    const Vec3<double> way = tangent - square_root(1 - dot(tangent, tangent)) * ray.normal;
    const Vec3<double> target = setup.points[face] - tangent * (setup.numbers[1] * 0.5);
    ray.to = Vec3<double>(Vec3<Real>(way));
    trace(setup, intersector, ray_from(Vec3<Real>(target - way * (setup.numbers[1] * 0.5)), Vec3<Real>(way)),
          ray.lines);
    const Lines<Real>& lines = ray.lines;
    tally.expect(lines.flags == 0 && lines.count >= 3);
    const bool through =
        lines.whole() && lines.count == 3 && lines.first[1].found() &&
        magnitude(dot(normal_at(setup.scene, Ray<Real>(), lines.first[1]), Vec3<Real>(ray.normal))) > Real(0.5);
    if (through) tally.witness(true);
    return through;
}

/// The direction after a slab equals that before.
struct SlabParallel {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        SlabRay<Real> ray;
        if (!pass_slab(setup, intersector, i, ray, tally)) return;
        const Condition condition = condition_of(ray.to, ray.normal, 1, setup.numbers[0]);
        const Vec3<double> off = Vec3<double>(ray.lines.direction[2]) - ray.to;
        tally.measure(length(off) / (double(RealTraits<Real>::unit) * condition.value));
    }
};

/// A ray through a slab is displaced by h s (1 - c / g): thickness h, sine and cosine of incidence s and c,
/// g = sqrt(n^2 - s^2).
struct SlabDisplacement {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        SlabRay<Real> ray;
        if (!pass_slab(setup, intersector, i, ray, tally)) return;
        const double n = setup.numbers[0];
        const double c = -dot(ray.to, ray.normal);
        const double thickness = 2 * setup.numbers[1];
        const Vec3<double> tangent = ray.to + c * ray.normal;
        const double g = square_root((n - 1) * (n + 1) + c * c);
        const double expected = thickness * length(tangent) * (1 - c / g);
        const Vec3<double> way = Vec3<double>(ray.lines.origin[2]) - Vec3<double>(ray.lines.origin[0]);
        const Vec3<double> aside = cross(way, ray.to);
        tally.measure(magnitude(length(aside) - expected) / double(RealTraits<Real>::unit * setup.extent()));
    }
};

}  // namespace cistula::verify::refraction
