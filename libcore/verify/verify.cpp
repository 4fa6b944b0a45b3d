#include "verify/verify.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>

#include "backend_embree/embree/embree_renderer.h"
#include "base/option_text.h"
#include "base/suggest.h"
#include "sequence/backends.h"
#include "verify/ready_part.h"
#include "verify/reference_renderers.h"

namespace cistula::verify {
namespace {

using Clock = std::chrono::steady_clock;

/// A row that is being filled, part by part.
struct Finding {
    Row row;
    Tally tally;
    std::string problem;    // reason why it cannot be judged
    uint64_t left_out = 0;  // parts of the case that are not traced in lanes, nor judged
};

/// The reason why a finding does not hold; empty if it does. `of` is its case, `row` has what was measured.
std::string complaint_of(const Case& of, const Finding& found) {
    const Row& row = found.row;
    if (!found.problem.empty()) return one_line(found.problem);
    const bool must_warn = of.is(float_warns) && row.precision == Precision::single_;
    if (must_warn && row.warned == 0) return "float does not warn";
    if (row.tried == 0) return must_warn ? "" : "nothing was tried";
    if (of.is(needs_witness) && row.witnesses == 0) return "no try met the hazard";
    if (row.must_fail) return row.measured >= row.bound ? "" : "what is broken on purpose is not caught";
    if (row.measured <= row.bound && (row.counts || row.failures == 0)) return "";
    std::string text = row.failures != 0 ? fmt::format("{} of {} failed", row.failures, row.tried)
                                         : fmt::format("{} is over the bound", number_text(row.measured));
    if (!row.worst_at.empty()) text += "; first: " + one_line(row.worst_at);
    return text;
}

Row judged(const Case& of, Finding found) {
    Row& row = found.row;
    row.name = of.name;
    row.group = of.name.substr(0, of.name.find('/'));
    row.exact = of.exact;
    row.bound = of.bound.limit[row.precision == Precision::double_];
    row.unit = of.bound.unit;
    row.counts = of.bound.measure == Measure::failures;
    row.must_fail = of.bound.must_fail;
    row.tried = found.tally.tried;
    row.failures = found.tally.failures;
    row.witnesses = found.tally.witnesses;
    row.measured = row.counts ? double(found.tally.failures) : found.tally.worst;
    row.complaint = complaint_of(of, found);
    return std::move(row);
}

/// A case in one precision, on every intersector.
class CaseRun {
  public:
    CaseRun(const Case& one, const Options& options, const CudaOptions& devices, Precision precision,
            RenderProgress& progress)
        : case_(one), options_(options), devices_(devices), precision_(precision), progress_(progress) {
        for (const IntersectorKind kind : options.intersectors) {
            if (one.own_traversal && kind != IntersectorKind::brute && kind != IntersectorKind::cuda) continue;
            Finding& found = findings_.emplace_back();
            found.row.intersector = kind;
            found.row.precision = precision;
        }
    }

    std::vector<Row> run() {
        if (case_.render)
            for (Finding& found : findings_) guarded(found, [&] { run_images(found); });
        else if (precision_ == Precision::double_)
            run_rays<double>();
        else
            run_rays<float>();
        std::vector<Row> rows;
        for (Finding& found : findings_)
            if (found.left_out == 0 || found.tally.tried > 0) rows.push_back(judged(case_, std::move(found)));
        return rows;
    }

  private:
    /// Runs `work`; an exception becomes a problem, unless memory ran out or the run is stopped.
    template <class Work>
    void guarded(std::string& problem, const Work& work) {
        try {
            if (problem.empty()) work();
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& error) {
            problem = error.what();
        }
        StopSignal(progress_.stop).check();
    }
    template <class Work>
    void guarded(Finding& found, const Work& work) {
        const auto start = Clock::now();
        guarded(found.problem, work);
        found.row.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    }

    template <class Real>
    void run_rays() {
        Plan plan(options_.quick, options_.scale);
        std::string problem;
        guarded(problem, [&] {
            case_.plan(plan);
            if (plan.parts.empty()) problem = "the case has no parts";
            for (uint64_t number = 0; number < plan.parts.size() && problem.empty(); ++number) {
                if (case_.is(float_warns) && precision_ == Precision::single_ &&
                    smallest_part(plan.parts[number].scene).share < least_share(Precision::single_)) {
                    for (Finding& found : findings_) ++found.row.warned;
                    continue;
                }
                ReadyPart<Real> ready(plan.parts[number], number, options_, progress_.stop);
                problem = ready.missing_warning();
                if (problem.empty()) run_part(plan.parts[number], number, ready);
            }
        });
        for (Finding& found : findings_) {
            if (found.problem.empty()) found.problem = problem;
            const uint64_t at = found.tally.worst_at;
            const uint64_t number = at >> place_shift;
            if (at != no_place && number < plan.parts.size())
                found.row.worst_at =
                    fmt::format("{}, ray {}", plan.parts[number].label, at & ((uint64_t(1) << place_shift) - 1));
        }
    }

