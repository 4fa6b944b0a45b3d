#include "scene/compile/lights/radiance_bound.h"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

dvec3 largest_of(const dvec3& a, const dvec3& b) {
    return {max_or_second(a.x, b.x), max_or_second(a.y, b.y), max_or_second(a.z, b.z)};
}

std::string digits_text(double value, int digits = 6) {
    std::ostringstream stream;
    stream << std::setprecision(digits) << value;
    return stream.str();
}

/// Bounds on the light that arrives at any point of a solid, and the light with falloff that may be the strongest.
struct Incoming {
    dvec3 most{0};   // upper bound
    dvec3 least{0};  // what arrives if it is as far from the lights as its box allows
    size_t strongest = 0;
    double nearest = 0;  // distance of the strongest light
};

void add_falloff_lights(const std::vector<NormalizedLight>& lights, const Box& box,
                        const std::vector<LightDistance>& distances, double bulge, Incoming& to) {
    double strongest = -1;
    auto known = distances.begin();
    for (size_t i = 0; i < lights.size(); ++i) {
        const NormalizedLight& light = lights[i];
        if (!light.falloff) continue;
        // The box is that of the exact corners; rounded ones may be slightly nearer.
        double nearest = max_or_second(distance_to_box(box, light.position) - bulge - 0x1p-18, light.radius);
        if (known != distances.end() && known->light == i)
            nearest = max_or_second((known++)->distance - bulge, nearest);
        double farthest = nearest;
        for (const dvec3& corner : box.corners()) farthest = max_or_second(length(corner - light.position), farthest);
        const dvec3 most = light.color / (nearest * nearest);
        to.most += most;
        to.least += light.color / (farthest * farthest);
        if (!(largest_component(most) > strongest)) continue;
        strongest = largest_component(most);
        to.strongest = i;
        to.nearest = nearest;
    }
}

/// The local light of a material that receives `light`.
dvec3 local_of(const MaterialDescription& m, const dvec3& ambient, const dvec3& texel, const dvec3& light) {
    return m.color * texel * (m.ambient * ambient + m.diffuse * light) + m.specular * m.specular_color * light;
}

const char* its(const NormalizedLight& light, const char* own, const char* of_edges) {
    return light.convex < 0 ? own : of_edges;
}

Error too_near(const SceneSource& source, const NormalizedLight& light, const Incoming& incoming, size_t solid,
               double brightest, double limit, double unit_length) {
    const double radius = incoming.nearest * square_root(brightest / limit) * unit_length;
    return scene_error(*source.description, light.place,
                       its(light, "its", "the edge lights'") + std::string(" radius of ") +
                           digits_text(light.radius * unit_length) + " lets " + source.solids[solid].place +
                           " be lit as brightly as " + digits_text(brightest) +
                           ", and sums that hold this are too coarse for the rest, which is no brighter than " +
                           digits_text(limit / largest_contrast),
                       "give a radius of " + digits_text(1.05 * radius, 2) + " or more, or move it off the surface");
}

/// Brings a visible light's radiance down to the limit if it is its color, and refuses it if it was given.
void limit_glow(const SceneSource& source, NormalizedLight& light, double limit, std::vector<std::string>& warnings) {
    const double glow = largest_component(light.radiance);
    if (!light.shown || !(glow > limit)) return;
    const std::string remedy = ", or 'visible': false";
    if (light.glow_given)
        throw scene_error(*source.description, light.place,
                          its(light, "its", "the edge lights'") + std::string(" glow of ") + digits_text(glow) +
                              " is so much brighter than all that lights shine on, " +
                              digits_text(limit / largest_contrast) +
                              " at most, that sums that hold both are too coarse",
                          "give a glow of " + digits_text(0.95 * limit, 2) + " or less" + remedy);
    light.radiance *= limit / glow;
    const std::string warning = light.place + ": " + its(light, "it is", "its edge lights are") +
                                " shown with a glow of " + digits_text(largest_component(light.radiance), 2) +
                                " instead of the color's " + digits_text(glow) +
                                ", beside which sums would be too coarse for all else; give a glow" + remedy;
    if (warnings.empty() || warnings.back() != warning) warnings.push_back(warning);
}

