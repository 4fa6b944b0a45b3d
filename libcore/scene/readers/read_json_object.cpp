// Reads the elements of "objects": solids, planes, disks, quads, triangle lists and mesh files.
#include <algorithm>

#include <fmt/format.h>

#include "base/suggest.h"
#include "scene/description/polyhedron.h"
#include "scene/readers/json_reader.h"
#include "scene/readers/meshes/polygon.h"
#include "scene/readers/scene_formats.h"

namespace cistula {
namespace {

const Key& vertex_key() {
    return *solid_keys.find("center");
}

void read_common(JsonObject& keys, const ObjectContext& context, ObjectDescription& object) {
    keys.read("name", object.name);
    if (keys.has("material")) object.material = index_of_name(keys.at("material"), context.materials, "material");
}

/// Throws for a texture on an object without uv: solids, and triangle lists without "uvs".
void refuse_texture(JsonObject& keys, const ObjectContext& context, const ObjectDescription& object,
                    const std::string& reason) {
    const MaterialDescription& material = context.scene.materials[static_cast<size_t>(object.material)];
    if (material.texture >= 0)
        keys.fail("material", fmt::format("the material {} has a texture, but {}", quoted(material.name), reason));
}

EdgeLights read_edge_lights(const JsonValue& value) {
    EdgeLights lights;
    JsonObject keys(value, edge_lights_keys);
    keys.read("count", lights.count);
    light_fields(lights, [&](std::string_view key, auto& field) { keys.read(key, field); });
    lights.falloff = keys.read_choice("falloff") == 1;
    read_light_group(keys, lights.group);
    keys.finish();
    if (const std::string fault = falloff_fault(lights.falloff, lights.radius); !fault.empty())
        keys.fail("falloff", fault);
    return lights;
}

const KeyTable* const solid_tables[] = {&sphere_keys, &box_keys, &convex_keys, &prism_keys,
                                        &solid_keys};  // messages name these first

/// The keys of a solid, told by its name.
const KeyTable& table_of_solid(const JsonValue& value) {
    std::vector<std::string_view> names;
    std::vector<const KeyTable*> tables;
    for (const KeyTable* table : solid_tables)
        for (const std::string_view name : table->find("solid")->choices)
            names.push_back(name), tables.push_back(table);
    const Key all{"solid", KeyType::choice, {}, {}, true, names};
    return *tables[static_cast<size_t>(value.member("solid").choice(all))];
}

/// The body that make() makes; what is wrong with it is said of `value`.
template <class Make>
std::shared_ptr<const Polyhedron> made_of(const JsonValue& value, const Make& make) {
    try {
        return std::make_shared<const Polyhedron>(make());
    } catch (const Error& error) {
        value.fail(error);
    }
}

/// The plane [nx, ny, nz, d]; `purpose`: what its normal is for.
BodyPlane read_plane_numbers(const JsonValue& value, const char* purpose) {
    const glm::dvec4 numbers = value.plane({"planes", KeyType::number, vertex_key().range});
    const glm::dvec3 normal(numbers);
    if (normal == glm::dvec3(0)) value.fail("the normal is 0", purpose);
    return {normal, numbers.w};
}

std::shared_ptr<const Polyhedron> read_planes(const JsonValue& value) {
    constexpr size_t most_planes = 1024;
    std::vector<BodyPlane> planes;
    const size_t count = value.array_size(4, "an array of at least four planes [nx, ny, nz, d]");
    if (count > most_planes) value.fail_expected(fmt::format("an array of at most {} planes", most_planes));
    for (size_t i = 0; i < count; ++i)
        planes.push_back(read_plane_numbers(value.item(i), "give the direction in which the face looks"));
    return made_of(value, [&] { return body_of_planes("convex solid", planes); });
}

std::shared_ptr<const Polyhedron> read_points(const JsonValue& value) {
    std::vector<glm::dvec3> points;
    const size_t count = value.array_size(4, "an array of at least four points [x, y, z]");
    for (size_t i = 0; i < count; ++i) points.push_back(value.item(i).point(vertex_key()));
    return made_of(value, [&] { return hull_of("convex solid", points); });
}

/// The body of a solid that is not Platonic.
std::shared_ptr<const Polyhedron> read_body(JsonObject& keys, const KeyTable& table) {
    if (&table == &box_keys) {
        glm::dvec3 size;
        keys.read("size", size);
        return made_of(keys.at("size"), [&] { return box_body(size); });
    }
    if (&table == &prism_keys) {
        const auto kind = static_cast<PolygonBody>(keys.read_choice("solid"));
        int sides = 0;
        double radius = 1;
        double height = 1;
        keys.read("sides", sides);
        keys.read("radius", radius);
        keys.read("height", height);
        return made_of(keys.at("sides"), [&] { return body_over_polygon(kind, sides, radius, height); });
    }
    const bool by_planes = keys.has("planes");
    const bool by_points = keys.has("points");
    if (by_planes && by_points) keys.value().fail("expected one of 'planes' and 'points', found both");
    if (!by_planes && !by_points) keys.value().fail("expected one of the keys 'planes' and 'points'");
    return by_planes ? read_planes(keys.at("planes")) : read_points(keys.at("points"));
}

void read_solid(const JsonValue& value, const ObjectContext& context, ObjectDescription& object) {
    const KeyTable& table = table_of_solid(value);
    JsonObject keys(value, table);
    read_common(keys, context, object);
    const int kind = keys.read_choice("solid");
    if (&table == &sphere_keys) {
        SphereObject sphere;
        solid_fields(sphere, [&](std::string_view key, auto& field) { keys.read(key, field); });
        keys.finish();
        object.shape = sphere;
        return;
    }
    SolidObject solid;
    if (&table != &solid_keys)
        solid.body = read_body(keys, table);
    else if (kind <= static_cast<int>(PlatonicSolid::icosahedron))
        solid.solid = static_cast<PlatonicSolid>(kind);
    else
        solid.body = archimedean_body(table.find("solid")->choices[static_cast<size_t>(kind)]);
    keys.read("center", solid.center);
    keys.read("rotate", solid.rotation);
    if (&table == &solid_keys) keys.read("radius", solid.radius);
    if (&table == &convex_keys) keys.read("scale", solid.radius);
    if (keys.has("edge_lights")) solid.edge_lights = read_edge_lights(keys.at("edge_lights"));
    keys.finish();
    refuse_texture(keys, context, object, "a solid has no uv for it; use triangles with 'uvs' or a mesh");
    object.shape = solid;
}

void read_plane(const JsonValue& value, const ObjectContext& context, ObjectDescription& object) {
    JsonObject keys(value, plane_keys);
    read_common(keys, context, object);
    const BodyPlane plane = read_plane_numbers(keys.at("plane"), "give the direction across the plane");
    keys.finish();
    object.shape = DiskObject::plane(plane.normal, plane.offset);
}

void read_disk(const JsonValue& value, const ObjectContext& context, ObjectDescription& object) {
    JsonObject keys(value, disk_keys);
    read_common(keys, context, object);
    JsonObject shape(keys.at("disk"), disk_shape_keys);
    DiskObject disk;
    disk_fields(disk, [&](std::string_view key, auto& field) { shape.read(key, field); });
    if (disk.normal == glm::dvec3(0)) shape.fail("normal", "the normal is 0", "give the direction across the disk");
    shape.finish();
    keys.finish();
    object.shape = disk;
}

void read_quad(const JsonValue& value, const ObjectContext& context, ObjectDescription& object) {
    JsonObject keys(value, quad_keys);
    read_common(keys, context, object);
    const JsonValue points = keys.at("quad");
    const std::string expected = "an array of four points [x, y, z]";
    if (points.array_size(4, expected) != 4) points.fail_expected(expected);
    std::array<glm::dvec3, 4> corners;
    for (size_t i = 0; i < 4; ++i) corners[i] = points.item(i).point(vertex_key());
    if (const auto problem = quad_problem(corners)) points.fail(*problem);
    keys.finish();
    object.shape = quad_triangles(corners);
}

/// Reads whether a mesh is smooth: false, or an angle.
void read_smooth(JsonObject& keys, Smoothing& smooth) {
    if (!keys.has("smooth")) return;
    const JsonValue value = keys.at("smooth");
    if (value.json().is_boolean()) {
        if (value.json() == true) value.fail_expected("false, or an angle from 0 to 180 degrees");
        smooth = 0;
    } else {
        smooth = value.number({"smooth", KeyType::number, {0, 180}, {}, false, {}});
    }
}

TrianglesObject read_triangle_list(const JsonValue& value) {
    constexpr Key uv_key{"uvs", KeyType::pair, {-1e6, 1e6}, {}, false, {}};
    TrianglesObject list;
    JsonObject keys(value, triangle_list_keys);

    const JsonValue vertices = keys.at("vertices");
    const size_t vertex_count = vertices.array_size(3, "an array of at least three points [x, y, z]");
    list.vertices.reserve(vertex_count);
    for (size_t i = 0; i < vertex_count; ++i) list.vertices.push_back(vertices.item(i).point(vertex_key()));

    const JsonValue indices = keys.at("indices");
    const std::string expected = "three indices of vertices [i, j, k]";
    const Key index_key{"indices", KeyType::whole, {0, static_cast<double>(vertex_count - 1)}, {}, false, {}};
    const size_t triangle_count = indices.array_size(1, "an array of at least one triangle [i, j, k]");
    list.triangles.reserve(triangle_count);
    for (size_t i = 0; i < triangle_count; ++i) {
        const JsonValue triangle = indices.item(i);
        if (triangle.array_size(3, expected) != 3) triangle.fail_expected(expected);
        auto& corners = list.triangles.emplace_back();
        for (size_t corner = 0; corner < 3; ++corner)
            corners[corner] = static_cast<uint32_t>(triangle.item(corner).whole(index_key));
    }

    if (keys.has("uvs")) {
        const JsonValue uvs = keys.at("uvs");
        const std::string one_each = fmt::format("an array of {} pairs [u, v], one a vertex", vertex_count);
        if (uvs.array_size(0, one_each) != vertex_count) uvs.fail_expected(one_each);
        list.uvs.reserve(vertex_count);
        for (size_t i = 0; i < vertex_count; ++i) list.uvs.push_back(uvs.item(i).pair(uv_key));
    }
    if (keys.has("normals")) {
        const JsonValue normals = keys.at("normals");
        const std::string one_each = fmt::format("an array of {} vectors [x, y, z], one a vertex", vertex_count);
        if (normals.array_size(0, one_each) != vertex_count) normals.fail_expected(one_each);
        list.normals.reserve(vertex_count);
        for (size_t i = 0; i < vertex_count; ++i) list.normals.push_back(normals.item(i).point(vertex_key()));
    }
    keys.finish();
    return list;
}

void read_triangles(const JsonValue& value, const ObjectContext& context, ObjectDescription& object) {
    JsonObject keys(value, triangles_keys);
    read_common(keys, context, object);
    TrianglesObject list = read_triangle_list(keys.at("triangles"));
    keys.read("keep_triangles", list.keep_triangles);
    read_smooth(keys, list.smooth);
    keys.finish();
    if (list.uvs.empty()) refuse_texture(keys, context, object, "the triangles have no 'uvs'");
    object.shape = std::move(list);
}

void read_mesh(const JsonValue& value, const ObjectContext& context, ObjectDescription& object) {
    MeshObject mesh;
    JsonObject keys(value, mesh_keys);
    read_common(keys, context, object);
    keys.read("mesh", mesh.file);
    mesh.file = file_beside_scene(mesh.file, context.base_dir);
    mesh_fields(mesh, [&](std::string_view key, auto& field) { keys.read(key, field); });
    read_smooth(keys, mesh.smooth);
    keys.finish();
    object.shape = mesh;
}

struct Form {
    const char* key;  // the key that identifies the form
    std::span<const KeyTable* const> tables;
    void (*read)(const JsonValue&, const ObjectContext&, ObjectDescription&);
};

const KeyTable* const sheet_tables[] = {&plane_keys, &disk_keys, &quad_keys, &triangles_keys, &mesh_keys};
const Form forms[] = {
    {"solid", solid_tables, read_solid},
    {"plane", std::span(sheet_tables).subspan(0, 1), read_plane},
    {"disk", std::span(sheet_tables).subspan(1, 1), read_disk},
    {"quad", std::span(sheet_tables).subspan(2, 1), read_quad},
    {"triangles", std::span(sheet_tables).subspan(3, 1), read_triangles},
    {"mesh", std::span(sheet_tables).subspan(4, 1), read_mesh},
};
const std::string known_forms = "'solid', 'plane', 'disk', 'quad', 'triangles' and 'mesh'";

/// Throws for an object with no form's key, most likely because it is misspelled.
[[noreturn]] void fail_without_form(const JsonValue& value) {
    std::vector<std::string_view> known;
    for (const Form& form : forms)
        for (const KeyTable* table : form.tables)
            for (const std::string_view name : table->names())
                if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
    for (const auto& member : value.json().items())
        if (member.key() != comment_key && std::find(known.begin(), known.end(), member.key()) == known.end())
            value.fail_at(value.place_of(member.key()), "unknown key", suggestion(member.key(), known, "keys"));
    value.fail("expected one of the keys " + known_forms);
}

}  // namespace

ObjectDescription read_json_object(const JsonValue& value, const ObjectContext& context) {
    if (!value.json().is_object()) value.fail_expected("an object");
    const Form* chosen = nullptr;
    for (const Form& form : forms) {
        if (!value.json().contains(form.key)) continue;
        if (chosen)
            value.fail(fmt::format("expected one of {}, found both '{}' and '{}'", known_forms, chosen->key, form.key));
        chosen = &form;
    }
    if (!chosen) fail_without_form(value);
    ObjectDescription object;
    object.place = value.place();
    chosen->read(value, context, object);
    return object;
}

}  // namespace cistula
