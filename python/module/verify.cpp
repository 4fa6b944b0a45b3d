// The renderer's check of itself.
#include "verify/verify.h"

#include <algorithm>

#include "module.h"

namespace cistula::python {
namespace {

using verify::IntersectorKind;
using verify::Row;

std::vector<Row> run(std::vector<std::string> cases, bool quick, uint32_t scale, uint64_t seed,
                     const std::optional<std::vector<std::string>>& intersectors, const Keywords& keywords,
                     const std::optional<nb::callable>& progress) {
    const RenderRequest request = request_of(keywords, {"precision", "threads"});
    verify::Options options;
    options.cases = std::move(cases);
    options.quick = quick;
    options.scale = scale;
    options.seed = seed;
    if (request.precision) options.precisions = {*request.precision};
    if (intersectors) {
        options.intersectors = verify::host_intersectors;
        options.intersectors.push_back(IntersectorKind::cuda);
        std::erase_if(options.intersectors, [&](IntersectorKind kind) {
            return std::find(intersectors->begin(), intersectors->end(), intersector_name(kind)) == intersectors->end();
        });
    }
    if (progress)
        options.finished = [&](const Row& row) {
            const nb::gil_scoped_acquire held;
            (*progress)(row);
        };
    std::vector<Row> rows;
    RenderProgress state;
    run_interruptibly(state.stop, [&] { on_threads(request.threads, [&] { rows = verify::run(options, state); }); });
    return rows;
}

}  // namespace

void bind_verify(nb::module_& m) {
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
        .def("__bool__", &Row::holds);
    m.def("verify", run, "cases"_a, "quick"_a, "scale"_a, "seed"_a, "intersectors"_a.none(), "keywords"_a,
          "progress"_a.none(),
          nb::sig("def verify(cases: collections.abc.Sequence[str], quick: bool, scale: int, seed: int, "
                  "intersectors: collections.abc.Sequence[str] | None, keywords: collections.abc.Sequence[tuple[str, "
                  "str]], progress: collections.abc.Callable[[CaseResult], object] | None) -> list[CaseResult]"),
          "Runs the self-check. Internal.");
}

}  // namespace cistula::python
