#include "render/explorer/explorer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <libdeflate.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/file_bytes.h"
#include "cistula/numerics/vec.h"
#include "image/picture/picture_io.h"
#include "render/pixel_report.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"

namespace cistula {
namespace {

using Json = nlohmann::ordered_json;

std::string color_json(const glm::dvec3& c) {
    const std::string parts[] = {fmt::format("{:.3g}", c.x), fmt::format("{:.3g}", c.y), fmt::format("{:.3g}", c.z)};
    return parts[0] == parts[1] && parts[1] == parts[2] ? parts[0] : fmt::format("[{}]", fmt::join(parts, ","));
}

std::string lights_json(const PixelSurface& s, const Film& film) {
    std::vector<std::string> list;
    int shadows = 0;  // of which four are told
    for (const LightContribution& light : s.lights)
        if (light.adds != FixedColor{} || (light.fate == LightFate::shadow && ++shadows <= 4))
            list.push_back(fmt::format("[{},{},[{}]]", light.light, color_json(radiance_of(light.adds, film)),
                                       fmt::join(light.through, ",")));
    return fmt::format("[{}]", fmt::join(list, ","));
}

std::string surface(const PixelSurface& s) {
    return fmt::format("[{},{},{:.3g},{:.3g},{:.3g},{},{:.4g},{:.4g},{:.3g}]", static_cast<int>(s.crossing), s.material,
                       degrees_of(s.cosine), s.local, s.mirrored, color_json(s.through), s.index_before, s.index_beyond,
                       s.total   ? -1.0
                       : s.bends ? degrees_of(s.bent_cosine)
                                 : 0.0);
}

std::string ray(const PixelBranch& b, int parent, const Film& film, const glm::dvec3& eye) {
    const bool met = b.end == BranchEnd::surface;
    std::string text =
        fmt::format("[{},{},{},{},{},{},{}", parent, static_cast<int>(b.kind), static_cast<int>(b.end),
                    color_json(b.weight), color_json(radiance_of(met ? b.surface.ambient_adds : b.adds, film)),
                    color_json(radiance_of(b.ledger, film)), met ? lights_json(b.surface, film) : "[]");
    if (b.end <= BranchEnd::background) {
        const glm::dvec3 at = b.end == BranchEnd::background ? b.direction : b.origin + b.direction * b.distance - eye;
        text += fmt::format(",[{:.4g},{:.4g},{:.4g}]", at.x, at.y, at.z);
    }
    if (b.end == BranchEnd::light) text += fmt::format(",{}", b.visible_light);
    if (met) text += fmt::format(",{},{}", b.surface.solid, surface(b.surface));
    return text + "]";
}

Json point_json(const glm::dvec3& p) {
    return Json::parse(fmt::format("[{:.6g},{:.6g},{:.6g}]", p.x, p.y, p.z));
}

Json names(const std::vector<SceneNames::Named>& named) {
    Json list = Json::array();
    for (const SceneNames::Named& one : named) list.push_back(one.name);
    return list;
}

/// Bytes as base64 of a zlib stream.
std::string packed(const std::string& bytes) {
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(9), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::string out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
    out.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
    return base64(out);
}

Vec3<double> normal_of(const MeshSource& mesh, uint32_t triangle) {
    const TriangleCorners& c = mesh.triangles[triangle];
    const auto at = [&](size_t corner) { return Vec3<double>(mesh.vertices[c[corner]]); };
    return cross(at(1) - at(0), at(2) - at(0));
}

/// Whether the triangles of two half-edges turn by less than a thousandth where they meet.
bool in_one_plane(const MeshSource& mesh, uint32_t half, uint32_t other) {
    const Vec3<double> a = normal_of(mesh, half / 3);
    const Vec3<double> b = normal_of(mesh, other / 3);
    const Vec3<double> turn = cross(a, b);
    return dot(a, b) > 0 && dot(turn, turn) <= 1e-6 * dot(a, a) * dot(b, b);
}

/// The half-edges of a mesh that stand for its edges: alone, or with a later one along the same edge.
std::vector<uint32_t> drawn_halves(const MeshSource& mesh, const std::vector<uint32_t>& next) {
    std::vector<uint32_t> drawn;
    for (uint32_t half = 0; half < next.size(); ++half)
        if (next[half] == half || (next[half] > half && !in_one_plane(mesh, half, next[half]))) drawn.push_back(half);
    return drawn;
}

/// Adds a circle as 24 edges. `normal`: across it.
void add_circle(const glm::dvec3& center, const glm::dvec3& normal, double radius, Wireframe& wires) {
    constexpr int count = 24;
    int least = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(normal[axis]) < std::abs(normal[least])) least = axis;
    glm::dvec3 other(0);
    other[least] = 1;
    const glm::dvec3 along = radius * normalized(cross(normal, other));
    const glm::dvec3 across = cross(normalized(normal), along);
    const auto at = [&](int i) {
        const double angle = 2 * std::numbers::pi * i / count;
        return center + std::cos(angle) * along + std::sin(angle) * across;
    };
    for (int i = 0; i < count; ++i) wires.push_back({at(i), at(i + 1)});
}

}  // namespace

