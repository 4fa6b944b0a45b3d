// Descriptions of scenes, compiled scenes, frames of them, and what their rays meet.
#include <fmt/format.h>

#include <chrono>
#include <deque>
#include <map>
#include <mutex>
#include <optional>

#include "base/timing.h"
#include "image.h"
#include "image/reader/picture_reader.h"
#include "module.h"
#include "render/record/film_picture.h"
#include "render/record/frame_header.h"
#include "render/renderer.h"
#include "render/scene.h"
#include "scene.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/description/camera_path.h"
#include "scene/readers/meshes/mesh_file.h"
#include "scene/readers/read_scene.h"
#include "scene/readers/scene_keys.h"
#include "sequence/backends.h"
#include "sequence/stats.h"

namespace cistula::python {
namespace {

/// The frames of one call, each rendered when it is asked for, on one renderer, which is told of those that are next.
class Frames {
  public:
    Frames(std::shared_ptr<SceneHandle> scene, std::vector<int> frames, const Keywords& keywords)
        : scene_(std::move(scene)),
          request_(request_of(keywords, frame_keys())),
          settings_(frame_settings(request_, scene_->description())),
          frames_(frames.begin(), frames.end()) {
        require_light_layers(request_.channels, *scene_->scene().layer_names());
        for (const int frame : frames) check_frame(frame);
        const std::string turns = camera_turns(scene_->description().camera, frames);
        if (!turns.empty()) warn(turns, 2);
    }

    /// The next frame; none after the last. Throws Error where it cannot be trusted.
    std::unique_ptr<Image> next(const std::optional<nb::callable>& progress) {
        if (frames_.empty()) return nullptr;
        const SceneDescription& description = scene_->description();
        const CameraFrame camera = camera_at(description.camera, frames_.front());
        frames_.pop_front();
        if (announced_ > 0) --announced_;
        auto image = std::make_unique<Image>();
        std::vector<std::string> notes;
        std::string flaws;
        RenderProgress state;
        const double pixels = double(settings_.crop.width) * double(settings_.crop.height);
        const auto work = [&] {
            on_threads(request_.threads, [&] {
                if (!renderer_) renderer_.emplace(scene_, request_.backend, request_.devices);
                Renderer& renderer = **renderer_;
                while (announced_ < std::min(frames_.size(), renderer.frames_ahead()))
                    renderer.expect(camera_at(description.camera, frames_[announced_++]), settings_);
                FrameSettings settings = settings_;
                if (state.stop) return;
                image->seconds = seconds_of([&] { render_frame(renderer, camera, settings, image->film, state); });
                image->times = renderer.times();
                notes = renderer.notes();
                if (!state.stop)
                    flaws = describe_flags(image->film.flags, renderer, description, scene_->scene().precision(),
                                           camera, settings);
            });
        };
        run_interruptibly(state.stop, work, [&] {
            if (progress) (*progress)(std::min(1.0, double(state.pixels_done) / pixels));
        });
        if (!flaws.empty())
            throw Error(ErrorKind::failed,
                        fmt::format("{}: frame {} cannot be trusted: {}", description.source, camera.frame, flaws));
        finish(*image, camera);
        if (progress) (*progress)(1.0);
        add_totals(*image);
        for (const std::string& note : notes) warn(note, 2);
        const std::string depth =
            frames_.empty() ? describe_depth_loss(totals_, description.source, settings_.depth) : "";
        if (!depth.empty()) warn(depth, 2);
        return image;
    }

  private:
    static void check_frame(int frame) {
        if (frame < 0) throw Error(ErrorKind::usage, fmt::format("frame={}: must be 0 or more", frame));
    }

    void finish(Image& image, const CameraFrame& camera) const {
        const SceneDescription& description = scene_->description();
        image.scene = scene_;
        image.settings = settings_;
        image.frame = camera.frame;
        image.picture = channels_of(image.film, request_.channels, &image.clamped);
        image.picture.attributes.merge(header_attributes(image.film, description.film, scene_->scene().hashes(),
                                                         settings_, scene_->scene().precision(), camera));
        set_container_flag(image.picture);
    }

    /// Adds what the depth took from a frame; a target error knows what it misses.
    void add_totals(const Image& image) {
        const Film& film = image.film;
        FrameStats frame;
        frame.frame = image.frame;
        frame.file = scene_->description().source;
        if (!settings_.adaptive())
            frame.depth_loss =
                depth_loss(ledger_totals(film, film.totals.cut), ledger_totals(film, film.totals.radiance));
        totals_.add(frame);
    }

