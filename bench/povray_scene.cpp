#include "povray_scene.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "scene/compile/scene_normalization.h"
#include "scene/compile/scene_source.h"
#include "scene/description/platonic.h"

namespace cistula::bench {
namespace {

using glm::dvec3;

/// Shortest decimals that read back as the same doubles.
std::string vector(const dvec3& v) {
    return fmt::format("<{}, {}, {}>", v.x, v.y, v.z);
}
std::string color(const dvec3& v) {
    return "rgb " + vector(v);
}

bool is_gray(const dvec3& v) {
    return v.x == v.y && v.y == v.z;
}

/// Refuses what has no equal in POV-Ray's light model, or one with other edges.
void check(const SceneDescription& scene, const SceneSource& source) {
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::usage, scene.source + ": cannot be put in POV-Ray's terms: " + what);
    };
    for (const MaterialDescription& m : source.materials) {
        if (m.index == 1 ? m.fresnel : !m.fresnel || m.transmission < 1)
            refuse("material " + m.name + " refracts; its index must be 1, or it must be clear and have Fresnel");
        if (m.absorption != dvec3(0) && !m.fresnel) refuse("material " + m.name + " absorbs, but has no Fresnel");
        if (m.tint != dvec3(1)) refuse("material " + m.name + " tints what passes; its tint must be white");
        if (!is_gray(m.specular_color)) refuse("material " + m.name + " has a colored highlight; it must be gray");
        if (m.texture < 0) continue;
        const TextureDescription& texture = scene.textures[size_t(m.texture)];
        if (!texture.file.empty() || texture.wrap != std::array<TextureWrap, 2>{})
            refuse("material " + m.name +
                   " has a texture from a file, or one that does not repeat; it must be a checker");
    }
    if (!is_gray(scene.ambient)) refuse("the ambient color must be gray");
    for (const LightDescription& light : scene.lights)
        if (light.falloff || light.radius > 0) refuse("a light falls off or is seen; it must do neither");
    if (scene.sky && scene.sky->stops.empty()) refuse("the background is a picture; it must be a color or a gradient");
    for (const SourceSolid& solid : source.solids)
        if (solid.polyhedron && solid.polyhedron->edge_lights.count > 0) refuse("a solid has lights on its edges");
}

/// Two cells a unit of uv times repeat, placed by the first triangle's uvs (a planar object has one such map).
std::string checker(const TextureDescription& texture, const dvec3& base, const MeshSource& mesh) {
    const auto& t = mesh.triangles[0];
    const dvec3 p = mesh.vertices[t[0]];
    const dvec3 b = mesh.vertices[t[1]] - p;
    const dvec3 c = mesh.vertices[t[2]] - p;
    const glm::dvec2 scale = texture.repeat * 2.0;
    const glm::dvec2 at = mesh.uvs[t[0]] * scale;
    const glm::dvec2 db = mesh.uvs[t[1]] * scale - at;
    const glm::dvec2 dc = mesh.uvs[t[2]] * scale - at;
    const double det = db.x * dc.y - db.y * dc.x;
    const dvec3 along_x = (b * dc.y - c * db.y) / det;
    const dvec3 along_y = (c * db.x - b * dc.x) / det;
    const dvec3 normal = normalized(cross(b, c));
    // POV-Ray's checker has cells in depth too: the triangles go through the middle of one.
    const dvec3 corner = p - at.x * along_x - at.y * along_y - 0.5 * normal;
    return fmt::format("checker {} {} matrix <{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}>",
                       color(base * texture.checker[0]), color(base * texture.checker[1]), along_x.x, along_x.y,
                       along_x.z, along_y.x, along_y.y, along_y.z, normal.x, normal.y, normal.z, corner.x, corner.y,
                       corner.z);
}

/// POV-Ray's attenuation with a fade_power from 1000 on: exp((fade_color - 1) length / fade_distance).
std::string interior(const MaterialDescription& m) {
    if (!m.fresnel) return "";
    const std::string fade = m.absorption == dvec3(0) ? ""
                                                      : fmt::format(" fade_distance 1 fade_power 1001 fade_color {}",
                                                                    color(dvec3(1) - m.absorption));
    return fmt::format(" interior {{ ior {}{} }}", m.index, fade);
}

