// The programs as commands of the package, and what render-verify finds as values.
#include "apps/common/programs.h"

#include <fmt/format.h>

#include "module.h"
#include "scene/description/description.h"
#include "verify/verify.h"

namespace cistula::python {
namespace {

using verify::Row;

/// Has Python read the textures that this build leaves to it. Throws Error (file).
void read_other_textures(SceneDescription& description) {
    const nb::gil_scoped_acquire held;
    try {
        nb::module_::import_("cistula.textures").attr("read_others")(nb::cast(&description, nb::rv_policy::reference));
    } catch (const nb::python_error& error) {
        throw Error(ErrorKind::file, nb::str(error.value()).c_str());
    }
}

/// Runs a program with the words of its command line, and returns its exit code.
int run_program(const std::string& name, const std::vector<nb::bytes>& words) {
    std::vector<const char*> arguments = {name.c_str()};
    for (const nb::bytes& word : words) arguments.push_back(word.c_str());
    const auto count = static_cast<int>(arguments.size());
    arguments.push_back(nullptr);
    const WithoutGil free;
    if (name == "compare") return render_compare_program(count, arguments.data());
    if (name == "verify") return render_verify_program(count, arguments.data());
    return render_program(count, arguments.data(), read_other_textures);
}

std::vector<Row> verify_here(std::vector<std::string> cases, bool quick, const std::string& backend,
                             const Keywords& keywords, const std::optional<nb::callable>& progress) {
    const RenderRequest request = request_of(keywords, {"precision", "lanes"});
    verify::Options options;
    options.cases = std::move(cases);
    options.quick = quick;
    options.lanes = request.frame.lanes;
    if (request.precision) options.precisions = {*request.precision};
    try {
        options.intersectors = verify::intersectors_of(backend);
    } catch (const Error& error) {
        throw Error(error.kind(), error.what()).at("backend=" + backend);
    }
    if (progress)
        options.finished = [&](const Row& row) {
            const nb::gil_scoped_acquire held;
            (*progress)(row);
        };
    std::vector<Row> rows;
    RenderProgress state;
    run_interruptibly(state.stop, [&] { rows = verify::run(options, state); });
    return rows;
}

}  // namespace

void bind_programs(nb::module_& m) {
    nb::class_<Row>(m, "CaseResult", "What a case of the self-check found on one intersector in one precision.")
        .def_ro("name", &Row::name, "Group and case: \"geometry/fans\".")
        .def_ro("exact", &Row::exact, "What is exact.")
        .def_prop_ro(
            "intersector", [](const Row& row) { return std::string(intersector_name(row.intersector)); },
            "\"embree\", \"lanes\", \"bvh\", \"brute\" or \"cuda\".")
        .def_prop_ro(
            "precision", [](const Row& row) { return std::string(precision_name(row.precision)); },
            "\"float\" or \"double\".")
        .def_prop_ro("holds", &Row::holds, "Whether it is within its bound.")
        .def_ro("complaint", &Row::complaint, "Why it does not hold; empty: it holds.")
        .def_ro("measured", &Row::measured, "Failures, or the largest deviation, in `unit`.")
        .def_ro("bound", &Row::bound, "The most that may be; with must_fail the least.")
        .def_ro("must_fail", &Row::must_fail, "It is built wrong on purpose.")
        .def_prop_ro(
            "unit", [](const Row& row) { return std::string(row.unit); }, "Of measured and bound.")
        .def_ro("tried", &Row::tried, "How often it was tried.")
        .def_ro("failures", &Row::failures, "How often it failed.")
        .def_ro("worst_at", &Row::worst_at, "Where the largest deviation is; empty: none deviates.")
        .def_ro("seconds", &Row::seconds, "How long it took.")
        .def("__bool__", &Row::holds)
        .def("__repr__", [](const Row& row) {
            return fmt::format("<cistula.CaseResult {} on {} in {}: {}>", row.name, intersector_name(row.intersector),
                               precision_name(row.precision), row.holds() ? "holds" : row.complaint);
        });
    m.def("verify", verify_here, "cases"_a, "quick"_a, "backend"_a, "keywords"_a, "progress"_a.none(),
          nb::sig("def verify(cases: collections.abc.Sequence[str], quick: bool, backend: str, "
                  "keywords: collections.abc.Sequence[tuple[str, str]], "
                  "progress: collections.abc.Callable[[CaseResult], object] | None) -> list[CaseResult]"),
          "Runs the self-check. Internal.");
    m.def("run_program", run_program, "name"_a, "words"_a,
          "Runs the program \"render\", \"compare\" or \"verify\", and returns its exit code. Internal.");
}

}  // namespace cistula::python