    std::shared_ptr<SceneHandle> scene_;
    RenderRequest request_;
    FrameSettings settings_;
    SequenceTotals totals_;  // of the frames so far
    std::deque<int> frames_;
    size_t announced_ = 0;  // of frames_, from the front
    std::optional<LentRenderer> renderer_;
};

std::shared_ptr<SceneHandle> compile(const std::shared_ptr<SceneDescription>& description, const Keywords& keywords) {
    const RenderRequest request = request_of(keywords, {"precision", "max_texture_gb"});
    auto given = std::make_shared<SceneDescription>(*description);
    if (request.texture_gb > 0) given->texture_bytes = static_cast<uint64_t>(request.texture_gb * 1e9);
    std::shared_ptr<SceneHandle> made;
    std::atomic<bool> stop{false};
    run_interruptibly(
        stop, [&] { made = std::make_shared<SceneHandle>(given, Scene(*given, request.precision, StopSignal(stop))); });
    return made;
}

template <class T>
void set_texels(SceneDescription& description, const std::string& name, const Given<T, -1, -1, -1>& array) {
    for (TextureDescription& texture : description.textures) {
        if (texture.name != name) continue;
        auto texels = std::make_shared<TexelArray>();
        texels->height = static_cast<uint32_t>(array.shape(0));
        texels->width = static_cast<uint32_t>(array.shape(1));
        texels->channels = static_cast<uint32_t>(array.shape(2));
        texels->values = std::vector<T>(array.data(), array.data() + array.size());
        texture.texels = std::move(texels);
        texture.file.clear();
    }
}

void set_mesh(SceneDescription& description, size_t object, const Given<double, -1, 3>& vertices,
              const Given<uint32_t, -1, 3>& triangles, const std::optional<Given<double, -1, 2>>& uvs,
              const std::optional<Given<double, -1, 3>>& normals) {
    auto data = std::make_shared<MeshData>();
    PolygonMesh& mesh = data->groups.emplace_back();
    const auto* const points = reinterpret_cast<const glm::dvec3*>(vertices.data());
    mesh.vertices.assign(points, points + vertices.shape(0));
    mesh.corners.assign(triangles.data(), triangles.data() + triangles.size());
    if (uvs) {
        const auto* const first = reinterpret_cast<const glm::dvec2*>(uvs->data());
        mesh.uvs.assign(first, first + uvs->shape(0));
    }
    if (normals) {
        const auto* const first = reinterpret_cast<const glm::dvec3*>(normals->data());
        mesh.normals.assign(first, first + normals->shape(0));
    }
    auto& shape = std::get<MeshObject>(description.objects.at(object).shape);
    shape.data = std::move(data);
    shape.file.clear();
}

std::span<const glm::dvec3> points_of(const Given<double, -1, 3>& array) {
    return {reinterpret_cast<const glm::dvec3*>(array.data()), array.shape(0)};
}

/// Asks a renderer of the scene about rays.
template <class Ask>
void ask_renderer(const std::shared_ptr<SceneHandle>& scene, const Keywords& keywords, const Ask& ask) {
    const RenderRequest request = request_of(keywords, {"threads", "backend", "device"});
    check_process();
    const WithoutGil free;
    on_threads(request.threads, [&] {
        LentRenderer renderer(scene, request.backend, request.devices);
        ask(*renderer);
    });
}

/// Rows of numbers as an array that owns them.
template <class T, ssize_t columns, class Row>
View<T, -1, columns> owned_rows(std::vector<Row>&& rows) {
    auto* const kept = new std::vector<Row>(std::move(rows));
    const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<Row>*>(p); });
    return View<T, -1, columns>(reinterpret_cast<const T*>(kept->data()), {kept->size(), size_t(columns)}, owner);
}

/// What a scene file would say of a material: its keys with values that are not the default.
nb::dict keys_of(const MaterialDescription& material) {
    nb::dict keys;
    const MaterialDescription standard;
    const auto add = [&keys](const char* key, const auto& value) {
        if constexpr (std::is_same_v<decltype(value), const glm::dvec3&>)
            keys[key] = value == glm::dvec3(value.x) ? nb::cast(value.x) : nb::object(triple(value));
        else
            keys[key] = value;
    };
    material_fields(standard, add);
    const nb::dict defaults(nb::steal<nb::dict>(PyDict_Copy(keys.ptr())));
    material_fields(material, add);
    for (const auto& [key, value] : defaults)
        if (keys[key].equal(value)) nb::del(keys[key]);
    return keys;
}

