#include "scene/compile/radiance_bound.h"

#include <cmath>
#include <sstream>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

dvec3 largest_of(const dvec3& a, const dvec3& b) {
    return {max_or_second(a.x, b.x), max_or_second(a.y, b.y), max_or_second(a.z, b.z)};
}

double distance_to_box(const Box& box, const dvec3& p) {
    dvec3 d;
    for (int axis = 0; axis < 3; ++axis)
        d[axis] = max_or_second(max_or_second(box.low[axis] - p[axis], p[axis] - box.high[axis]), 0.0);
    return length(d);
}

/// Upper bound on the sum of the lights' contributions at any point of a box.
dvec3 falloff_light(const std::vector<const NormalizedLight*>& lights, const Box& box) {
    dvec3 sum{0};
    for (const NormalizedLight* light : lights) {
        // The box is that of the exact corners; rounded ones may be slightly nearer.
        const double distance = max_or_second(distance_to_box(box, light->position) - 0x1p-18, light->radius);
        sum += light->color / (distance * distance);
    }
    return sum;
}

}  // namespace

dvec3 radiance_bound(const SceneSource& source, const TextureSet& textures, const std::vector<NormalizedLight>& lights,
                     const std::vector<Box>& boxes) {
    const SceneDescription& scene = *source.description;
    dvec3 bound = scene.background, constant{0};
    std::vector<const NormalizedLight*> falling;
    for (const NormalizedLight& light : lights) {
        if (light.radius > 0) bound = largest_of(bound, light.radiance);
        if (light.falloff) {
            falling.push_back(&light);
        } else {
            constant += light.color;
        }
    }
    for (size_t i = 0; i < source.solids.size(); ++i) {
        const MaterialDescription& m = source.materials[source.solids[i].material];
        if (local_share(m) == 0 || boxes[i].empty()) continue;
        const dvec3 light = falling.empty() ? constant : constant + falloff_light(falling, boxes[i]);
        const dvec3 texel =
            m.texture < 0 ? dvec3{1}
                          : textures.largest[static_cast<size_t>(textures.number[static_cast<size_t>(m.texture)])];
        const dvec3 local =
            m.color * texel * (m.ambient * scene.ambient + m.diffuse * light) + m.specular * m.specular_color * light;
        bound = largest_of(bound, local);
    }
    return bound;
}

RadianceScale radiance_scale(const SceneDescription& scene, const dvec3& bound, bool single_precision) {
    RadianceScale scale;
    dvec3 used = bound;
    const bool pinned = scene.frame && scene.frame->bound;
    const auto text = [](double value) {
        std::ostringstream stream;
        stream << value;
        return stream.str();
    };
    if (pinned) {
        used = dvec3{*scene.frame->bound};
        if (!(used.x >= largest_component(bound)) || !is_finite(used.x))
            throw scene_error(scene, "/frame/bound",
                              "is " + text(used.x) + ", but the scene's radiance can reach " +
                                  text(largest_component(bound)) + "; give that or more");
    }
    used *= bound_slack;
    const double largest = largest_component(used);
    const double limit = single_precision ? 0x1p100 : 0x1p127;  // images hold floats in either precision
    if (!(largest <= limit) || !is_finite(used))
        throw scene_error(
            scene, "",
            "the radiance bound is " + text(largest) + ", above 2^" +
                (single_precision ? "100, what single precision can take; use --precision double or dimmer lights"
                                  : "127, what an image can hold; use dimmer lights"));
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
