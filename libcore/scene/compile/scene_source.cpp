#include "scene/compile/scene_source.h"

#include <algorithm>
#include <exception>
#include <map>
#include <unordered_map>

#include <tbb/parallel_for.h>

#include "base/default_rounding.h"
#include "cistula/numerics/vec.h"
#include "scene/compile/meshes/mesh_solids.h"
#include "scene/compile/scene_normalization.h"
#include "scene/compile/solids/compile_disks.h"
#include "scene/compile/solids/placed_bodies.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "scene/readers/scene_keys.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr size_t most_lights = 1'000'000;  // with those on edges; a short file can ask for any number of these

/// Throws for numbers that their keys do not allow; `what` begins the message: "material glass: ".
class FieldCheck {
  public:
    FieldCheck(const SceneDescription& scene, std::string place, const KeyTable& table, std::string what = "")
        : scene_(scene), place_(std::move(place)), table_(table), what_(std::move(what)) {}

    template <class Field>
    void operator()(std::string_view name, const Field& field) const {
        const Key& key = *table_.find(name);
        if (!allows(key, field)) refuse(std::string(name) + ": expected " + expected_text(key));
    }
    /// Throws unless the text is empty.
    void refuse(const std::string& text) const {
        if (!text.empty()) throw scene_error(scene_, place_, what_ + text);
    }

  private:
    const SceneDescription& scene_;
    const std::string place_;
    const KeyTable& table_;
    const std::string what_;
};

void check_material(const SceneDescription& scene, const MaterialDescription& m, const std::string& place) {
    const FieldCheck check(scene, place, material_keys, "material " + m.name + ": ");
    material_fields(m, check);
    check.refuse(shares_fault(m));
    if (m.texture < -1 || m.texture >= static_cast<int>(scene.textures.size()))
        check.refuse("names a texture that does not exist");
}

template <class Light>
void check_light(const SceneDescription& scene, const Light& light, const KeyTable& table, const std::string& place) {
    const FieldCheck check(scene, place, table);
    light_fields(light, check);
    check.refuse(falloff_fault(light.falloff, light.radius));
}

void check_polyhedron(const SceneDescription& scene, const SolidObject& solid, const std::string& place) {
    solid_fields(solid, FieldCheck(scene, place, solid_keys));
    const EdgeLights& lights = solid.edge_lights;
    if (lights.count < 0) throw scene_error(scene, place, "the number of lights on an edge must not be negative");
    if (lights.count > 0) check_light(scene, lights, edge_lights_keys, place);
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

/// Gives each part of a mesh a name of its own: one that an earlier part has gets a number, as "wood.2".
void number_equal_names(std::vector<MeshGroup>& groups) {
    std::map<std::string, uint32_t> numbers;  // the last of each name
    for (const MeshGroup& group : groups) numbers[group.part.name];
    for (MeshGroup& group : groups) {
        std::string& name = group.part.name;
        uint32_t& number = numbers.at(name);
        if (number++ == 0) continue;
        const std::string first = name;
        while (!numbers.try_emplace(name = first + "." + std::to_string(number), 1).second) ++number;
    }
}

/// Places meshes on all threads, some objects ahead of the one that is asked for.
class MeshPlacement {
  public:
    /// `known`: has the meshes that are not placed anew; null: none.
    MeshPlacement(const SceneDescription& scene, const SceneAssets& assets, const MovingScene* known, StopSignal stop)
        : scene_(scene), assets_(assets), known_(known), stop_(stop) {}

    /// The groups of an object's mesh, or the error that placing it threw. Numbers must ascend.
    std::vector<MeshGroup> groups(size_t object) {
        if (object >= first_ + placed_.size()) place_from(object);
        Placed& placed = placed_[object - first_];
        if (placed.error) std::rethrow_exception(placed.error);
        return std::move(placed.groups);
    }

  private:
    struct Placed {
        std::vector<MeshGroup> groups;
        std::exception_ptr error;
    };
    static constexpr size_t most_at_once = 4096;
    static constexpr size_t most_vertices = 100'000;  // but for those of the last

    /// The mesh of an object that is to be placed, or null.
    const MeshData* data_of(size_t object) const {
        const bool is_known = known_ && !known_->solids[object].empty();
        return is_known || object >= assets_.meshes.size() ? nullptr : assets_.meshes[object].get();
    }

    void place_from(size_t first) {
        size_t end = first;
        for (size_t vertices = 0; end < scene_.objects.size() && end - first < most_at_once && vertices < most_vertices;
             ++end)
            if (const MeshData* data = data_of(end))
                for (const PolygonMesh& group : data->groups) vertices += group.vertices.size();
        first_ = first;
        placed_.clear();
        placed_.resize(end - first);
        tbb::parallel_for(first, end, [&](size_t i) {
            const MeshData* const data = data_of(i);
            if (!data) return;
            const ObjectDescription& object = scene_.objects[i];
            Placed& placed = placed_[i - first];
            try {
                placed.groups =
                    join_groups(placed_parts(*data, std::get<MeshObject>(object.shape)), object.material >= 0, stop_);
            } catch (...) {
                placed.error = std::current_exception();
            }
        });
    }

    const SceneDescription& scene_;
    const SceneAssets& assets_;
    const MovingScene* const known_;
    const StopSignal stop_;
    size_t first_ = 0;
    std::vector<Placed> placed_;
};

void add_mesh(SceneSource& source, const ObjectDescription& object, const MeshObject& mesh, const MeshData& data,
              MeshPlacement& placement, MaterialNames& names) {
    const SceneDescription& scene = *source.description;
    mesh_fields(mesh, FieldCheck(scene, object.place, mesh_keys));
    for (const std::string& warning : data.warnings)
        source.warnings.push_back(scene_error(scene, object.place, warning).what());
    std::vector<MeshGroup> groups = placement.groups(static_cast<size_t>(&object - scene.objects.data()));
    if (groups.empty()) throw scene_error(scene, object.place, "there are no triangles", "give at least one");
    number_equal_names(groups);
    for (auto& [part, pieces] : groups) {
        SourceSolid solid;
        solid.name = groups.size() == 1 ? object.name : given_name(object.name, object.place) + "/" + part.name;
        solid.place = object.place;
        solid.object = static_cast<size_t>(&object - scene.objects.data());
        solid.mesh = std::move(part.mesh);
        solid.keep_triangles = mesh.keep_triangles;
        solid.smooth = mesh.smooth;
        if (object.material >= 0) {
            solid.material = static_cast<uint32_t>(object.material);
        } else if (part.material) {
            check_material(scene, *part.material, object.place);
            solid.material = static_cast<uint32_t>(source.materials.size());
            source.materials.push_back(*part.material);
            make_name_own(source.materials.back(), object, mesh.file, names);
        } else {
            throw scene_error(scene, object.place,
                              "the mesh brings no material of its own" + (mesh.data ? "" : " (" + mesh.file + ")"),
                              "name one with \"material\"");
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
                                  "the object's name, / and its own",
                              "give each another");
    }
}

}  // namespace

