// A cube of glass on a floor in ambient light, in closed form: light passes from the floor straight into the glass.
#pragma once

#include "apps/render_verify/contact/compare.h"
#include "scene/description/camera_path.h"

namespace cistula::verify::contact {

/// The light of the scene of OpticalContact, along ideal rays in the site's coordinates: z = 0 is the floor.
class IdealGlass {
  public:
    static constexpr double index = 1.5, half = 0.5, floor_half = 2, least_weight = 1e-5;
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
            const double slope = dot(normal(i), direction), t = distance(i, from) / slope;
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
        const double cosine = -dot(direction, normal), ratio = leaves ? 1 / index : index;
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

struct OpticalContact {
    static constexpr const char* name = "contact/optical";
    static constexpr const char* exact = "Fresnel products of a glass cube on a floor, in every pixel";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Ground& ground : grounds)
            for (const dvec3& from : {dvec3(1.4, -3.6, 2.1), dvec3(0.3, 0.2, 5), dvec3(-3, -1, 0.4)}) {
                Site site(ground);
                site.floor(add_material(site.scene, paper({0.8, 0.6, 0.3})), IdealGlass::floor_half);
                site.cube(0, 0, 0, 2 * IdealGlass::half, 0, add_material(site.scene, glass(IdealGlass::index)));
                site.scene.depth = 64;
                site.scene.cutoff = 1e-4;
                site.look(from, {0, 0, 0.5}, 40);
                expect_ideal(tally, site, film_of(stage, site.scene), place_of_scene(number++));
            }
    }

  private:
    static void expect_ideal(Tally& tally, const Site& site, const Film& film, uint64_t place) {
        const IdealGlass ideal{site.scene.ambient * site.scene.materials[1].color, site.scene.background};
        const ColorPicture found = to_color(film);
        ColorPicture expected = found;
        const int width = int(found.width), height = int(found.height);
        const Camera camera = camera_at(site.scene.camera, 0).camera;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const dvec3 direction = camera_direction(camera, x + 0.5, y + 0.5, width, height);
                expected.texels[size_t(y * width + x)] =
                    glm::vec3(ideal.seen(site.own(camera.position), site.own_direction(direction)));
            }
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const size_t i = size_t(y * width + x);
                tally.place = place + i;
                tally.expect(film.flags == 0 && is_between(found.texels[i], expected, x, y));
            }
    }
};

}  // namespace cistula::verify::contact
