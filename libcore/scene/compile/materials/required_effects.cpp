#include "scene/compile/materials/required_effects.h"

#include <bit>
#include <sstream>
#include <utility>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/materials/compile_materials.h"

namespace cistula {
namespace {

using glm::dvec3;
using Text = std::string;

bool any(const dvec3& v) {
    return v.x > 0 || v.y > 0 || v.z > 0;
}

std::string number(double value) {
    std::ostringstream stream;
    stream << value;
    return stream.str();
}

struct SceneLight {
    std::string name;
    bool several, lights, visible, falloff;
};

std::vector<SceneLight> all_lights(const SceneDescription& scene) {
    std::vector<SceneLight> lights;
    for (const LightDescription& light : scene.lights)
        lights.push_back({"the light " + light.place, false, any(light.color), light.shown(), light.falloff});
    for (const ObjectDescription& object : scene.objects) {
        const auto* solid = std::get_if<SolidObject>(&object.shape);
        if (!solid || solid->edge_lights.count == 0) continue;
        const EdgeLights& e = solid->edge_lights;
        lights.push_back({"the lights on the edges of " + object.place, true, any(e.color), e.shown(), e.falloff});
    }
    return lights;
}

/// A condition on the whole scene that must hold before a material or a light can require an effect.
enum class Premise { none, point_light, shown_light, passing_rays };

/// Facts about the whole scene.
struct Facts {
    bool ambient = false;       // there is ambient light
    bool point_light = false;   // a light has an intensity
    bool shown_light = false;   // a surface shows light of a point light
    bool passing_rays = false;  // a material transmits rays