SourceSolid SourceSolid::with_mesh(MeshSource triangles) const {
    SourceSolid made;
    made.name = name;
    made.place = place;
    made.material = material;
    made.mesh = std::move(triangles);
    made.closed = closed;
    made.thickness = thickness;
    made.body = body;
    made.keep_triangles = keep_triangles;
    made.object = object;
    made.smooth = smooth;
    made.normals = normals;
    made.in_parts = in_parts;
    return made;
}

std::string name_of(const SourceSolid& solid) {
    return given_name(solid.name, solid.place);
}

namespace {

/// A scene whose solids are not placed in its frame yet. `known`: has those that do not change; null: none.
SceneSource gathered_parts(const SceneDescription& description, SceneAssets assets, StopSignal stop,
                           const MovingScene* known = nullptr) {
    SceneSource source;
    source.description = &description;
    source.stop = stop;
    source.materials = description.materials;
    source.files = std::move(assets.files);
    source.pictures = std::move(assets.pictures);
    for (size_t i = 0; i < description.materials.size(); ++i)
        check_material(description, description.materials[i], "/materials/" + std::to_string(i));
    const FieldCheck check_scene(description, "", scene_keys);
    check_scene("ambient", description.ambient);
    check_scene("background", description.background);
    for (const LightDescription& light : description.lights) {
        FieldCheck(description, light.place, light_keys)("position", light.position);
        check_light(description, light, light_keys, light.place);
    }

    MaterialNames material_names;
    for (const MaterialDescription& material : description.materials) material_names[material.name];
    MeshPlacement placement(description, assets, known, stop);
    size_t lights = description.lights.size(), disks = 0;
    for (const ObjectDescription& object : description.objects) {
        const auto number = static_cast<size_t>(&object - description.objects.data());
        if (known && !known->solids[number].empty()) {
            for (const SourceSolid& solid : known->solids[number])
                source.solids.push_back(solid.with_mesh(solid.mesh.borrowed()));
            continue;
        }
        if (object.material >= static_cast<int>(description.materials.size()))
            throw scene_error(description, object.place, "names a material that does not exist");
        if (const auto* mesh = std::get_if<MeshObject>(&object.shape)) {
            std::shared_ptr<const MeshData>& data = assets.meshes[number];
            add_mesh(source, object, *mesh, *data, placement, material_names);
            data.reset();
            continue;
        }
        if (object.material < 0)
            throw scene_error(description, object.place, "has no material", "only a mesh file can bring its own");
        SourceSolid solid;
        solid.name = object.name;
        solid.place = object.place;
        solid.object = number;
        solid.material = static_cast<uint32_t>(object.material);
        if (const auto* polyhedron = std::get_if<SolidObject>(&object.shape)) {
            check_polyhedron(description, *polyhedron, object.place);
            solid.polyhedron = polyhedron;
            if (const std::string& warning = polyhedron_of(*polyhedron).warning; !warning.empty())
                source.warnings.push_back(scene_error(description, object.place, warning).what());
            lights += polyhedron_of(*polyhedron).edges.size() * static_cast<size_t>(polyhedron->edge_lights.count);
            if (lights > most_lights)
                throw scene_error(
                    description, object.place,
                    "with the lights on its edges the scene has more than " + std::to_string(most_lights) + " lights",
                    "lower its count");
        } else if (const auto* sphere = std::get_if<SphereObject>(&object.shape)) {
            solid_fields(*sphere, FieldCheck(description, object.place, solid_keys));
            solid.sphere = sphere;
        } else if (const auto* disk = std::get_if<DiskObject>(&object.shape)) {
            const FieldCheck check(description, object.place, disk_shape_keys);
            if (!disk->is_endless()) check("radius", disk->radius);
            check("center", disk->center);
            check("normal", disk->normal);
            if (!(length(disk->normal) > 0)) check.refuse("the normal is 0");
            solid.disk = disk;
            solid.closed = false;
            if (++disks > most_disks)
                throw scene_error(description, object.place,
                                  "more than " + std::to_string(most_disks) + " planes and disks",
                                  "make some of them quads or triangles");
            if (!disk->is_endless()) add_square(solid, {});
        } else {
            const auto& triangles = std::get<TrianglesObject>(object.shape);
            solid.mesh.vertices = triangles.vertices;
            solid.mesh.triangles = triangles.triangles;
            solid.mesh.uvs = triangles.uvs;
            solid.mesh.normals = triangles.normals;
            solid.mesh.rounding = coordinate_rounding(triangles.vertices);
            solid.keep_triangles = triangles.keep_triangles;
            solid.smooth = triangles.smooth;
            MeshPieces pieces = find_pieces(solid.mesh, stop);
            add_mesh_solids(source, std::move(solid), std::move(pieces));
            continue;
        }
        source.solids.push_back(std::move(solid));
    }
    source.warnings.insert(source.warnings.end(), assets.warnings.begin(), assets.warnings.end());
    require_different_names(source);
    for (const SourceSolid& solid : source.solids) {
        const MaterialDescription& material = source.materials[solid.material];
        if (material.texture < 0 || solid.sphere || solid.disk) continue;
        const std::string what = "the material " + material.name + " has a texture, but ";
        if (solid.polyhedron)
            throw scene_error(description, solid.place,
                              what + "a " + polyhedron_of(*solid.polyhedron).name + " has no texture coordinates",
                              "give it a material without a texture");
        if (solid.mesh.uvs.empty())
            throw scene_error(description, solid.place, what + "the triangles have no texture coordinates",
                              "give one uv a vertex");
    }
    return source;
}

/// The solids of each mesh that does not change, but for those that bring materials.
std::vector<std::vector<SourceSolid>> still_meshes(const SceneDescription& description, const SceneSource& source) {
    std::vector<std::vector<SourceSolid>> solids(description.objects.size());
    const std::vector<size_t>& moving = description.motion->objects;
    for (const SourceSolid& solid : source.solids)
        if (solid.is_mesh() && !solid.disk && description.objects[solid.object].material >= 0 &&
            !std::binary_search(moving.begin(), moving.end(), solid.object))
            solids[solid.object].push_back(solid.with_mesh(solid.mesh.copy()));
    return solids;
}

/// `moving`: of a scene that changes, if it is known already.
SceneSource gathered_scene(const SceneDescription& description, SceneAssets assets, StopSignal stop,
                           std::shared_ptr<const MovingScene> moving = nullptr) {
    const bool keeps_assets = description.motion && !moving;  // else they are freed as they are placed
    SceneSource source = named_by_frame(description, [&] {
        return gathered_parts(description, keeps_assets ? assets : std::move(assets), stop, moving.get());
    });
    if (keeps_assets) {
        const auto gather = [&](const SceneDescription& part) { return gathered_parts(part, {}, stop); };
        MovingParts parts(description, assets, gather, stop);
        moving = std::make_shared<const MovingScene>(
            MovingScene{description, std::move(assets), std::move(parts), still_meshes(description, source)});
    }
    source.moving = std::move(moving);
    named_by_frame(description, [&] {
        for (SourceSolid& solid : source.solids)
            if (solid.disk && solid.disk->is_endless()) add_square(solid, find_normalization(source));
        source.bodies = std::make_shared<const PlacedBodies>(source);
    });
    return source;
}

}  // namespace

SceneSource gather_scene(const SceneDescription& description, SceneAssets assets, StopSignal stop) {
    return in_default_rounding([&] { return gathered_scene(description, std::move(assets), stop); });
}

SceneSource gather_frame(const std::shared_ptr<const MovingScene>& moving, int frame, StopSignal stop) {
    return in_default_rounding([&] {
        auto own = std::make_shared<const SceneDescription>(at_frame(moving->description, frame));
        SceneSource source = gathered_scene(*own, moving->assets, stop, moving);
        source.own = std::move(own);
        return source;
    });
}

}  // namespace cistula
