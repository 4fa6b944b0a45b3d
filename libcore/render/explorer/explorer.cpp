#include "render/explorer/explorer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <libdeflate.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/file_bytes.h"
#include "image/picture/picture_io.h"
#include "render/pixel_report.h"

namespace cistula {
namespace {

using Json = nlohmann::ordered_json;

std::string color(const glm::dvec3& c) {
    const std::string parts[] = {fmt::format("{:.3g}", c.x), fmt::format("{:.3g}", c.y), fmt::format("{:.3g}", c.z)};
    return parts[0] == parts[1] && parts[1] == parts[2] ? parts[0] : fmt::format("[{}]", fmt::join(parts, ","));
}

std::string light_list(const PixelSurface& s, const Film& film) {
    std::vector<std::string> list;
    int shadows = 0;  // of which four are told
    for (const LightContribution& light : s.lights)
        if (light.adds != FixedColor{} || (light.fate == LightFate::shadow && ++shadows <= 4))
            list.push_back(fmt::format("[{},{},[{}]]", light.light, color(radiance_of(light.adds, film)),
                                       fmt::join(light.through, ",")));
    return fmt::format("[{}]", fmt::join(list, ","));
}

std::string surface(const PixelSurface& s) {
    return fmt::format("[{},{},{:.3g},{:.3g},{:.3g},{},{:.4g},{:.4g},{:.3g}]", static_cast<int>(s.crossing), s.material,
                       degrees_of(s.cosine), s.local, s.mirrored, color(s.through), s.index_before, s.index_beyond,
                       s.total   ? -1.0
                       : s.bends ? degrees_of(s.bent_cosine)
                                 : 0.0);
}

std::string ray(const PixelBranch& b, int parent, const Film& film, const glm::dvec3& eye) {
    const bool met = b.end == BranchEnd::surface;
    std::string text = fmt::format("[{},{},{},{},{},{},{}", parent, static_cast<int>(b.kind), static_cast<int>(b.end),
                                   color(b.weight), color(radiance_of(met ? b.surface.ambient_adds : b.adds, film)),
                                   color(radiance_of(b.ledger, film)), met ? light_list(b.surface, film) : "[]");
    if (b.end <= BranchEnd::background) {
        const glm::dvec3 at = b.end == BranchEnd::background ? b.direction : b.origin + b.direction * b.distance - eye;
        text += fmt::format(",[{:.4g},{:.4g},{:.4g}],{}", at.x, at.y, at.z, met ? b.surface.solid : b.visible_light);
    }
    if (met) text += fmt::format(",{}", surface(b.surface));
    return text + "]";
}

Json point(const glm::dvec3& p) {
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

/// The number of steps that cover a length.
int steps(int length, int step) {
    return (length + step - 1) / step;
}

}  // namespace

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
                 {"axes", {point(camera.right), point(camera.up), point(camera.forward)}},
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
            body.push_back({point(from - camera.position), point(to - camera.position)});
    }
    scene_.visit([&](const auto& scene) {
        const auto add = [&](const char* list, const SceneNames::Named& named, const auto& at) {
            const glm::dvec3 world = glm::dvec3(at) * std::ldexp(1.0, -scene->scale) + scene->center;
            json[list].push_back(
                {{"name", named.name}, {"place", named.place}, {"at", point(world - camera.position)}});
        };
        for (size_t i = 0; i < known.lights.size(); ++i) add("lights", known.lights[i], scene->lights[i].position);
        for (size_t i = 0; i < known.visible_lights.size(); ++i)
            add("visible", known.visible_lights[i], scene->visible_lights[i].center);
        json["bound"] = point(glm::dvec3(scene->bound) * std::ldexp(1.0, scene->radiance_exponent));
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
    tbb::enumerable_thread_specific<std::unique_ptr<Renderer>> renderers(make);
    std::string rows;
    const auto fill = [&](int step) {
        std::vector<std::string> packs(static_cast<size_t>(steps(height, step)));
        tbb::parallel_for(size_t{0}, packs.size(), [&](size_t row) {
            std::string list;
            for (int column = 0; column < steps(width, step); ++column) {
                stop.check();
                list += column == 0 ? "[" : ",";
                const int x = std::min(column * step + step / 2, width - 1);
                const int y = std::min(static_cast<int>(row) * step + step / 2, height - 1);
                tbb::this_task_arena::isolate(  // from other rows, which would use the same renderer
                    [&] { list += pixel(*renderers.local(), x, y, stop); });
            }
            packs[row] = packed(list + "]");
        });
        rows = fmt::format(R"(,"step":{},"rows":["{}"]}})", step, fmt::join(packs, R"(",")"));
        return static_cast<size_t>(steps(width, step)) * packs.size();
    };

    const double room = megabytes * 1e6 - static_cast<double>(start.size() + explorer_page.size());
    const int coarsest = std::max(1, std::min(width, height) / 8);
    int step = coarsest;
    size_t trees = fill(step);
    for (bool too_fine = false; static_cast<double>(rows.size()) > room || !too_fine;) {
        const auto bytes = static_cast<double>(rows.size());
        too_fine |= bytes > room;
        if (bytes > room && step == coarsest)
            throw Error(ErrorKind::usage,
                        fmt::format("`explore_mb` {}: the picture and {} pixels' rays take {:.1f}", megabytes, trees,
                                    megabytes + (bytes - room) / 1e6),
                        "give more, or a smaller `resolution` or `depth`");
        const int fitting = static_cast<int>(std::ceil(step * std::sqrt(bytes / room)));
        const int next = too_fine ? std::clamp(fitting, step + 1, coarsest) : std::clamp(fitting, 1, step);
        if (next == step) break;
        trees = fill(step = next);
    }
    std::string html(explorer_page);
    constexpr std::string_view place = "/*DATA*/";
    html.replace(html.find(place), place.size(), start.substr(0, start.size() - 1) + rows);
    return {std::move(html), step, trees};
}

}  // namespace cistula