/// The brightest that a ray may see that meets nothing.
dvec3 brightest_around(const SceneDescription& scene, const TextureSet& textures) {
    if (!scene.sky) return scene.background;
    if (scene.sky->texture >= 0)
        return scene.sky->scale *
               textures.largest[static_cast<size_t>(textures.number[static_cast<size_t>(scene.sky->texture)])];
    dvec3 brightest{0};
    for (const SkyColor& stop : scene.sky->stops) brightest = largest_of(brightest, stop.color);
    return brightest;
}

}  // namespace

dvec3 radiance_bound(const SceneSource& source, const TextureSet& textures, const SolidPlaces& solids,
                     double unit_length, std::vector<NormalizedLight>& lights, std::vector<std::string>& warnings) {
    const SceneDescription& scene = *source.description;
    dvec3 bound = brightest_around(scene, textures), lit = bound, constant{0};
    for (const NormalizedLight& light : lights)
        if (!light.falloff) constant += light.color;
    size_t brightest = 0;
    Incoming at_brightest;
    for (size_t i = 0; i < source.solids.size(); ++i) {
        const MaterialDescription& m = source.materials[source.solids[i].material];
        if (local_share(m) == 0 || solids.boxes[i].empty()) continue;
        Incoming incoming;
        add_falloff_lights(lights, solids.boxes[i], solids.distances[i], solids.bulges[i], incoming);
        const dvec3 texel =
            m.texture < 0 ? dvec3{1}
                          : textures.largest[static_cast<size_t>(textures.number[static_cast<size_t>(m.texture)])];
        const dvec3 local = local_of(m, scene.ambient, texel, constant + incoming.most);
        lit = largest_of(lit, local_of(m, scene.ambient, texel, constant + incoming.least));
        if (largest_component(local) > largest_component(bound)) {
            brightest = i;
            at_brightest = incoming;
        }
        bound = largest_of(bound, local);
    }
    const double limit = largest_component(lit) * largest_contrast;
    const double most = largest_component(bound);
    if (most > limit)
        throw too_near(source, lights[at_brightest.strongest], at_brightest, brightest, most, limit, unit_length);
    for (NormalizedLight& light : lights) {
        if (limit > 0) limit_glow(source, light, limit, warnings);
        if (light.shown) bound = largest_of(bound, light.radiance);
    }
    return bound;
}

RadianceScale radiance_scale(const SceneDescription& scene, const dvec3& bound, bool single_precision) {
    RadianceScale scale;
    dvec3 used = bound;
    const bool pinned = scene.frame && scene.frame->bound;
    if (pinned) {
        used = dvec3{*scene.frame->bound};
        if (!(used.x >= largest_component(bound)) || !is_finite(used.x))
            throw scene_error(scene, "/frame/bound",
                              "is " + digits_text(used.x) + ", but the scene's radiance can reach " +
                                  digits_text(largest_component(bound)),
                              "give that or more");
    }
    used *= bound_slack;
    const double largest = largest_component(used);
    const double limit = single_precision ? 0x1p100 : 0x1p127;  // images hold floats in either precision
    if (!(largest <= limit) || !is_finite(used))
        throw scene_error(
            scene, "",
            "the radiance bound is " + digits_text(largest) + ", above 2^" +
                (single_precision ? "100, what single precision can take" : "127, what an image can hold"),
            single_precision ? "use `precision` double or dimmer lights" : "use dimmer lights");
    if (largest > 0) {
        int exponent;
        const double mantissa = std::frexp(largest, &exponent);  // in [1/2, 1)
        scale.exponent = mantissa == 0.5 ? exponent - 1 : exponent;
        scale.exponent = scale.exponent < -900 ? -900 : scale.exponent;
    }
    for (int c = 0; c < 3; ++c) scale.bound[c] = std::ldexp(used[c], -scale.exponent);
    return scale;
}

}  // namespace cistula
