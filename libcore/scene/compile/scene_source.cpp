#include "scene/compile/scene_source.h"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "base/default_rounding.h"
#include "cistula/numerics/vec.h"
#include "scene/compile/mesh_solids.h"
#include "scene/compile/placed_bodies.h"
#include "scene/description/platonic.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr size_t most_lights = 1'000'000;  // with those on edges; a short file can ask for any number of these

bool finite_and_not_negative(const dvec3& v) {
    return is_finite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0;
}
bool is_share(double a) {
    return a >= 0 && a <= 1;
}
bool finite_and_not_negative(double a) {
    return is_finite(a) && a >= 0;
}

void check_material(const SceneDescription& scene, const MaterialDescription& m, const std::string& place) {
    const auto refuse = [&](const std::string& text) {
        throw scene_error(scene, place, "material " + m.name + " " + text);
    };
    if (!finite_and_not_negative(m.color)) refuse("has a color that is negative or not finite");
    if (!finite_and_not_negative(m.specular_color)) refuse("has a specular color that is negative or not finite");
    if (!finite_and_not_negative(m.tint) || !is_share(m.tint.x) || !is_share(m.tint.y) || !is_share(m.tint.z))
        refuse("has a tint outside [0, 1]");
    if (!finite_and_not_negative(m.absorption)) refuse("has an absorption that is negative or not finite");
    if (!finite_and_not_negative(m.ambient) || !finite_and_not_negative(m.diffuse) ||
        !finite_and_not_negative(m.specular) || !finite_and_not_negative(m.exponent))
        refuse("has a Phong coefficient or exponent that is negative or not finite");
    if (!is_share(m.reflection) || !is_share(m.transmission) || !(m.reflection + m.transmission <= 1 + 1e-6))
        refuse("has kr + kt above 1, or one of them outside [0, 1]; their sum must be at most 1");
    if (!(m.index > 0) || !is_finite(m.index)) refuse("has an index of refraction that is not above 0");
    if (m.texture < -1 || m.texture >= static_cast<int>(scene.textures.size()))
        refuse("names a texture that does not exist");
}

void check_light(const SceneDescription& scene, const dvec3& color, const std::optional<dvec3>& glow, double radius,
                 bool falloff, const std::string& place) {
    if (!finite_and_not_negative(color) || !finite_and_not_negative(glow.value_or(dvec3{0})))
        throw scene_error(scene, place, "a light's color and glow must be finite and not negative");
    if (!finite_and_not_negative(radius)) throw scene_error(scene, place, "a light's radius must not be negative");
    if (falloff && !(radius > 0))
        throw scene_error(scene, place, "a light with falloff needs a radius above 0, where the falloff is clamped");
}

void check_platonic(const SceneDescription& scene, const SolidObject& solid, const std::string& place) {
    if (!is_finite(solid.center) || !is_finite(solid.rotation))
        throw scene_error(scene, place, "the center and the rotation must be finite");
    if (!(solid.radius > 0) || !is_finite(solid.radius)) throw scene_error(scene, place, "the radius must be above 0");
    const EdgeLights& lights = solid.edge_lights;
    if (lights.count < 0) throw scene_error(scene, place, "the number of lights on an edge must not be negative");
    if (lights.count > 0) check_light(scene, lights.color, lights.glow, lights.radius, lights.falloff, place);
}

/// `name`, or one after a place in the file, "object3", if that is empty.
std::string given_name(const std::string& name, const std::string& place) {
    return name.empty() ? "object" + place.substr(place.find_last_of('/') + 1) : name;
}

/// Material names in use, and the mesh file that each comes from: empty for those of the scene file.
using MaterialNames = std::map<std::string, std::string>;

/// Puts the object's name before that of a mesh file's material where another material has it, so that mattes tell the
/// two apart. Materials of one name in one file are one material.
void make_name_own(MaterialDescription& material, const ObjectDescription& object, const std::string& file,
                   MaterialNames& names) {
    while (names.try_emplace(material.name, file).first->second != file)
        material.name = given_name(object.name, object.place) + "/" + material.name;
}

void add_mesh(SceneSource& source, const ObjectDescription& object, const MeshObject& mesh, const MeshData& data,
              MaterialNames& names) {
    const SceneDescription& scene = *source.description;
    if (!is_finite(mesh.center) || !is_finite(mesh.rotation) || !is_finite(mesh.scale) || mesh.scale == 0)
        throw scene_error(scene, object.place, "the center and rotation must be finite, the scale finite and not 0");
    for (const std::string& warning : data.warnings)
        source.warnings.push_back(scene_error(scene, object.place, warning).what());
    std::vector<MeshGroup> groups = join_groups(placed_parts(data, mesh), object.material >= 0);
    if (groups.empty()) throw scene_error(scene, object.place, "there are no triangles; give at least one");
    for (auto& [part, pieces] : groups) {
        SourceSolid solid;
        solid.name = groups.size() == 1 ? object.name : given_name(object.name, object.place) + "/" + part.name;
        solid.place = object.place;
        solid.mesh = std::move(part.mesh);
        solid.keep_triangles = mesh.keep_triangles;
        if (object.material >= 0) {
            solid.material = static_cast<uint32_t>(object.material);
        } else if (part.material) {
            check_material(scene, *part.material, object.place);
            solid.material = static_cast<uint32_t>(source.materials.size());
            source.materials.push_back(*part.material);
            make_name_own(source.materials.back(), object, mesh.file, names);
        } else {
            throw scene_error(scene, object.place,
                              "the mesh brings no material of its own" +
                                  (mesh.data ? "" : " (" + mesh.file + ")") + "; name one with \"material\"");
        }
        add_mesh_solids(source, std::move(solid), std::move(pieces));
    }
}