/// The parts of a mesh file, each with name, vertices, triangles, uvs (v = 0 is the top), normals, keys of its
/// material, map and the material's name, None where there is none; the warnings; the files that were read or looked
/// for.
nb::tuple read_mesh_parts(const std::string& path) {
    MeshData data;
    std::vector<MeshPart> parts;
    {
        const WithoutGil free;
        data = read_mesh(path);
        parts = placed_parts(data, {});
    }
    nb::list all;
    for (MeshPart& part : parts) {
        MeshSource& mesh = part.mesh;
        const nb::object uvs =
            mesh.uvs.empty() ? nb::none() : nb::cast(owned_rows<double, 2>(std::move(mesh.owned_uvs)));
        const nb::object normals =
            mesh.normals.empty() ? nb::none() : nb::cast(owned_rows<double, 3>(std::move(mesh.owned_normals)));
        const nb::object material = part.material ? nb::object(keys_of(*part.material)) : nb::none();
        all.append(nb::make_tuple(part.name, owned_rows<double, 3>(std::move(mesh.owned_vertices)),
                                  owned_rows<uint32_t, 3>(std::move(mesh.owned_triangles)), uvs, normals, material,
                                  part.material ? part.material->map : "", part.material ? part.material->name : ""));
    }
    return nb::make_tuple(all, data.warnings, data.files);
}

/// A vector of what rays meet as an array.
template <class T, ssize_t... more, class Value>
View<T, -1, more...> hits_view(nb::handle self, const std::vector<Value>& values) {
    return {values.data(), {values.size(), static_cast<size_t>(more)...}, self};
}

std::vector<std::string> names_of(const std::vector<SceneNames::Named>& named) {
    std::vector<std::string> names;
    for (const SceneNames::Named& one : named) names.push_back(one.name);
    return names;
}

void bind_descriptions(nb::module_& m) {
    nb::class_<SceneDescription>(m, "Description", "A scene as its author wrote it. Internal.")
        .def_static(
            "read", [](const std::string& path) { return std::make_shared<SceneDescription>(read_scene(path)); },
            "path"_a, nb::call_guard<WithoutGil>())
        .def_static(
            "parse",
            [](const std::string& text, const std::string& source, const std::string& folder) {
                return std::make_shared<SceneDescription>(read_scene_text(text, source, folder));
            },
            "text"_a, "source"_a, "folder"_a, nb::call_guard<WithoutGil>())
        .def_prop_ro("texture_files",
                     [](const SceneDescription& description) {
                         std::vector<std::tuple<std::string, std::string, std::string>> files;
                         for (const TextureDescription& texture : description.textures)
                             if (!texture.file.empty())
                                 files.emplace_back(texture.name, texture.file, texture.colorspace);
                         return files;
                     })
        .def("set_texels", set_texels<uint8_t>, "name"_a, "array"_a.noconvert())
        .def("set_texels", set_texels<uint16_t>, "name"_a, "array"_a.noconvert())
        .def("set_texels", set_texels<float>, "name"_a, "array"_a.noconvert())
        .def("set_mesh", set_mesh, "object"_a, "vertices"_a, "triangles"_a, "uvs"_a.none(), "normals"_a.none());
}

void bind_hits(nb::module_& m) {
    using Self = nb::handle_t<RayHits>;
    const auto hits = [](Self self) -> const RayHits& { return nb::cast<const RayHits&>(self); };
    nb::class_<RayHits>(m, "Hits", nb::is_weak_referenceable(),
                        "What rays meet first, entry i of each array what ray i meets; read-only views.")
        .def("__len__", [](const RayHits& self) { return self.distance.size(); })
        .def_prop_ro(
            "distance", [hits](Self self) { return hits_view<double>(self, hits(self).distance); },
            "From the ray's origin, in scene units: float64, N; infinity: it meets nothing.")
        .def_prop_ro(
            "object", [hits](Self self) { return hits_view<int32_t>(self, hits(self).object); },
            "Number of the object, as in `objects`: int32, N; -1: nothing.")
        .def_prop_ro(
            "material", [hits](Self self) { return hits_view<int32_t>(self, hits(self).material); },
            "Number of the material, as in `materials`: int32, N; -1: nothing.")
        .def_prop_ro(
            "face", [hits](Self self) { return hits_view<int32_t>(self, hits(self).face); },
            "Face of a convex solid, or number of the triangle in its object: int32, N; -1: nothing.")
        .def_prop_ro(
            "crossing",
            [hits](Self self) {
                const std::vector<CrossingKind>& kinds = hits(self).crossing;
                return View<uint32_t, -1>(kinds.data(), {kinds.size()}, self);
            },
            "How the face is met: uint32, N; 0: of a sheet, 1: from outside of a solid, 2: from inside.")
        .def_prop_ro(
            "point", [hits](Self self) { return hits_view<double, 3>(self, hits(self).point); },
            "Where, in scene units: float64, N x 3; zeros: nothing.")
        .def_prop_ro(
            "normal", [hits](Self self) { return hits_view<double, 3>(self, hits(self).normal); },
            "Geometric unit normal toward the origin: float64, N x 3; zeros: nothing.")
        .def_prop_ro(
            "uv", [hits](Self self) { return hits_view<double, 2>(self, hits(self).uv); },
            "Texture coordinates where the material has a texture: float64, N x 2; else zeros.")
        .def_prop_ro(
            "objects", [](const RayHits& self) { return self.names->objects; }, "The names of objects.")
        .def_prop_ro(
            "materials", [](const RayHits& self) { return self.names->materials; }, "The names of materials.");
}

}  // namespace

