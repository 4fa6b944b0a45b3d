#include "scene/readers/mesh_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "scene/base/file_bytes.h"
#include "scene/base/suggest.h"
#include "scene/description/rotation.h"
#include "scene/readers/doubled_polygons.h"
#include "scene/readers/polygon.h"

namespace cistula {
namespace {

using glm::dvec3;

[[noreturn]] void refuse(const std::string& place, const std::string& file, const std::string& what) {
    throw Error(ExitCode::file, place + ": mesh " + file + ": " + what);
}

/// Throws for a PLY header with an unknown line or without an end, for which Assimp 5.2 never returns.
void check_ply_header(const std::string& place, const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        const bool first = number == 1;
        if (!first && word == "end_header") return;
        const bool known = first ? word == "ply"
                                 : word.empty() || word == "format" || word == "comment" || word == "obj_info" ||
                                       word == "element" || word == "property";
        if (!known)
            refuse(place, file,
                   "cannot be read: line " + std::to_string(number) +
                       " of its header is not PLY; it must be \"ply\", " +
                       "then format, comment, element, property and end_header lines");
    }
    refuse(place, file, "cannot be read: its header has no end_header line");
}

dvec3 color_of(const aiColor3D& c) {
    return {c.r, c.g, c.b};
}

/// A material from an OBJ's library, mapped as docs/meshes.md says.
MaterialDescription material_of(const aiMaterial& from) {
    MaterialDescription m;
    aiString name;
    if (from.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) m.name = name.C_Str();
    aiColor3D kd, ks;
    float value = 0;
    int illum = 2;
    if (from.Get(AI_MATKEY_COLOR_DIFFUSE, kd) == AI_SUCCESS) m.color = color_of(kd);
    if (from.Get(AI_MATKEY_SHININESS, value) == AI_SUCCESS) m.exponent = value;
    if (from.Get(AI_MATKEY_REFRACTI, value) == AI_SUCCESS && value > 0) m.index = value;
    if (from.Get(AI_MATKEY_OPACITY, value) == AI_SUCCESS) m.transmission = 1 - static_cast<double>(value);
    from.Get("$mat.illum", 0, 0, illum);

    const bool shines = from.Get(AI_MATKEY_COLOR_SPECULAR, ks) == AI_SUCCESS && illum >= 2;
    const dvec3 specular = shines ? color_of(ks) : dvec3{0};
    const double strongest = specular.x > specular.y ? (specular.x > specular.z ? specular.x : specular.z)
                                                     : (specular.y > specular.z ? specular.y : specular.z);
    if (strongest > 0) {
        m.specular = strongest;
        m.specular_color = specular / strongest;
    }
    if (illum == 0) {  // constant color, independent of the lights
        m.diffuse = 0;
        m.specular = 0;
    }
    const bool reflects = illum >= 3 && illum <= 9;
    if (reflects) m.reflection = strongest < 1 ? strongest : 1;
    m.fresnel = illum == 5 || illum == 7;
    if (m.transmission > 0) m.tint = m.color;
    for (int c = 0; c < 3; ++c) m.tint[c] = m.tint[c] > 1 ? 1 : m.tint[c];
    // d (opacity) takes precedence: transmitted light cannot be reflected as well.
    if (m.reflection + m.transmission > 1) m.reflection = 1 - m.transmission;
    return m;
}

MeshPart part_of(const aiMesh& from, const MeshObject& object) {
    MeshPart part;
    part.name = from.mName.C_Str();
    const Rotation rotation(object.rotation);
    MeshSource& mesh = part.mesh;
    mesh.owned_vertices.reserve(from.mNumVertices);
    for (unsigned i = 0; i < from.mNumVertices; ++i) {
        const aiVector3D& p = from.mVertices[i];
        mesh.owned_vertices.push_back(object.center + rotation(object.scale * dvec3{p.x, p.y, p.z}));
    }
    std::vector<std::span<const uint32_t>> polygons;
    polygons.reserve(from.mNumFaces);
    for (unsigned i = 0; i < from.mNumFaces; ++i) {
        const std::span<const uint32_t> polygon(from.mFaces[i].mIndices, from.mFaces[i].mNumIndices);
        if (std::all_of(polygon.begin(), polygon.end(),
                        [&from](uint32_t corner) { return corner < from.mNumVertices; }))
            polygons.push_back(polygon);
    }
    const std::vector<bool> doubled = doubled_polygons(mesh.owned_vertices, polygons);
    mesh.owned_triangles.reserve(polygons.size());
    for (size_t i = 0; i < polygons.size(); ++i) {
        if (doubled[i])
            ++mesh.doubled_polygons;
        else
            append_polygon(mesh.owned_vertices, {polygons[i].begin(), polygons[i].end()}, mesh.owned_triangles);
    }
    if (from.HasTextureCoords(0)) {
        mesh.owned_uvs.reserve(from.mNumVertices);
        // Files have v = 0 at the bottom of the picture, Cistula at the top.
        for (unsigned i = 0; i < from.mNumVertices; ++i)
            mesh.owned_uvs.push_back({from.mTextureCoords[0][i].x, 1.0 - from.mTextureCoords[0][i].y});
    }
    mesh.view_owned();
    return part;
}

}  // namespace

std::vector<MeshPart> read_mesh(const MeshObject& object, const std::string& place) {
    const std::string kind = lower_extension(object.file);
    if (kind != ".ply" && kind != ".obj") refuse(place, object.file, "must be a .ply or an .obj file");
    std::error_code error;
    if (!std::filesystem::is_regular_file(object.file, error))
        refuse(place, object.file, "cannot be read: there is no such file; check the path");

    if (kind == ".ply") check_ply_header(place, object.file);

    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                            aiComponent_COLORS | aiComponent_BONEWEIGHTS);
    // Not aiProcess_Triangulate: Debian's build of it crashes on some broken files. Not
    // aiProcess_JoinIdenticalVertices: it joins vertices up to 1e-5 apart; find_topology joins equal ones.
    const aiScene* scene = importer.ReadFile(object.file, aiProcess_RemoveComponent);
    if (!scene) refuse(place, object.file, "cannot be read: " + one_line(importer.GetErrorString()));

    std::vector<MeshPart> parts;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
        const aiMesh& mesh = *scene->mMeshes[i];
        MeshPart part = part_of(mesh, object);
        if (part.mesh.triangles.empty()) continue;  // points or lines
        // Assimp invents a material where there is none; only those of an OBJ's library have names of their own.
        if (kind == ".obj" && mesh.mMaterialIndex < scene->mNumMaterials) {
            MaterialDescription material = material_of(*scene->mMaterials[mesh.mMaterialIndex]);
            if (material.name != AI_DEFAULT_MATERIAL_NAME) part.material = std::move(material);
        }
        if (part.name.empty()) part.name = part.material ? part.material->name : std::to_string(i);
        parts.push_back(std::move(part));
    }
    if (parts.empty()) refuse(place, object.file, "has no faces; give a file with polygons");
    return parts;
}

}  // namespace cistula
