// What is seen of sites in closed form: along straight lines, and through a cube of glass on a floor. Bodies are ideal.
#pragma once

#include <optional>

#include "verify/cases/contact/site.h"

namespace cistula::verify::contact {

/// Within this distance of an edge nothing is said: more than 2^5 times the 32 u M by which float moves a start, in a
/// site of size 8.
inline constexpr double margin = 1e-3;

/// Opaque cubes and parallelograms, cubes of index 1 that tint the light at each face, ambient light, and diffuse light
/// that they shadow. Lines that come within a margin of an edge have no answer.
class StraightLight {
  public:
    explicit StraightLight(const Site& site) : site_(site) {}

    /// The light that comes to `from` against `direction`, in the site's coordinates.
    std::optional<dvec3> seen(const dvec3& from, const dvec3& direction) const {
        Meeting first;
        if (!nearest(from, direction, first)) return {};
        dvec3 filter(1);
        if (!pass(from, direction, first.t, no_cube, filter)) return {};
        if (first.t == far_away) return filter * site_.scene.background;
        const MaterialDescription& material = site_.scene.materials[size_t(first.material)];
        const dvec3 normal = dot(first.normal, direction) > 0 ? -first.normal : first.normal;
        const dvec3 point = from + direction * first.t;
        dvec3 light = site_.scene.ambient * material.color;
        for (size_t i = 0; i < site_.lights.size(); ++i) {
            const dvec3 way = site_.lights[i] - point;
            const double distance = length(way);
            const double cosine = dot(normal, way) / distance;
            if (magnitude(cosine) < margin) return {};
            if (cosine < 0) continue;
            dvec3 arrives(1);
            if (!shadows(point, way / distance, distance, first.cube, arrives)) return {};
            light += site_.scene.lights[i].color * material.color * arrives * cosine;
        }
        return filter * light;
    }

  private:
    static constexpr double far_away = 1e9;
    static constexpr size_t no_cube = ~size_t(0);

    struct Chord {
        double enter = -far_away, leave = far_away;
        dvec3 normal{0};            // of the face by which the line enters
        double second = -far_away;  // the next to last plane that it enters by
    };
    struct Meeting {
        double t = far_away;
        dvec3 normal{0};
        int material = 0;
        size_t cube = no_cube;
    };

    bool is_clear(int material) const { return site_.scene.materials[size_t(material)].transmission > 0; }

    /// A line within a cube that is grown by a length.
    static Chord chord(const SiteCube& cube, const dvec3& from, const dvec3& direction, double grown) {
        const double s = std::sin(cube.turn);
        const double c = std::cos(cube.turn);
        Chord found;
        for (const dvec3& axis : {dvec3(c, s, 0), dvec3(-s, c, 0), dvec3(0, 0, 1)})
            for (const double sign : {-1.0, 1.0}) {
                const dvec3 normal = axis * sign;
                const double slope = dot(normal, direction);
                const double rest = cube.half + grown - dot(normal, from - cube.middle);
                if (slope == 0 && rest < 0) found.enter = far_away;
                if (slope < 0 && rest / slope > found.enter) {
                    found.second = found.enter;
                    found.enter = rest / slope;
                    found.normal = normal;
                } else if (slope < 0) {
                    found.second = max_or_second(rest / slope, found.second);
                }
                if (slope > 0) found.leave = min_or_second(rest / slope, found.leave);
            }
        return found;
    }
    /// Whether a line crosses a cube between 0 and `end`; nothing if it is too close to an edge to say.
    static std::optional<bool> crosses(const SiteCube& cube, const dvec3& from, const dvec3& direction, double end) {
        const auto inside = [&](double grown) {
            const Chord c = chord(cube, from, direction, grown);
            return min_or_second(c.leave, end) - max_or_second(c.enter, 0.0);
        };
        if (inside(margin) <= 0) return false;
        if (inside(-margin) > 0) return true;
        return {};
    }

    /// How far inside a sheet's border a point of its plane lies.
    static double inside_border(const SiteSheet& sheet, const dvec3& p) {
        const double a = length(sheet.along);
        const double b = length(sheet.across);
        const double u = dot(p - sheet.corner, sheet.along) / a;
        const double v = dot(p - sheet.corner, sheet.across) / b;
        return min_or_second(min_or_second(u, a - u), min_or_second(v, b - v));
    }

    /// The nearest opaque thing; false if it is too close to an edge to say.
    bool nearest(const dvec3& from, const dvec3& direction, Meeting& first) const {
        std::vector<Meeting> all;
        for (size_t i = 0; i < site_.cubes.size(); ++i) {
            if (is_clear(site_.cubes[i].material)) continue;
            const std::optional<bool> met = crosses(site_.cubes[i], from, direction, far_away);
            if (!met) return false;
            const Chord c = chord(site_.cubes[i], from, direction, 0);
            if (*met && c.enter - c.second < margin) return false;
            if (*met) all.push_back({c.enter, c.normal, site_.cubes[i].material, i});
        }
        for (const SiteSheet& sheet : site_.sheets) {  // later ones after earlier ones, all after the solids
            const dvec3 normal = normalized(cross(sheet.along, sheet.across));
            const double t = dot(normal, sheet.corner - from) / dot(normal, direction);
            if (!(t > 0)) continue;
            const double within = inside_border(sheet, from + direction * t);
            if (magnitude(within) < margin) return false;
            if (within > 0) all.push_back({t, normal, sheet.material, no_cube});
        }
        for (const Meeting& one : all)
            if (one.t < first.t + 1e-9) first = one;
        for (const Meeting& one : all)
            if (one.t > first.t + 1e-9 && one.t < first.t + margin) return false;
        return true;
    }

