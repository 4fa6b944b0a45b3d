// The ray trees of a pixel.
#include <fmt/format.h>

#include <algorithm>

#include "module.h"
#include "render/pixel_report.h"
#include "scene.h"
#include "scene/description/camera_path.h"

namespace cistula::python {
namespace {

/// Values in the order of the fields of cistula.pixel.Light.
nb::tuple light_fields(const PixelReport& report, const LightContribution& light) {
    nb::list through;
    for (const uint32_t solid : light.through) through.append(report.names.solids[solid].name);
    return nb::make_tuple(report.names.lights[light.light].name, name_of(light.fate), light.distance,
                          degrees_of(light.cosine), triple(light.arrives), nb::tuple(through),
                          triple(radiance_of(light.adds, report.tree.film)));
}

/// Values in the order of the fields of cistula.pixel.Surface.
nb::object surface_fields(const PixelReport& report, const PixelSurface& s) {
    nb::list lights;
    for (const LightContribution& light : s.lights) lights.append(light_fields(report, light));
    return nb::make_tuple(report.names.solids[s.solid].name, report.names.materials[s.material].name, s.face,
                          name_of(s.crossing), triple(s.point), triple(s.normal), triple(s.color), degrees_of(s.cosine),
                          s.index_before, s.index_beyond, s.total, s.local, s.mirrored, triple(s.through),
                          triple(radiance_of(s.ambient_adds, report.tree.film)), nb::tuple(lights));
}

/// The rays of a sample, parents first, each as values in the order of the fields of cistula.pixel.Ray.
nb::list rays_of_sample(const PixelReport& report, size_t number) {
    const SampleTree& sample = report.tree.samples.at(number);
    const Film& film = report.tree.film;
    std::vector<int> parents(sample.branches.size(), -1);
    for (size_t i = 0; i < sample.branches.size(); ++i)
        for (const uint32_t child : sample.branches[i].children) parents[child] = static_cast<int>(i);
    nb::list rays;
    for (size_t i = 0; i < sample.branches.size(); ++i) {
        const PixelBranch& b = sample.branches[i];
        const bool at_surface = b.end == BranchEnd::surface;
        const bool at_light = b.end == BranchEnd::light;
        rays.append(nb::make_tuple(parents[i], name_of(b.kind), name_of(b.end), b.depth, triple(b.weight),
                                   triple(b.arriving), triple(b.origin), triple(b.direction), b.distance,
                                   at_surface ? surface_fields(report, b.surface) : nb::none(),
                                   at_light ? nb::cast(report.names.visible_lights[b.visible_light].name) : nb::none(),
                                   triple(radiance_of(b.adds, film)), triple(radiance_of(b.adds_below, film)),
                                   triple(radiance_of(b.ledger, film)), triple(radiance_of(b.ledger_below, film))));
    }
    return rays;
}

std::shared_ptr<PixelReport> trace(const std::shared_ptr<SceneHandle>& scene, int x, int y, int frame,
                                   const Keywords& keywords) {
    const SceneDescription& description = scene->description();
    const RenderRequest request = request_of(keywords, {"resolution", "supersample", "depth", "cutoff", "threads"});
    const FrameSettings settings = frame_settings(request, description);
    if (x < 0 || y < 0 || x >= settings.full_width || y >= settings.full_height)
        throw Error(
            ErrorKind::usage,
            fmt::format("x={}, y={}: is outside of the frame, which is {}x{}; its last pixel is {},{}", x, y,
                        settings.full_width, settings.full_height, settings.full_width - 1, settings.full_height - 1));
    const CameraFrame camera = camera_at(description.camera, frame);
    std::shared_ptr<PixelReport> report;
    std::atomic<bool> stop{false};
    run_interruptibly(stop, [&] {
        on_threads(request.threads, [&] {
            PixelTree tree = (*LentRenderer(scene, Backend::embree, {})).pixel_tree(camera, settings, x, y);
            const std::string flaws = describe_flags(tree.film.flags, tree.crowd);
            report = std::make_shared<PixelReport>(
                PixelReport{x, y, scene->scene().precision(), description.source, scene->scene().at(frame).names(),
                            settings, camera, std::move(tree), scene->scene().hashes().of(frame), flaws});
        });
    });
    return report;
}

Triple shown_triple(const PixelReport& report, const char* a, const char* b, const char* c) {
    return {shown(report, a), shown(report, b), shown(report, c)};
}

}  // namespace

void bind_pixel(nb::module_& m) {
    nb::class_<PixelReport>(m, "PixelReport", "The ray trees of a pixel. Internal.")
        .def(nb::new_(&trace), "scene"_a, "x"_a, "y"_a, "frame"_a, "keywords"_a)
        .def(
            "text", [](const PixelReport& report, bool verbose) { return pixel_text(report, verbose); }, "verbose"_a)
        .def("json", pixel_json)
        .def("rays", rays_of_sample, "sample"_a, nb::sig("def rays(self, sample: int) -> list[tuple[object, ...]]"))
        .def_prop_ro("samples", [](const PixelReport& report) { return report.tree.samples.size(); })
        .def_prop_ro("middle", [](const PixelReport& report) { return middle_sample(report.settings.supersample); })
        .def_prop_ro("flaws", [](const PixelReport& report) { return report.flaws; })
        .def_prop_ro("radiance",
                     [](const PixelReport& report) {
                         const Triple t = shown_triple(report, "R", "G", "B");
                         return std::tuple(t[0], t[1], t[2]);
                     })
        .def_prop_ro("error", [](const PixelReport& report) {
            const Triple t = shown_triple(report, "error.R", "error.G", "error.B");
            return std::tuple(t[0], t[1], t[2]);
        });
}

}  // namespace cistula::python