std::vector<Wireframe> wireframes(const SceneSource& source, size_t most) {
    std::vector<Wireframe> all;
    for (const SourceSolid& solid : source.solids) {
        Wireframe& wires = all.emplace_back();
        if (solid.polyhedron) {
            const std::vector<glm::dvec3> vertices = world_vertices(*solid.polyhedron);
            for (const auto& [ends, faces] : polyhedron_of(*solid.polyhedron).edges)
                wires.push_back({vertices[ends[0]], vertices[ends[1]]});
            continue;
        }
        if (solid.sphere) {
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 normal(0);
                normal[axis] = 1;
                add_circle(solid.sphere->center, normal, solid.sphere->radius, wires);
            }
            continue;
        }
        if (solid.disk) {
            if (!solid.disk->is_endless())
                add_circle(solid.disk->center, solid.disk->normal, solid.disk->radius, wires);
            continue;
        }
        const MeshSource& mesh = solid.mesh;
        const std::vector<uint32_t> drawn = drawn_halves(mesh, link_edges(mesh).next);
        for (size_t i = 0; i < drawn.size(); i += drawn.size() / (most + 1) + 1) {
            const TriangleCorners& corners = mesh.triangles[drawn[i] / 3];
            wires.push_back({mesh.vertices[corners[drawn[i] % 3]], mesh.vertices[corners[(drawn[i] + 1) % 3]]});
        }
    }
    return all;
}

Explorer::Explorer(const Scene& scene, const CameraFrame& camera, const FrameSettings& settings)
    : scene_(scene), camera_(camera), settings_(settings) {
    settings_.cutoff = settings.truncation();
    settings_.target_error = 0;
    settings_.supersample = 1;
    settings_.layers = {};
}

std::string Explorer::start(const std::string& source, const std::vector<Wireframe>& bodies, const Film& film) const {
    const Camera& camera = camera_.camera;
    const SceneNames& known = scene_.names();
    Json json = {{"scene", source},
                 {"hash", scene_.hashes().of(camera_.frame)},
                 {"version", CISTULA_VERSION},
                 {"precision", precision_name(scene_.precision())},
                 {"frame", camera_.frame},
                 {"size", {settings_.full_width, settings_.full_height}},
                 {"samples", film.samples},
                 {"depth", settings_.depth},
                 {"cutoff", settings_.cutoff},
                 {"axes", {point_json(camera.right), point_json(camera.up), point_json(camera.forward)}},
                 {"tan_half_width", camera.tan_half_width},
                 {"objects", names(known.solids)},
                 {"materials", names(known.materials)},
                 {"lights", Json::array()},
                 {"visible", Json::array()},
                 {"bodies", Json::array()},
                 {"picture", base64(encode_png(to_color(film)))}};
    for (const Wireframe& wires : bodies) {
        Json& body = json["bodies"].emplace_back(Json::array());
        for (const auto& [from, to] : wires)
            body.push_back({point_json(from - camera.position), point_json(to - camera.position)});
    }
    scene_.visit([&](const auto& scene) {
        const auto add = [&](const char* list, const SceneNames::Named& named, const auto& at) {
            const glm::dvec3 world = glm::dvec3(at) * std::ldexp(1.0, -scene->scale) + scene->center;
            json[list].push_back(
                {{"name", named.name}, {"place", named.place}, {"at", point_json(world - camera.position)}});
        };
        for (size_t i = 0; i < known.lights.size(); ++i) add("lights", known.lights[i], scene->lights[i].position);
        for (size_t i = 0; i < known.visible_lights.size(); ++i)
            add("visible", known.visible_lights[i], scene->visible_lights[i].center);
        json["bound"] = point_json(glm::dvec3(scene->bound) * std::ldexp(1.0, scene->radiance_exponent));
    });
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (size_t at = 0; (at = text.find('<', at)) != text.npos;) text.replace(at, 1, "\\u003c");  // no </script> in it
    return text;
}

