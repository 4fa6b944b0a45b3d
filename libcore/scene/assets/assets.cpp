#include "scene/assets/assets.h"

#include <filesystem>
#include <map>
#include <span>
#include <tuple>

#include <fmt/format.h>

#include "base/default_rounding.h"
#include "cistula/numerics/vec.h"
#include "image/reader/picture_reader.h"
#include "scene/readers/meshes/mesh_file.h"

namespace cistula {
namespace {

using glm::dvec3;

/// What `read` returns; its errors get the place.
template <class Read>
auto at_place(const SceneDescription& scene, const std::string& place, const Read& read) {
    try {
        return read();
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::interrupted) throw;
        throw error.at(place_in(scene, place));
    }
}

/// Throws unless a list of triangles, three corners each, is one.
void check_triangles(size_t vertices, std::span<const uint32_t> corners, std::span<const glm::dvec2> uvs,
                     size_t normals) {
    const auto refuse = [](const std::string& problem, const char* remedy = "") {
        throw Error(ErrorKind::scene, problem, remedy);
    };
    if (corners.empty()) refuse("there are no triangles", "give at least one");
    for (const uint32_t corner : corners)
        if (corner >= vertices)
            refuse("a triangle names vertex " + std::to_string(corner) + ", but there are only " +
                   std::to_string(vertices) + " (numbered from 0)");
    const auto check_count = [&](size_t count, const char* what) {
        if (count != 0 && count != vertices)
            refuse("there are " + std::to_string(count) + what + std::to_string(vertices) + " vertices",
                   "give one a vertex, or none");
    };
    check_count(uvs.size(), " uvs for ");
    check_count(normals, " normals for ");
    for (const glm::dvec2& uv : uvs)
        if (!is_finite(uv.x) || !is_finite(uv.y)) refuse("a uv is not finite");
}

void check_mesh(const MeshData& mesh) {
    const auto refuse = [](const std::string& problem, const char* remedy = "") {
        throw Error(ErrorKind::scene, "the mesh " + problem, remedy);
    };
    if (mesh.groups.empty()) refuse("has no groups", "give at least one");
    for (const PolygonMesh& group : mesh.groups) {
        if (!group.corner_uvs.empty()) refuse("has uvs by corners", "give one a vertex, or none");
        size_t end = 0;
        for (const size_t next : group.ends) {
            if (next < end || next > group.corners.size()) refuse("has polygons that end before they begin");
            end = next;
        }
        if (group.ends.empty() ? group.corners.size() % 3 != 0 : end != group.corners.size())
            refuse("has corners beyond its last polygon");
        if (!group.corners.empty())
            check_triangles(group.vertices.size(), group.corners, group.uvs, group.normals.size());
    }
}

ColorPicture checker_picture(const TextureDescription& texture) {
    for (const dvec3& color : texture.checker)
        if (!is_finite(glm::vec3(color)) || color.x < 0 || color.y < 0 || color.z < 0)
            throw Error(ErrorKind::scene, "a color is negative or not finite");
    const glm::vec3 a(texture.checker[0]), b(texture.checker[1]);
    return {2, 2, {a, b, b, a}};
}

class AssetLoader {
  public:
    AssetLoader(const SceneDescription& scene, StopSignal stop)
        : scene_(scene), stop_(stop), reader_(limits_of(scene)) {}

    SceneAssets load() {
        for (const TextureDescription& texture : scene_.textures)
            if (!texture.file.empty()) assets_.files.push_back(texture.file);
        for (const ObjectDescription& object : scene_.objects)
            assets_.meshes.push_back(at_place(scene_, object.place, [&] { return mesh_of(object); }));
        assets_.pictures.resize(scene_.textures.size());
        for (const ObjectDescription& object : scene_.objects)
            if (object.material >= 0 && object.material < static_cast<int>(scene_.materials.size()))
                load_texture(scene_.materials[static_cast<size_t>(object.material)].texture);
        if (scene_.sky) load_texture(scene_.sky->texture);
        if (scene_.sky) check_sky(scene_.sky->texture);
        return std::move(assets_);
    }

  private:
    static TextureLimits limits_of(const SceneDescription& scene) {
        TextureLimits limits;
        limits.bytes = scene.texture_bytes.value_or(limits.bytes);
        return limits;
    }

