#include "scene/required_effects.h"

#include <sstream>

#include "scene/compile_lights.h"
#include "scene/compile_materials.h"
#include "scene/mesh_topology.h"

namespace cistula {
namespace {

using glm::dvec3;

bool any(const dvec3& v) {
    return v.x > 0 || v.y > 0 || v.z > 0;
}

std::string number(double value) {
    std::ostringstream stream;
    stream << value;
    return stream.str();
}

std::string named(const MaterialUse& use) {
    return "material " + use.material->name + " of " + use.place;
}

bool passes(const MaterialDescription& m) {
    return m.transmission > 0 || (m.fresnel && m.reflection > 0);
}

struct SceneLight {
    std::string name;
    bool several, lights, seen, falloff;
};

std::vector<SceneLight> all_lights(const SceneDescription& scene) {
    std::vector<SceneLight> lights;
    for (const LightDescription& light : scene.lights)
        lights.push_back({"the light " + light.place, false, any(light.color), light.radius > 0, light.falloff});
    for (const ObjectDescription& object : scene.objects) {
        const auto* solid = std::get_if<SolidObject>(&object.shape);
        if (!solid || solid->edge_lights.count == 0) continue;
        const EdgeLights& e = solid->edge_lights;
        lights.push_back({"the lights on the edges of " + object.place, true, any(e.color), e.radius > 0, e.falloff});
    }
    return lights;
}

class Explainer {
  public:
    Explainer(const SceneDescription& scene, const std::vector<MaterialUse>& uses, const std::string& lamp_on_face)
        : scene_(scene), uses_(uses), lights_(all_lights(scene)), lamp_on_face_(lamp_on_face) {}

    std::vector<EffectReason> explain() {
        for (const SceneLight& light : lights_)
            if (light.lights) lit_ = true;
        for (const MaterialUse& use : uses_)
            if (passes(*use.material)) passing_ = true;
        if (!lit_) no_light_ = "no light has an intensity above 0";
        by_material(effect_texture, "no material has a texture", [&](const MaterialUse& u) {
            const MaterialDescription& m = *u.material;
            const bool shows = any(m.color) && ((lit_ && m.diffuse > 0) || (m.ambient > 0 && any(scene_.ambient)));
            return m.texture >= 0 && local_share(m) > 0 && shows ? "has a texture" : std::string();
        });
        const bool diffuse = by_lit_material(effect_diffuse, "no material has kd above 0", [](const MaterialUse& u) {
            const MaterialDescription& m = *u.material;
            return local_share(m) > 0 && m.diffuse > 0 && any(m.color) ? "has kd " + number(m.diffuse) : std::string();
        });
        const bool specular = by_lit_material(effect_specular, "no material has ks above 0", [](const MaterialUse& u) {
            const MaterialDescription& m = *u.material;
            const bool shines = local_share(m) > 0 && m.specular > 0 && any(m.specular_color);
            return shines ? "has ks " + number(m.specular) : std::string();
        });
        lit_ = diffuse || specular;
        shadows(lit_);

        by_material(effect_reflection, "no material has kr above 0, none reflects totally", [&](const MaterialUse& u) {
            const MaterialDescription& m = *u.material;
            if (m.reflection > 0) return "has kr " + number(m.reflection);
            if (m.fresnel && passes(m)) return std::string("splits its light by Fresnel's terms");
            if (u.closed && m.index != 1 && passing_) return "has index " + number(m.index) + ": total reflection";
            return std::string();
        });
        by_material(effect_transmission, "no material has kt above 0", [](const MaterialUse& u) {
            const MaterialDescription& m = *u.material;
            if (m.transmission > 0) return "has kt " + number(m.transmission);
            return passes(m) ? std::string("splits its light by Fresnel's terms") : std::string();
        });
        by_material(effect_refraction, passing_ ? "no solid has an index other than 1" : "no material lets rays pass",
                    [&](const MaterialUse& u) {
                        const bool bends = passing_ && u.closed && u.material->index != 1;
                        return bends ? "has index " + number(u.material->index) : std::string();
                    });
        by_material(effect_fresnel, "no material that reflects or transmits has fresnel on", [](const MaterialUse& u) {
            const MaterialDescription& m = *u.material;
            return m.fresnel && m.reflection + m.transmission > 0 ? "has fresnel on" : std::string();
        });
        by_material(effect_absorption, "no solid absorbs", [](const MaterialUse& u) {
            return u.closed && any(u.material->absorption) ? std::string("absorbs light") : std::string();
        });
        by_light(effect_visible_lights, "no light has a radius above 0",
                 [](const SceneLight& l) { return !l.seen ? "" : (l.several ? " are seen" : " is seen"); });
        by_light(effect_light_falloff, lit_ ? "no light falls off with distance" : no_light_, [&](const SceneLight& l) {
            if (!l.lights || !l.falloff || !lit_) return "";
            return l.several ? " fall off with distance" : " falls off with distance";
        });
        by_material(effect_tint, passing_ ? "what passes keeps its color" : "no material lets rays pass",
                    [](const MaterialUse& u) {
                        const dvec3& tint = u.material->tint;
                        const bool gray = tint.x == tint.y && tint.y == tint.z;
                        return passes(*u.material) && !gray ? std::string("has a tint") : std::string();
                    });
        by_material(effect_solids, "there is no convex solid", [](const MaterialUse& u) {
            return u.convex ? std::string("is on a convex solid") : std::string();
        });
        by_material(effect_triangles, "there is neither mesh nor sheet",
                    [](const MaterialUse& u) { return u.convex ? std::string() : std::string("is on triangles"); });
        by_material(effect_insides, "no closed body lets rays pass; a camera in one adds it", [](const MaterialUse& u) {
            return u.closed && passes(*u.material) ? std::string("lets rays into a closed body") : std::string();
        });
        const bool on_face = lit_ && !lamp_on_face_.empty();
        reasons_.push_back({effect_lights_on_faces, on_face,
                            on_face ? lamp_on_face_
                            : lit_  ? "no lamp lies on a face"
                                    : no_light_});
        return std::move(reasons_);
    }