std::string Explorer::pixel(Renderer& renderer, int x, int y, StopSignal stop) const {
    PixelTreeLimits limits;
    limits.stop = stop;
    const PixelTree tree = renderer.pixel_tree(camera_, settings_, x, y, limits);
    const std::vector<PixelBranch>& branches = tree.samples.front().branches;
    std::vector<int> parents(branches.size(), -1);
    std::string text;
    for (size_t i = 0; i < branches.size(); ++i) {
        for (const uint32_t child : branches[i].children) parents[child] = static_cast<int>(i);
        text += i == 0 ? "[" : ",";
        text += ray(branches[i], parents[i], tree.film, camera_.camera.position);
    }
    return text + "]";
}

Explorer::Page Explorer::page(const std::string& start, double megabytes,
                              const std::function<std::unique_ptr<Renderer>()>& make, StopSignal stop) const {
    const int width = settings_.full_width;
    const int height = settings_.full_height;
    const double room = megabytes * 1e6 - static_cast<double>(start.size() + explorer_page.size());
    const int coarsest = std::max(1, std::min(width, height) / 8);
    tbb::enumerable_thread_specific<std::unique_ptr<Renderer>> renderers(make);
    int step = coarsest;
    for (int pass = 1;; ++pass) {
        std::vector<std::string> rows(static_cast<size_t>((height - 1) / step + 1));
        std::atomic<bool> failed{false};
        std::exception_ptr failure;  // TBB 2021.8 dies by a signal if one passes its loop here
        const auto fill = [&](size_t row) {
            const int y = std::min(static_cast<int>(row) * step + step / 2, height - 1);
            std::string list;
            for (int left = 0; left < width && !failed; left += step) {
                stop.check();
                list += left == 0 ? "[" : ",";
                list += pixel(*renderers.local(), std::min(left + step / 2, width - 1), y, stop);
            }
            rows[row] = packed(list + "]");
        };
        tbb::parallel_for(size_t{0}, rows.size(), [&](size_t row) {
            tbb::this_task_arena::isolate([&] {  // from other rows, which would use the same renderer
                try {
                    fill(row);
                } catch (...) {
                    if (!failed.exchange(true)) failure = std::current_exception();
                }
            });
        });
        if (failure) std::rethrow_exception(failure);
        const std::string data = fmt::format(R"(,"step":{},"rows":["{}"]}})", step, fmt::join(rows, R"(",")"));
        const auto bytes = static_cast<double>(data.size());
        const bool fits = bytes <= room;
        if (!fits && step == coarsest)
            throw Error(ErrorKind::usage,
                        fmt::format("`explore_mb` {}: the picture and the coarsest grid of pixels take {:.1f}",
                                    megabytes, megabytes + (bytes - room) / 1e6),
                        "give more, or a smaller `resolution` or `depth`");
        const int fitting = std::clamp(static_cast<int>(std::ceil(step * std::sqrt(bytes / room))), 1, coarsest);
        if (fits && (pass > 4 || fitting >= step)) {
            std::string html(explorer_page);
            constexpr std::string_view place = "/*DATA*/";
            return {html.replace(html.find(place), place.size(), start.substr(0, start.size() - 1) + data), step};
        }
        step = pass > 4 ? step + 1 : fitting;
    }
}

}  // namespace cistula