LentRenderer::LentRenderer(std::shared_ptr<SceneHandle> scene, Backend backend, const DeviceChoice& devices)
    : scene_(std::move(scene)), key_(fmt::format("{} {}", backend_name(backend), devices_text(devices))) {
    {
        const std::lock_guard lock(scene_->mutex_);
        auto& idle = scene_->idle_[key_];
        renderer_ = std::move(idle);
    }
    if (!renderer_) renderer_ = make_renderer(backend, scene_->scene(), choose_devices(backend, devices).options);
}

LentRenderer::~LentRenderer() {
    if (!renderer_) return;
    const std::lock_guard lock(scene_->mutex_);
    std::swap(scene_->idle_[key_], renderer_);
}

void bind_scene(nb::module_& m) {
    m.def("read_mesh", read_mesh_parts, "path"_a,
          nb::sig("def read_mesh(path: str) -> tuple[list[typing.Any], list[str], list[str]]"),
          "Reads a PLY or an OBJ. Internal.");
    bind_descriptions(m);
    bind_hits(m);
    nb::class_<Frames>(m, "Frames", "Frames that render when they are asked for. Internal.")
        .def(nb::init<std::shared_ptr<SceneHandle>, std::vector<int>, const Keywords&>(), "scene"_a, "frames"_a,
             "keywords"_a)
        .def("next", &Frames::next, "progress"_a.none(),
             nb::sig("def next(self, progress: collections.abc.Callable[[float], object] | None) -> Image | None"));
    nb::class_<SceneHandle>(m, "CompiledScene", nb::is_weak_referenceable(), "A compiled scene. Internal.")
        .def(nb::new_(&compile), "description"_a, "keywords"_a)
        .def_prop_ro("source", [](const SceneHandle& s) { return s.description().source; })
        .def_prop_ro("objects", [](const SceneHandle& s) { return names_of(s.scene().names().solids); })
        .def_prop_ro("materials", [](const SceneHandle& s) { return names_of(s.scene().names().materials); })
        .def_prop_ro("lights", [](const SceneHandle& s) { return names_of(s.scene().names().lights); })
        .def_prop_ro("warnings",
                     [](const SceneHandle& s) {
                         std::vector<std::string> all = s.scene().warnings();
                         if (!s.scene().precision_note().empty()) all.insert(all.begin(), s.scene().precision_note());
                         return all;
                     })
        .def_prop_ro("precision",
                     [](const SceneHandle& s) { return std::string(precision_name(s.scene().precision())); })
        .def_prop_ro("frames", [](const SceneHandle& s) { return s.description().film.frames; })
        .def_prop_ro(
            "size",
            [](const SceneHandle& s) { return std::pair(s.description().film.width, s.description().film.height); })
        .def(
            "hash", [](const SceneHandle& s, int frame) { return s.scene().hashes().of(frame); }, "frame"_a)
        .def("effects", [](const SceneHandle& s) { return names_of_effects(s.scene().effects()); })
        .def(
            "intersect",
            [](const std::shared_ptr<SceneHandle>& scene, const Given<double, -1, 3>& origins,
               const Given<double, -1, 3>& directions, const Keywords& keywords) {
                auto hits = std::make_unique<RayHits>();
                ask_renderer(scene, keywords, [&](Renderer& renderer) {
                    *hits = renderer.intersect(points_of(origins), points_of(directions));
                });
                return hits;
            },
            "origins"_a, "directions"_a, "keywords"_a)
        .def(
            "transmittance",
            [](const std::shared_ptr<SceneHandle>& scene, const Given<double, -1, 3>& from,
               const Given<double, -1, 3>& to, const Keywords& keywords) {
                std::vector<glm::dvec3> shares;
                ask_renderer(scene, keywords, [&](Renderer& renderer) {
                    shares = renderer.transmittance(points_of(from), points_of(to));
                });
                return owned_rows<double, 3>(std::move(shares));
            },
            "origins"_a, "targets"_a, "keywords"_a);
}

}  // namespace cistula::python
