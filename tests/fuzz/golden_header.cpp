// Headers of golden images: what a suite's page makes of the settings that one names, a line "NAME VALUE" each.
#include <charconv>
#include <sstream>

#include "checks.h"
#include "compare/suite/suite_report.h"
#include "target.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

/// A case with mirrors and glass, and its picture.
struct Rendered {
    Rendered() {
        put_bytes(folder.file("scene.json"), R"({"film": {"width": 8, "height": 6},
            "camera": {"position": [0, -6, 1], "target": [0, 0, 0]}, "background": 0.3, "depth": 4,
            "materials": {"glass": {"reflection": 0.2, "transmission": 0.7, "index": 1.5}},
            "objects": [{"solid": "cube", "material": "glass"},
                        {"solid": "cube", "center": [2.5, 0, 0], "material": "glass"}],
            "lights": [{"position": [3, -4, 5]}]})");
        one.name = "one";
        one.scene = "scene.json";
        RenderProgress progress;
        const SuiteScene scene = prepare_case(one, folder.file(""), Backend::embree, {});
        picture = scene.render(0, progress).picture;
        result.of = &one;
        result.precision = scene.precision;
        result.outcome = Outcome::differs;
    }
    ScratchDirectory folder;
    SuiteCase one;
    LayeredPicture picture;
    SuiteResult result;
};

/// The value as the attribute that it looks like.
Attributes::mapped_type value_of(const std::string& text) {
    const char* const end = text.data() + text.size();
    int whole = 0;
    if (std::from_chars(text.data(), end, whole).ptr == end) return whole;
    double number = 0;
    if (std::from_chars(text.data(), end, number).ptr == end) return number;
    return text;
}

}  // namespace
}  // namespace cistula

FUZZ_TARGET(golden_header) {
    using namespace cistula;
    static const Rendered rendered;
    LayeredPicture golden = rendered.picture;
    golden.channels[0].values[27] += 1;
    std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
    for (std::string name, value; lines >> name && std::getline(lines >> std::ws, value);)
        golden.attributes["cistula:" + name] = value_of(value);
    try {
        fuzz::check_markup(failure_html(rendered.result, rendered.folder.file(""), &golden, rendered.picture, {}));
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::failed);
    }
    return 0;
}
