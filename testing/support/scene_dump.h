// Exact text dump of everything in a description that affects the picture: equal texts are equal scenes. Left out are
// places in the file, the text input's output pattern and its flag.
#pragma once

#include <filesystem>
#include <sstream>
#include <string>

#include "scene/description/polyhedron.h"

namespace cistula {

/// The root of the source tree.
inline std::filesystem::path source_root() {
    return CISTULA_SOURCE_DIR;
}

class SceneDump {
  public:
    static std::string of(const SceneDescription& scene) {
        SceneDump dump;
        dump.write(scene);
        return dump.out_.str();
    }

  private:
    SceneDump() { out_ << std::hexfloat << std::boolalpha; }

    template <class... Values>
    void line(const char* name, const Values&... values) {
        out_ << name;
        (put(values), ...);
        out_ << '\n';
    }
    template <class Value>
    void put(const Value& value) {
        out_ << ' ' << value;
    }
    void put(const glm::dvec2& v) { out_ << " [" << v.x << ' ' << v.y << ']'; }
    void put(const glm::dvec3& v) { out_ << " [" << v.x << ' ' << v.y << ' ' << v.z << ']'; }
    template <class Value>
    void put(const std::optional<Value>& value) {
        if (value)
            put(*value);
        else
            out_ << " none";
    }
    void put(const CylindricalPath& p) {
        for (const double number : {p.r0, p.z0, p.phi0, p.Ar, p.Az, p.wr, p.wz, p.wphi, p.pr, p.pz}) put(number);
    }

    void write(const SolidObject& s) {
        line(" solid", polyhedron_of(s).name, s.center, s.radius, s.rotation);
        for (const auto& p : polyhedron_of(s).planes) line(" planes", p.normal, p.low, p.high);
        const EdgeLights& e = s.edge_lights;
        line(" edge lights", e.count, e.color, e.glow, e.radius, e.visible, e.falloff);
    }
    void write(const DiskObject& d) { line(" disk", d.center, d.normal, d.radius); }
    void write(const SphereObject& s) { line(" sphere", s.center, s.radius, s.rotation); }
    void write(const TrianglesObject& t) {
        for (const auto& vertex : t.vertices) line(" vertex", vertex);
        for (const auto& triangle : t.triangles) line(" triangle", triangle[0], triangle[1], triangle[2]);
        for (const auto& uv : t.uvs) line(" uv", uv);
        for (const auto& normal : t.normals) line(" normal", normal);
        line(" keep triangles", t.keep_triangles);
        line(" smooth", t.smooth);
    }
    void write(const MeshObject& m) {
        line(" mesh", m.file, m.center, m.scale, m.rotation, m.keep_triangles, m.smooth);
    }

    void write(const SceneDescription& s) {
        line("film", s.film.width, s.film.height, s.film.frames, s.film.supersample);
        line("light", s.depth, s.cutoff, s.ambient, s.background);
        if (s.sky) {
            line("sky", s.sky->axis, s.sky->texture, s.sky->rotation, s.sky->scale);
            for (const auto& stop : s.sky->stops) line(" stop", stop.degrees, stop.color);
        }
        line("camera", s.camera.position, s.camera.target, s.camera.up, s.camera.field_of_view, s.camera.time_step);
        line("paths", s.camera.position_path, s.camera.target_path);
        for (const auto& t : s.textures)
            line("texture", t.name, t.file, t.checker[0], t.checker[1], t.bilinear, t.repeat, int(t.wrap[0]),
                 int(t.wrap[1]), t.colorspace, t.strict);
        for (const auto& m : s.materials)
            line("material", m.name, m.color, m.texture, m.ambient, m.diffuse, m.specular, m.specular_color, m.exponent,
                 m.reflection, m.transmission, m.tint, m.index, m.absorption, m.fresnel);
        for (const auto& object : s.objects) {
            line("object", object.name, object.material);
            std::visit([this](const auto& shape) { write(shape); }, object.shape);
        }
        for (const auto& l : s.lights) line("light", l.position, l.color, l.glow, l.radius, l.visible, l.falloff);
        if (s.frame) line("frame", s.frame->center, s.frame->scale, s.frame->bound);
    }

    std::ostringstream out_;
};

}  // namespace cistula