    template <class Real>
    void run_part(const Part& part, uint64_t number, ReadyPart<Real>& ready) {
        const RayMethods<Real>& methods = case_.methods<Real>();
        const uint64_t place = number << place_shift;
        const uint64_t plain = ready.plain_count();
        std::vector<uint64_t> expected;
        if (methods.words) expected = ready.words(IntersectorKind::plain, methods, plain);
        for (Finding& found : findings_)
            guarded(found, [&] {
                const IntersectorKind by = found.row.intersector;
                if (by == IntersectorKind::lanes && !ready.fits_lanes()) {
                    ++found.left_out;
                } else if (methods.words) {
                    const std::vector<uint64_t> words = ready.words(by, methods, plain);
                    for (uint64_t i = 0; i < plain; ++i) {
                        found.tally.place = place + i;
                        found.tally.expect(words[i] == expected[i]);
                    }
                } else {
                    const bool brute = by == IntersectorKind::brute && !case_.own_traversal;
                    found.tally.merge(ready.tally(by, methods, place, brute ? plain : part.count));
                }
            });
    }

    template <class Real>
    Film film_of(IntersectorKind kind, const SceneDescription& scene, FrameSettings settings) {
        std::shared_ptr<CompiledScene<Real>> compiled = compile_scene<Real>(scene, progress_.stop);
        if (kind == IntersectorKind::bvh) build_primitive_tree(*compiled);
        const std::unique_ptr<Renderer> renderer = [&] {
            switch (kind) {
                case IntersectorKind::bvh:
                    return make_host_renderer<Real>(compiled, HostIntersector::bvh);
                case IntersectorKind::brute:
                    return make_host_renderer<Real>(compiled, HostIntersector::brute);
                case IntersectorKind::cuda:
                    return make_renderer<Real>(Backend::cuda, compiled, devices_);
                case IntersectorKind::lanes:
                    if (settings.lanes == 0) settings.lanes = options_.lanes;
                    return make_embree_renderer<Real>(compiled);
                default:
                    return make_embree_renderer<Real>(compiled, {.always_tree = true});
            }
        }();
        Film film;
        if (!renderer->render(camera_at(scene.camera, 0), settings, film, progress_))
            StopSignal(progress_.stop).check();
        return film;
    }

    void run_images(Finding& found) {
        const IntersectorKind kind = found.row.intersector;
        const auto film = [&](const SceneDescription& scene, const FrameSettings& settings) {
            return precision_ == Precision::double_ ? film_of<double>(kind, scene, settings)
                                                    : film_of<float>(kind, scene, settings);
        };
        Stage stage(options_.quick, precision_, intersector_name(kind), film);
        found.tally.place = 0;
        case_.render(stage, found.tally);
        found.row.warned = stage.warned();
        if (found.tally.worst_at != no_place) found.row.worst_at = fmt::format("try {}", found.tally.worst_at);
    }

    const Case& case_;
    const Options& options_;
    const CudaOptions& devices_;
    const Precision precision_;
    RenderProgress& progress_;
    std::vector<Finding> findings_;
};

bool fits(const std::string& wanted, const std::string& name) {
    if (wanted.find_first_of("*?") != std::string::npos) return fnmatch(wanted.c_str(), name.c_str(), 0) == 0;
    return name.compare(0, wanted.size(), wanted) == 0;
}

std::vector<const Case*> chosen(const Options& options) {
    const std::vector<Case>& cases = options.table ? *options.table : all_cases();
    std::vector<bool> taken(cases.size(), options.cases.empty());
    for (const std::string& text : options.cases) {
        // An exact name is chosen alone even if others begin with it.
        const bool exact = std::any_of(cases.begin(), cases.end(), [&](const Case& one) { return one.name == text; });
        bool any = false;
        for (size_t i = 0; i < cases.size(); ++i)
            if (exact ? cases[i].name == text : fits(text, cases[i].name)) any = taken[i] = true;
        if (any) continue;
        std::vector<std::string_view> names;
        for (const Case& one : cases) names.push_back(one.name);
        fail_usage(fmt::format("{}: there is no such case; {}", text, suggestion(text, names, "cases")));
    }
    std::vector<const Case*> all;
    for (size_t i = 0; i < cases.size(); ++i)
        if (taken[i]) all.push_back(&cases[i]);
    return all;
}

}  // namespace

const char* intersector_name(IntersectorKind kind) {
    constexpr const char* names[] = {"embree", "lanes", "bvh", "brute", "cuda"};
    return names[size_t(kind)];
}

std::string number_text(double value) {
    return value == std::floor(value) && std::fabs(value) < 1e15 ? fmt::format("{:.0f}", value)
                                                                 : fmt::format("{:.4g}", value);
}

std::vector<IntersectorKind> intersectors_of(const std::string& backend) {
    using Kinds = std::vector<IntersectorKind>;
    Kinds all = host_intersectors;
    all.push_back(IntersectorKind::cuda);
    return cistula::chosen<Kinds>(
        backend, {{"embree", host_intersectors}, {"cuda", Kinds{IntersectorKind::cuda}}, {"all", all}});
}

std::vector<CaseName> chosen_cases(const Options& options) {
    std::vector<CaseName> names;
    for (const Case* one : chosen(options)) names.push_back({one->name, one->exact});
    return names;
}

std::vector<Row> run(const Options& options, RenderProgress& progress) {
    const std::vector<const Case*> cases = chosen(options);
    CudaOptions devices;
    const auto& kinds = options.intersectors;
    if (std::count(kinds.begin(), kinds.end(), IntersectorKind::cuda) > 0)
        devices = choose_devices(Backend::cuda, {}).options;
    std::vector<Row> rows;
    for (const Case* one : cases)
        for (const Precision precision : options.precisions) {
            if (options.begun) options.begun(one->name);
            for (Row& row : CaseRun(*one, options, devices, precision, progress).run()) {
                if (options.finished) options.finished(row);
                rows.push_back(std::move(row));
            }
        }
    return rows;
}

}  // namespace cistula::verify