    std::shared_ptr<const MeshData> mesh_of(const ObjectDescription& object) {
        if (const auto* list = std::get_if<TrianglesObject>(&object.shape)) {
            std::span<const uint32_t> corners;
            if (!list->triangles.empty()) corners = {list->triangles.front().data(), 3 * list->triangles.size()};
            check_triangles(list->vertices.size(), corners, list->uvs, list->normals.size());
        }
        const auto* mesh = std::get_if<MeshObject>(&object.shape);
        if (!mesh) return nullptr;
        std::shared_ptr<const MeshData> data = mesh->data;
        if (data) {
            check_mesh(*data);
            return data;
        }
        std::shared_ptr<const MeshData>& read = meshes_[std::filesystem::path(mesh->file).lexically_normal()];
        if (!read) {
            stop_.check();
            read = std::make_shared<const MeshData>(read_mesh(mesh->file, stop_));
            check_mesh(*read);
            assets_.files.insert(assets_.files.end(), read->files.begin(), read->files.end());
        }
        return read;
    }

    /// Reads a texture that is used, unless it was read before.
    void load_texture(int number) {
        if (number < 0 || number >= static_cast<int>(scene_.textures.size())) return;
        const auto index = static_cast<size_t>(number);
        const TextureDescription& texture = scene_.textures[index];
        if (assets_.pictures[index]) return;
        const std::string place = texture.place.empty() ? "/textures/" + std::to_string(number) : texture.place;
        assets_.pictures[index] = at_place(scene_, place, [&] { return picture_of(texture, place); });
    }

    /// Throws unless a sky's picture has the shape of all directions.
    void check_sky(int number) const {
        if (number < 0 || number >= static_cast<int>(scene_.textures.size())) return;
        const auto index = static_cast<size_t>(number);
        const ColorPicture& picture = *assets_.pictures[index];
        if (picture.width == 2 * picture.height) return;
        const std::string& file = scene_.textures[index].file;
        throw Error(ErrorKind::file, fmt::format("the sky is {}x{}", picture.width, picture.height),
                    "give a picture of all directions, twice as wide as high")
            .at(file.empty() ? "the texels" : file)
            .at(place_in(scene_, "/background"));
    }

    std::shared_ptr<const ColorPicture> picture_of(const TextureDescription& texture, const std::string& place) {
        if (!is_finite(texture.repeat.x) || !is_finite(texture.repeat.y))
            throw Error(ErrorKind::scene, "the repeat must be finite");
        if (texture.is_checker()) return std::make_shared<const ColorPicture>(checker_picture(texture));
        std::shared_ptr<const ColorPicture>& read =
            pictures_[{texture.file, texture.texels.get(), texture.colorspace, texture.strict}];
        if (read) return read;
        stop_.check();
        ClampedTexels found;
        ClampedTexels* clamped = texture.strict ? nullptr : &found;
        read = std::make_shared<const ColorPicture>(texture.texels
                                                        ? reader_.decode(*texture.texels, clamped, texture.colorspace)
                                                        : reader_.read(texture.file, clamped, texture.colorspace));
        const std::string name = texture.texels ? "" : texture.file + ": ";
        if (found.count() > 0) assets_.warnings.push_back(scene_error(scene_, place, name + found.warning()).what());
        if (const auto& [r, g, b] = read->divided_by; r != 1 || g != 1 || b != 1)
            assets_.warnings.push_back(
                scene_error(scene_, place,
                            name + fmt::format("its header says that its numbers were multiplied (EXPOSURE, "
                                               "COLORCORR): they are divided by {:.9g}{}",
                                               r, r == g && g == b ? "" : fmt::format(", {:.9g}, {:.9g}", g, b)))
                    .what());
        return read;
    }

    const SceneDescription& scene_;
    const StopSignal stop_;
    TextureReader reader_;
    SceneAssets assets_;
    std::map<std::string, std::shared_ptr<const MeshData>> meshes_;  // by file
    std::map<std::tuple<std::string, const TexelArray*, std::string, bool>, std::shared_ptr<const ColorPicture>>
        pictures_;
};

}  // namespace

SceneAssets load_assets(const SceneDescription& scene, StopSignal stop) {
    return in_default_rounding([&] { return AssetLoader(scene, stop).load(); });
}

std::string place_in(const SceneDescription& description, const std::string& place) {
    return (description.source.empty() ? "scene" : description.source) + (place.empty() ? "" : ": " + place);
}

Error scene_error(const SceneDescription& description, const std::string& place, const std::string& problem,
                  const std::string& remedy) {
    return Error(ErrorKind::scene, problem, remedy).at(place_in(description, place));
}

}  // namespace cistula