/// Mattes could not tell apart two solids of one name, be it given, a mesh part's, or one after a place.
void require_different_names(const SceneSource& source) {
    std::unordered_map<std::string, const SourceSolid*> first;
    for (const SourceSolid& solid : source.solids) {
        if (solid.body > 0) continue;
        const auto [other, is_new] = first.try_emplace(name_of(solid), &solid);
        if (!is_new && !(solid.name.empty() && other->second->name.empty()))
            throw scene_error(*source.description, solid.place,
                              quoted(other->first) + " is the name of " + other->second->place +
                                  " too: an object without a name is called object and its number, a part of a mesh by "
                                  "the object's name, / and its own; give each another");
    }
}

}  // namespace

std::string name_of(const SourceSolid& solid) {
    return given_name(solid.name, solid.place);
}

namespace {

SceneSource gathered_scene(const SceneDescription& description, SceneAssets assets) {
    SceneSource source;
    source.description = &description;
    source.materials = description.materials;
    source.files = std::move(assets.files);
    source.pictures = std::move(assets.pictures);
    for (size_t i = 0; i < description.materials.size(); ++i)
        check_material(description, description.materials[i], "/materials/" + std::to_string(i));
    if (!finite_and_not_negative(description.ambient) || !finite_and_not_negative(description.background))
        throw scene_error(description, "", "the ambient and background colors must be finite and not negative");
    for (const LightDescription& light : description.lights) {
        if (!is_finite(light.position)) throw scene_error(description, light.place, "the position must be finite");
        check_light(description, light.color, light.glow, light.radius, light.falloff, light.place);
    }

    MaterialNames material_names;
    for (const MaterialDescription& material : description.materials) material_names[material.name];
    size_t lights = description.lights.size();
    for (const ObjectDescription& object : description.objects) {
        if (object.material >= static_cast<int>(description.materials.size()))
            throw scene_error(description, object.place, "names a material that does not exist");
        if (const auto* mesh = std::get_if<MeshObject>(&object.shape)) {
            std::shared_ptr<const MeshData>& data = assets.meshes[static_cast<size_t>(&object - description.objects.data())];
            add_mesh(source, object, *mesh, *data, material_names);
            data.reset();
            continue;
        }
        if (object.material < 0)
            throw scene_error(description, object.place, "has no material; only a mesh file can bring its own");
        SourceSolid solid;
        solid.name = object.name;
        solid.place = object.place;
        solid.material = static_cast<uint32_t>(object.material);
        if (const auto* platonic = std::get_if<SolidObject>(&object.shape)) {
            check_platonic(description, *platonic, object.place);
            solid.platonic = platonic;
            lights += platonic_shape(platonic->solid).edges.size() * static_cast<size_t>(platonic->edge_lights.count);
            if (lights > most_lights)
                throw scene_error(description, object.place,
                                  "with the lights on its edges the scene has more than " +
                                      std::to_string(most_lights) + " lights; lower its count");
        } else {
            const auto& triangles = std::get<TrianglesObject>(object.shape);
            solid.mesh.vertices = triangles.vertices;
            solid.mesh.triangles = triangles.triangles;
            solid.mesh.uvs = triangles.uvs;
            solid.mesh.rounding = coordinate_rounding(triangles.vertices);
            solid.keep_triangles = triangles.keep_triangles;
            MeshPieces pieces = find_pieces(solid.mesh);
            add_mesh_solids(source, std::move(solid), std::move(pieces));
            continue;
        }
        source.solids.push_back(std::move(solid));
    }
    source.warnings.insert(source.warnings.end(), assets.warnings.begin(), assets.warnings.end());
    require_different_names(source);
    for (const SourceSolid& solid : source.solids) {
        const MaterialDescription& material = source.materials[solid.material];
        if (material.texture < 0) continue;
        const std::string what = "the material " + material.name + " has a texture, but ";
        if (solid.platonic)
            throw scene_error(description, solid.place,
                              what + "a " + platonic_name(solid.platonic->solid) +
                                  " has no texture coordinates; give it a material without a texture");
        if (solid.mesh.uvs.empty())
            throw scene_error(description, solid.place,
                              what + "the triangles have no texture coordinates; give one uv a vertex");
    }
    source.bodies = std::make_shared<const PlacedBodies>(source);
    return source;
}

}  // namespace

SceneSource gather_scene(const SceneDescription& description, SceneAssets assets) {
    return in_default_rounding([&] { return gathered_scene(description, std::move(assets)); });
}

}  // namespace cistula
