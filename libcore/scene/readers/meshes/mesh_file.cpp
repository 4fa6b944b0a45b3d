#include "scene/readers/meshes/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/file_bytes.h"
#include "cistula/numerics/vec.h"
#include "scene/description/rotation.h"
#include "scene/readers/meshes/mesh_formats.h"
#include "scene/readers/meshes/mesh_text.h"
#include "scene/readers/meshes/polygon.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr size_t mesh_start_bytes = 4096;  // that tell what a file is, before the rest is read

/// The bytes of an OBJ or an MTL file. Throws if they do not begin as text does.
std::string text_bytes(const std::string& path, const std::string& label) {
    if (utf8_of(read_file_start(path, mesh_start_bytes)).find('\0') != std::string::npos)
        throw Error(ErrorKind::file, "is no text, as OBJ and MTL files are: a zero byte is among its first").at(label);
    return read_file(path);
}

std::string ply_bytes(const std::string& path, const std::string& label) {
    check_ply_start(utf8_of(read_file_start(path, mesh_start_bytes)), label);
    return read_file(path);
}

/// What lies beside an OBJ, and how it is named in messages. Adds the files that it names to `files`.
ObjSurroundings surroundings_of(const std::string& file, std::vector<std::string>& files) {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    const auto path_of = [folder](std::string name) {
        std::error_code error;
        const bool is_whole = std::filesystem::is_regular_file(folder / name, error);  // with a backslash in its name
        if (!is_whole) std::replace(name.begin(), name.end(), '\\', '/');
        return (folder / name).string();
    };
    ObjSurroundings around;
    around.has = [path_of, &files](const std::string& name) {
        files.push_back(path_of(name));
        std::error_code error;
        return std::filesystem::is_regular_file(path_of(name), error);
    };
    around.label = [path_of](const std::string& name) { return "mesh " + path_of(name); };
    around.bytes = [path_of, label = around.label](const std::string& name) {
        return text_bytes(path_of(name), label(name));
    };
    around.default_library = std::filesystem::path(file).stem().string() + ".mtl";
    return around;
}

/// The rounding of a mesh's vertices once they are placed: that of the file's numbers, and of the numbers that place
/// it.
CoordinateRounding placed_rounding(std::span<const dvec3> vertices, const MeshObject& object) {
    CoordinateRounding rounding = coordinate_rounding(vertices);
    double reach = 0;
    for (const dvec3& p : vertices)
        if (is_finite(p)) reach = std::max(reach, length(p));
    const Rotation rotation(object.rotation);
    dvec3 placed(0);
    for (int axis = 0; axis < 3; ++axis) {
        dvec3 along(0);
        along[axis] = object.scale * rounding.half_unit[axis];
        const dvec3 turned = rotation(along);
        placed += dvec3(std::abs(turned.x), std::abs(turned.y), std::abs(turned.z));
    }
    double angle = 0;  // degrees
    for (int axis = 0; axis < 3; ++axis)
        if (object.rotation[axis] != std::round(object.rotation[axis])) angle += half_unit_of(object.rotation[axis]);
    const double of_size =
        half_unit_of(object.scale) * reach + angle * 0.0174532925199433 * std::abs(object.scale) * reach;
    for (int axis = 0; axis < 3; ++axis)
        rounding.half_unit[axis] = placed[axis] + half_unit_of(object.center[axis]) + of_size;
    return rounding;
}

MeshPart part_of(const PolygonMesh& from, const MeshObject& object) {
    MeshPart part;
    part.name = from.name;
    part.material = from.material;
    MeshSource& mesh = part.mesh;
    mesh.rounding = placed_rounding(from.vertices, object);
    const Rotation rotation(object.rotation);
    mesh.owned_vertices.reserve(from.vertices.size());
    for (const dvec3& p : from.vertices) mesh.owned_vertices.push_back(object.center + rotation(object.scale * p));
    const std::vector<bool> doubled = doubled_polygons(mesh.owned_vertices, from);
    mesh.owned_triangles.reserve(from.size());
    for (size_t i = 0; i < from.size(); ++i) {
        if (doubled[i])
            ++mesh.doubled_polygons;
        else
            append_polygon(mesh.owned_vertices, from.polygon(i), mesh.owned_triangles);
    }
    mesh.owned_uvs = from.uvs;
    for (const dvec3& n : from.normals) mesh.owned_normals.push_back(rotation(n));
    mesh.view_owned();
    return part;
}

/// Gives each corner a vertex of its own where texture coordinates belong to corners.
void part_corners(PolygonMesh& mesh) {
    if (mesh.corner_uvs.empty()) return;
    mesh.corner_uvs.resize(mesh.corners.size());
    std::vector<dvec3> vertices, normals;
    vertices.reserve(mesh.corners.size());
    for (uint32_t& corner : mesh.corners) {
        vertices.push_back(mesh.vertices[corner]);
        if (!mesh.normals.empty()) normals.push_back(mesh.normals[corner]);
        corner = static_cast<uint32_t>(vertices.size() - 1);
    }
    mesh.vertices = std::move(vertices);
    mesh.normals = std::move(normals);
    mesh.uvs = std::exchange(mesh.corner_uvs, {});
}

bool has_faces(const PolygonMesh& group) {
    for (size_t i = 0; i < group.size(); ++i)
        if (group.polygon(i).size() > 2) return true;
    return false;
}

}  // namespace

MeshData mesh_data(std::vector<PolygonMesh> groups) {
    MeshData data;
    data.groups = std::move(groups);
    for (PolygonMesh& group : data.groups) {
        part_corners(group);
        for (glm::dvec2& uv : group.uvs) uv.y = 1.0 - uv.y;
    }
    return data;
}

MeshData read_mesh(const std::string& file, StopSignal stop) {
    const std::string kind = lower_extension(file);
    const std::string label = "mesh " + file;
    if (kind != ".ply" && kind != ".obj") throw Error(ErrorKind::file, "", "must be a .ply or an .obj file").at(label);
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw Error(ErrorKind::file, "cannot be read: there is no such file", "check the path").at(label);

    std::vector<PolygonMesh> groups;
    std::vector<std::string> warnings, files = {file};
    {
        const bool is_obj = kind == ".obj";
        const std::string bytes = utf8_of(is_obj ? text_bytes(file, label) : ply_bytes(file, label));
        if (is_obj)
            groups = read_obj(bytes, label, surroundings_of(file, files), warnings, stop);
        else
            groups.push_back(read_ply(bytes, label, warnings, stop));
    }
    if (std::none_of(groups.begin(), groups.end(), has_faces))
        throw Error(ErrorKind::file, "has no faces", "give a file with polygons").at(label);
    MeshData data = mesh_data(std::move(groups));
    data.warnings = std::move(warnings);
    data.files = std::move(files);
    return data;
}

std::vector<MeshPart> placed_parts(const MeshData& data, const MeshObject& object) {
    std::vector<MeshPart> parts;
    for (const PolygonMesh& group : data.groups) {
        MeshPart part = part_of(group, object);
        if (part.mesh.triangles.empty()) continue;
        if (part.name.empty()) part.name = std::to_string(parts.size());
        parts.push_back(std::move(part));
    }
    return parts;
}

}  // namespace cistula