/// What is around: colors linear in the cosine of the angle to an axis, which POV-Ray's gradient is over (1 + cosine)
/// / 2.
std::string around(const SceneDescription& scene) {
    if (!scene.sky) return fmt::format("background {{ {} }}\n", color(scene.background));
    std::string map;
    for (size_t i = scene.sky->stops.size(); i-- > 0;) {
        const SkyColor& stop = scene.sky->stops[i];
        map += fmt::format(" [{} {}]", 0.5 + 0.5 * std::cos(stop.degrees * (3.14159265358979323846 / 180)),
                           color(stop.color));
    }
    // A gradient repeats from 1 on: it is stretched by a little, so that the axis itself is not there.
    return fmt::format("sky_sphere {{ pigment {{ gradient {} color_map {{{} }} scale {} translate {} }} }}\n",
                       vector(normalized(scene.sky->axis)), map, 2 * (1 + 1e-9),
                       vector(-(1 + 1e-9) * normalized(scene.sky->axis)));
}

/// POV-Ray weakens the ambient and diffuse light of what transmits kt by 1 - kt, but neither its highlights nor its
/// mirrored light; Cistula weakens all local light by 1 - kr - kt.
std::string texture(const SceneDescription& scene, const MaterialDescription& m, const MeshSource& mesh) {
    const double local = 1 - m.reflection - m.transmission;
    const double painted = m.transmission < 1 ? local / (1 - m.transmission) : 0;
    const std::string pigment =
        m.texture >= 0 ? checker(scene.textures[size_t(m.texture)], m.color, mesh)
                       : fmt::format("{}{}", color(m.color),
                                     m.transmission > 0 ? fmt::format(" transmit {}", m.transmission) : "");
    const std::string mirror = m.fresnel          ? "reflection { 0, 1 fresnel on } conserve_energy "
                               : m.reflection > 0 ? fmt::format("reflection {} ", m.reflection)
                                                  : "";
    return fmt::format("texture {{ pigment {{ {} }} finish {{ ambient {} diffuse {} phong {} phong_size {} {}}} }}{}",
                       pigment, m.ambient * scene.ambient.x * painted, m.diffuse * painted,
                       m.specular * m.specular_color.x * local, m.exponent, mirror, interior(m));
}

MeshSource triangles_of(const SolidObject& solid) {
    MeshSource mesh;
    mesh.owned_vertices = world_vertices(solid);
    mesh.owned_triangles = triangulated(polyhedron_of(solid));
    mesh.view_owned();
    return mesh;
}

}  // namespace

std::string povray_scene(const SceneDescription& scene, const CameraFrame& frame, int width, int height,
                         int max_trace_level) {
    const SceneSource source = gather_scene(scene);
    check(scene, source);
    std::string text = "#version 3.7;\n";
    text +=
        fmt::format("global_settings {{ assumed_gamma 1.0 ambient_light rgb 1 max_trace_level {} adc_bailout 0 }}\n",
                    max_trace_level);
    text += around(scene);
    // All three vectors are given, so POV-Ray's left-handed default does not come in.
    const Camera& camera = frame.camera;
    text += fmt::format("camera {{ perspective location {} direction {} right {} up {} }}\n", vector(camera.position),
                        vector(camera.forward), vector(camera.right * (2 * camera.tan_half_width)),
                        vector(camera.up * (2 * camera.tan_half_width * height / width)));
    for (const LightDescription& light : scene.lights)
        if (light.color != dvec3(0))
            text += fmt::format("light_source {{ {} {} }}\n", vector(light.position), color(light.color));
    for (const SourceSolid& solid : source.solids) {
        if (solid.sphere) {
            text += fmt::format("sphere {{ {}, {} {} }}\n", vector(solid.sphere->center), solid.sphere->radius,
                                texture(scene, source.materials[solid.material], solid.mesh));
            continue;
        }
        const MeshSource made = solid.polyhedron ? triangles_of(*solid.polyhedron) : MeshSource();
        const MeshSource& mesh = solid.polyhedron ? made : solid.mesh;
        text += "mesh {\n";
        for (const auto& t : mesh.triangles)
            text += fmt::format("  triangle {{ {}, {}, {} }}\n", vector(mesh.vertices[t[0]]),
                                vector(mesh.vertices[t[1]]), vector(mesh.vertices[t[2]]));
        if (source.materials[solid.material].fresnel) text += "  inside_vector <0, 0, 1>\n";
        text += "  " + texture(scene, source.materials[solid.material], mesh) + "\n}\n";
    }
    return text;
}

}  // namespace cistula::bench