  private:
    template <class Test>
    bool by_material(uint32_t effect, const std::string& otherwise, const Test& test) {
        for (const MaterialUse& use : uses_) {
            const std::string because = test(use);
            if (because.empty()) continue;
            reasons_.push_back({effect, true, named(use) + " " + because});
            return true;
        }
        reasons_.push_back({effect, false, otherwise});
        return false;
    }

    template <class Test>
    bool by_lit_material(uint32_t effect, const std::string& otherwise, const Test& test) {
        if (lit_) return by_material(effect, otherwise, test);
        reasons_.push_back({effect, false, no_light_});
        return false;
    }

    template <class Test>
    void by_light(uint32_t effect, const std::string& otherwise, const Test& test) {
        for (const SceneLight& light : lights_) {
            const std::string because = test(light);
            if (because.empty()) continue;
            reasons_.push_back({effect, true, light.name + because});
            return;
        }
        reasons_.push_back({effect, false, otherwise});
    }

    void shadows(bool lit) {
        by_material(effect_opaque_shadows, lit ? "every material lets every color pass" : no_light_,
                    [&](const MaterialUse& u) {
                        const MaterialDescription& m = *u.material;
                        for (int c = 0; c < 3; ++c)
                            if (lit && !(m.transmission * m.tint[c] > 0))
                                return m.transmission > 0 ? std::string("lets a color not pass") : "has kt 0";
                        return std::string();
                    });
        by_material(effect_transparent_shadows, lit ? "no material has kt above 0" : no_light_,
                    [&](const MaterialUse& u) {
                        const MaterialDescription& m = *u.material;
                        const bool lets_pass = lit && any(m.transmission * m.tint);
                        return lets_pass ? "has kt " + number(m.transmission) : std::string();
                    });
    }

    const SceneDescription& scene_;
    const std::vector<MaterialUse>& uses_;
    std::vector<SceneLight> lights_;
    const std::string& lamp_on_face_;
    std::vector<EffectReason> reasons_;
    bool lit_ = false, passing_ = false;
    std::string no_light_ = "no surface shows light of any lamp";
};

}  // namespace

std::vector<EffectReason> explain_effects(const SceneDescription& scene, const std::vector<MaterialUse>& uses,
                                          const std::string& lamp_on_face) {
    return Explainer(scene, uses, lamp_on_face).explain();
}

std::vector<EffectReason> explain_effects(const SceneDescription& scene) {
    const SceneSource source = gather_scene(scene);
    const Frame frame = find_frame(source);
    std::vector<ConvexSolid> convex;
    for (uint32_t i = 0; i < source.solids.size(); ++i)
        if (source.solids[i].platonic) convex.push_back(convex_solid(*source.solids[i].platonic, i, frame));
    share_planes(convex, frame.extent);
    const std::vector<FramedLight> lights = frame_lights(source, frame, convex);
    IncidentLists incidents(lights.size());
    find_convex_incidents<float>(lights, convex, frame.extent, incidents);
    std::vector<MaterialUse> uses;
    for (uint32_t i = 0; i < source.solids.size(); ++i) {
        const SourceSolid& solid = source.solids[i];
        bool closed = true;
        if (!solid.platonic) {
            const MeshTopology topology = find_topology(solid.mesh);
            closed = topology.closed;
            if (lamp_on_face(source, lights, incidents).empty())  // one is enough, and meshes may be large
                find_triangle_incidents<float>(lights, FramedMesh(solid.mesh, topology, frame, true), i, frame.extent,
                                               incidents);
        }
        uses.push_back({&source.materials[solid.material], solid.place, closed, solid.platonic != nullptr});
    }
    return explain_effects(scene, uses, lamp_on_face(source, lights, incidents));
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