    /// The reason why a premise does not hold; null if it holds.
    const char* against(Premise premise) const {
        if (premise == Premise::none) return nullptr;
        if (premise == Premise::passing_rays) return passing_rays ? nullptr : "no material lets rays pass";
        if (!point_light) return "no light has an intensity above 0";
        return premise == Premise::point_light || shown_light ? nullptr : "no surface shows light of any lamp";
    }
};

/// A material on an object, with the facts about its scene.
struct Use {
    const Facts& facts;
    const MaterialDescription& material;
    bool closed, smooth;
    uint32_t primitive;
};

/// Whether some light may pass a material's faces: perhaps too little for numbers of float, but no less.
bool passes(const MaterialDescription& m) {
    return any((m.transmission + (m.fresnel ? m.reflection : 0)) * m.tint);
}

bool shows_texture(const Use& use) {
    const MaterialDescription& m = use.material;
    const bool lit = (use.facts.point_light && m.diffuse > 0) || (use.facts.ambient && m.ambient > 0);
    return m.texture >= 0 && local_share(m) > 0 && any(m.color) && lit;
}

bool shows_diffuse(const Use& use) {
    return local_share(use.material) > 0 && use.material.diffuse > 0 && any(use.material.color);
}

bool shows_specular(const Use& use) {
    return local_share(use.material) > 0 && use.material.specular > 0 && any(use.material.specular_color);
}

bool keeps_a_color(const Use& use) {
    const MaterialDescription& m = use.material;
    for (int c = 0; c < 3; ++c)
        if (!(m.transmission * m.tint[c] > 0)) return true;
    return false;
}

bool bends(const Use& use) {
    return use.facts.passing_rays && use.closed && passes(use.material) && use.material.index != 1;
}

bool reflects(const Use& use) {
    return use.material.reflection > 0 || (use.material.fresnel && use.material.transmission > 0) || bends(use);
}

bool is_tinted(const Use& use) {
    const dvec3& tint = use.material.tint;
    return passes(use.material) && !(tint.x == tint.y && tint.y == tint.z);
}

Text because_of_reflection(const Use& use) {
    if (use.material.reflection > 0) return "has kr " + number(use.material.reflection);
    if (use.material.fresnel && use.material.transmission > 0) return "splits its light by Fresnel's terms";
    return "has index " + number(use.material.index) + ": total reflection";
}

Text because_of_transmission(const Use& use) {
    const double transmission = use.material.transmission;
    return transmission > 0 ? "has kt " + number(transmission) : "splits its light by Fresnel's terms";
}

/// An effect required by materials. `because` continues the sentence after the name of the first such material.
struct MaterialRow {
    uint32_t effect;
    Premise premise;
    bool (*needed)(const Use&);
    Text (*because)(const Use&);
    const char* otherwise;
};

const MaterialRow material_rows[] = {
    {effect_texture, Premise::none, shows_texture, [](const Use&) -> Text { return "has a texture"; },
     "no material has a texture"},
    {effect_diffuse, Premise::point_light, shows_diffuse,
     [](const Use& u) { return "has kd " + number(u.material.diffuse); }, "no material has kd above 0"},
    {effect_specular, Premise::point_light, shows_specular,
     [](const Use& u) { return "has ks " + number(u.material.specular); }, "no material has ks above 0"},
    {effect_opaque_shadows, Premise::shown_light, keeps_a_color,
     [](const Use& u) -> Text { return u.material.transmission > 0 ? "lets a color not pass" : "has kt 0"; },
     "every material lets every color pass"},
    {effect_transparent_shadows, Premise::shown_light,
     [](const Use& u) { return any(u.material.transmission * u.material.tint); },
     [](const Use& u) { return "has kt " + number(u.material.transmission); }, "no material has kt above 0"},
    {effect_reflection, Premise::none, reflects, because_of_reflection,
     "no material has kr above 0, none reflects totally"},
    {effect_transmission, Premise::none, [](const Use& u) { return passes(u.material); }, because_of_transmission,
     "no material has kt above 0"},
    {effect_refraction, Premise::passing_rays, bends,
     [](const Use& u) { return "has index " + number(u.material.index); }, "no solid has an index other than 1"},
    {effect_fresnel, Premise::none,
     [](const Use& u) { return u.material.fresnel && u.material.reflection + u.material.transmission > 0; },
     [](const Use&) -> Text { return "has fresnel on"; }, "no material that reflects or transmits has fresnel on"},
    {effect_absorption, Premise::none,
     [](const Use& u) { return u.closed && passes(u.material) && any(u.material.absorption); },
     [](const Use&) -> Text { return "absorbs light"; }, "no solid absorbs"},
    {effect_tint, Premise::passing_rays, is_tinted, [](const Use&) -> Text { return "has a tint"; },
     "what passes keeps its color"},
    {effect_solids, Premise::none, [](const Use& u) { return u.primitive == effect_solids; },
     [](const Use&) -> Text { return "is on a convex solid"; }, "there is no convex solid"},
    {effect_spheres, Premise::none, [](const Use& u) { return u.primitive == effect_spheres; },
     [](const Use&) -> Text { return "is on a sphere"; }, "there is no solid sphere"},
    {effect_smooth, Premise::none, [](const Use& u) { return u.smooth; },
     [](const Use&) -> Text { return "is on a smooth mesh"; }, "no mesh has normals that differ from its faces'"},
    {effect_triangles, Premise::none, [](const Use& u) { return u.primitive == effect_triangles; },
     [](const Use&) -> Text { return "is on triangles"; }, "there is neither mesh nor sheet"},
    {effect_planes, Premise::none, [](const Use& u) { return u.primitive == effect_planes; },
     [](const Use&) -> Text { return "is on a plane or a disk"; }, "there is neither plane nor disk"},
    {effect_insides, Premise::none, [](const Use& u) { return u.closed && passes(u.material); },
     [](const Use&) -> Text { return "lets rays into a closed body"; },
     "no closed body lets rays pass; a camera in one adds it"},
};

/// An effect required by lights. `one` or `several` continues the sentence after the name of the first such light.
struct LightRow {
    uint32_t effect;
    Premise premise;
    bool (*needed)(const SceneLight&);
    const char *one, *several;
    const char* otherwise;
};

const LightRow light_rows[] = {
    {effect_visible_lights, Premise::none, [](const SceneLight& light) { return light.visible; }, "is seen", "are seen",
     "no light has a radius above 0"},
    {effect_light_falloff, Premise::shown_light, [](const SceneLight& light) { return light.lights && light.falloff; },
     "falls off with distance", "fall off with distance", "no light falls off with distance"},
};

/// A sentence with the first material that requires the effect; empty if none does.
Text cause(const MaterialRow& row, const std::vector<MaterialUse>& uses, const Facts& facts) {
    for (const MaterialUse& one : uses) {
        const Use use{facts, *one.material, one.closed, one.smooth, one.primitive};
        if (row.needed(use)) return "material " + use.material.name + " of " + one.place + " " + row.because(use);
    }
    return "";
}

/// A sentence with the first light that requires the effect; empty if none does.
Text cause(const LightRow& row, const std::vector<SceneLight>& lights) {
    for (const SceneLight& light : lights)
        if (row.needed(light)) return light.name + " " + (light.several ? row.several : row.one);
    return "";
}

Facts find_facts(const SceneDescription& scene, const std::vector<MaterialUse>& uses,
                 const std::vector<SceneLight>& lights) {
    Facts facts;
    facts.ambient = any(scene.ambient);
    for (const SceneLight& light : lights) facts.point_light = facts.point_light || light.lights;
    for (const MaterialUse& one : uses) {
        const Use use{facts, *one.material, one.closed, one.smooth, one.primitive};
        if (facts.point_light && (shows_diffuse(use) || shows_specular(use))) facts.shown_light = true;
        if (passes(use.material)) facts.passing_rays = true;
    }
    return facts;
}

}  // namespace

std::vector<EffectReason> explain_effects(const SceneDescription& scene, const std::vector<MaterialUse>& uses,
                                          const std::string& light_on_face, const std::string& contact) {
    const std::vector<SceneLight> lights = all_lights(scene);
    const Facts facts = find_facts(scene, uses, lights);
    std::vector<EffectReason> reasons(effect_count);
    const auto put = [&](uint32_t effect, Premise premise, const Text& cause, const char* otherwise) {
        const char* const against = facts.against(premise);
        const bool needed = !against && !cause.empty();
        reasons[static_cast<size_t>(std::countr_zero(effect))] = {effect, needed,
                                                                  needed    ? cause
                                                                  : against ? against
                                                                            : otherwise};
    };
    for (const MaterialRow& row : material_rows) put(row.effect, row.premise, cause(row, uses, facts), row.otherwise);
    for (const LightRow& row : light_rows) put(row.effect, row.premise, cause(row, lights), row.otherwise);
    put(effect_lights_on_faces, Premise::shown_light, light_on_face, "no light with a color lies on a face or edge");
    put(effect_contacts, Premise::none, contact, "no faces of two objects lie in one plane");
    put(effect_sky, Premise::none,
        !scene.sky               ? ""
        : scene.sky->texture < 0 ? "the background is a gradient"
                                 : "the background is a picture",
        "the background has one color");
    return reasons;
}

std::vector<EffectReason> explain_effects(SceneSource source, Precision precision) {
    return precision == Precision::double_ ? compile_scene<double>(std::move(source))->effect_reasons
                                           : compile_scene<float>(std::move(source))->effect_reasons;
}

std::vector<EffectReason> explain_effects(const SceneDescription& scene, Precision precision) {
    return explain_effects(gather_scene(scene), precision);
}

std::vector<std::string> names_of_effects(uint32_t mask) {
    std::vector<std::string> names;
    for (int i = 0; i < effect_count; ++i)
        if (mask >> i & 1) names.emplace_back(effect_names[i]);
    return names;
}

uint32_t required_effects(const std::vector<EffectReason>& reasons) {
    uint32_t effects = 0;
    for (const EffectReason& reason : reasons)
        if (reason.needed) effects |= reason.effect;
    return effects;
}

uint32_t required_effects(const SceneDescription& scene) {
    return required_effects(explain_effects(scene));
}

}  // namespace cistula