    /// Multiplies a filter by the tints of the faces that are crossed between 0 and `end`, where both may lie on faces.
    bool pass(const dvec3& from, const dvec3& direction, double end, size_t but, dvec3& filter) const {
        for (size_t i = 0; i < site_.cubes.size(); ++i) {
            const SiteCube& cube = site_.cubes[i];
            if (i == but || !is_clear(cube.material)) continue;
            const std::optional<bool> crossed = crosses(cube, from, direction, end);
            if (!crossed) return false;
            if (!*crossed) continue;
            const Chord c = chord(cube, from, direction, 0);
            const dvec3& tint = site_.scene.materials[size_t(cube.material)].tint;
            if (c.enter > margin) filter *= tint;
            if (c.leave < end - margin) filter *= tint;
        }
        return true;
    }

    /// What arrives of a light at a point of a cube or a sheet.
    bool shadows(const dvec3& point, const dvec3& direction, double distance, size_t own, dvec3& arrives) const {
        for (size_t i = 0; i < site_.cubes.size(); ++i) {
            if (i == own || is_clear(site_.cubes[i].material)) continue;
            const std::optional<bool> crossed = crosses(site_.cubes[i], point, direction, distance);
            if (!crossed) return false;
            if (*crossed) arrives = dvec3(0);
        }
        for (const SiteSheet& sheet : site_.sheets) {
            const dvec3 normal = normalized(cross(sheet.along, sheet.across));
            const double off = dot(normal, point - sheet.corner);
            const double t = -off / dot(normal, direction);
            if (magnitude(off) < 1e-9 || !(t > 0 && t < distance)) continue;
            const double within = inside_border(sheet, point + direction * t);
            if (magnitude(within) < margin) return false;
            if (within > 0) arrives = dvec3(0);
        }
        return pass(point, direction, distance, own, arrives);
    }

    const Site& site_;
};

/// A cube of glass on a floor in ambient light, along ideal rays in the site's coordinates: z = 0 is the floor, and
/// light passes from it straight into the glass.
class IdealGlass {
  public:
    static constexpr double index = 1.5;
    static constexpr double half = 0.5;
    static constexpr double floor_half = 2;
    static constexpr double least_weight = 1e-5;
    dvec3 floor, background;

    dvec3 seen(const dvec3& from, const dvec3& direction) const { return outside(from, direction, 1); }

  private:
    /// The share of unpolarized light that is reflected (Born, Wolf, section 1.5), and the cosine behind the face.
    static double fresnel(double cosine, double ratio, double& behind) {
        const double square = 1 - (1 - cosine * cosine) / (ratio * ratio);
        if (square <= 0) return 1;
        behind = std::sqrt(square);
        const double s = (cosine - ratio * behind) / (cosine + ratio * behind);
        const double p = (ratio * cosine - behind) / (ratio * cosine + behind);
        return (s * s + p * p) / 2;
    }
    /// The planes of the cube: axis and side of number i.
    static dvec3 normal(int i) {
        dvec3 n(0);
        n[i / 2] = i % 2 == 0 ? -1 : 1;
        return n;
    }
    static double distance(int i, const dvec3& p) { return half - dot(normal(i), p - dvec3(0, 0, half)); }

    dvec3 outside(const dvec3& from, const dvec3& direction, double weight) const {
        if (weight < least_weight) return dvec3(0);
        double enter = 0, leave = 1e9;
        int face = -1;
        for (int i = 0; i < 6; ++i) {
            const double slope = dot(normal(i), direction);
            const double t = distance(i, from) / slope;
            if (slope < 0 && t > enter) enter = t, face = i;
            if (slope > 0) leave = min_or_second(t, leave);
        }
        if (face >= 0 && enter < leave)
            return at_face(from + direction * enter, direction, normal(face), false, weight);
        if (direction.z >= 0) return background;
        const dvec3 point = from - direction * (from.z / direction.z);
        return max_or_second(magnitude(point.x), magnitude(point.y)) < floor_half ? floor : background;
    }
    dvec3 inside(const dvec3& from, const dvec3& direction, double weight) const {
        if (weight < least_weight) return dvec3(0);
        double leave = 1e9;
        int face = -1;
        for (int i = 0; i < 6; ++i) {
            const double slope = dot(normal(i), direction);
            if (slope > 0 && distance(i, from) / slope < leave) leave = distance(i, from) / slope, face = i;
        }
        if (face == 4) return floor;
        return at_face(from + direction * leave, direction, -normal(face), true, weight);
    }
    /// `normal`: toward the ray.
    dvec3 at_face(const dvec3& point, const dvec3& direction, const dvec3& normal, bool leaves, double weight) const {
        const double cosine = -dot(direction, normal);
        const double ratio = leaves ? 1 / index : index;
        double behind = 0;
        const double share = fresnel(cosine, ratio, behind);
        const dvec3 mirrored = direction + normal * (2 * cosine);
        dvec3 light = leaves ? inside(point, mirrored, weight * share) : outside(point, mirrored, weight * share);
        light *= share;
        if (share == 1) return light;
        const dvec3 through = (direction + normal * cosine) / ratio - normal * behind;
        const double rest = weight * (1 - share);
        return light + (1 - share) * (leaves ? outside(point, through, rest) : inside(point, through, rest));
    }
};

}  // namespace cistula::verify::contact
