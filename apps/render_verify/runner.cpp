#include "apps/render_verify/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <new>
#include <stdexcept>

#include "apps/render_verify/ready_part.h"
#include "backend_embree/embree/embree_renderer.h"
#include "sequence/backends.h"
#include "testing/reference_renderers.h"

namespace cistula::verify {
namespace {

using Clock = std::chrono::steady_clock;

/// The outcomes of a case, one for each intersector, filled part by part.
class CaseRun {
  public:
    CaseRun(const Case& one, const RunSettings& settings, Precision precision)
        : case_(one), settings_(settings), precision_(precision) {
        for (const IntersectorKind kind : settings.intersectors) {
            if (one.own_traversal && kind != IntersectorKind::brute && kind != IntersectorKind::cuda) continue;
            Outcome outcome;
            outcome.of = &one;
            outcome.intersector = kind;
            outcome.precision = precision;
            outcomes_.push_back(outcome);
        }
    }

    std::vector<Outcome> run() {
        if (case_.render)
            for (Outcome& outcome : outcomes_) guarded(outcome, [&] { run_images(outcome); });
        else if (precision_ == Precision::double_)
            run_rays<double>();
        else
            run_rays<float>();
        std::erase_if(outcomes_, [](const Outcome& o) { return o.left_out > 0 && o.tally.tried == 0; });
        return std::move(outcomes_);
    }

  private:
    /// Runs `work`; an exception becomes the outcome's problem, unless memory ran out.
    template <class Work>
    void guarded(Outcome& outcome, const Work& work) {
        const auto start = Clock::now();
        try {
            if (outcome.problem.empty()) work();
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& error) {
            outcome.problem = error.what();
        }
        outcome.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    }

    template <class Real>
    void run_rays() {
        Plan plan(settings_.quick);
        std::string problem;
        try {
            case_.plan(plan);
            if (plan.parts.empty()) problem = "the case has no parts";
            for (uint64_t number = 0; number < plan.parts.size() && problem.empty(); ++number) {
                if (case_.is(float_warns) && precision_ == Precision::single_ &&
                    smallest_part(plan.parts[number].scene).share < least_share(Precision::single_)) {
                    for (Outcome& outcome : outcomes_) ++outcome.warned;
                    continue;
                }
                ReadyPart<Real> ready(plan.parts[number], number, settings_.lanes);
                problem = ready.missing_warning();
                if (problem.empty()) run_part(plan.parts[number], number, ready);
            }
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& error) {
            problem = error.what();
        }
        for (Outcome& outcome : outcomes_) {
            if (outcome.problem.empty()) outcome.problem = problem;
            const uint64_t at = outcome.tally.worst_at, number = at >> place_shift;
            if (at != no_place && number < plan.parts.size())
                outcome.worst_label =
                    fmt::format("{}, ray {}", plan.parts[number].label, at & ((uint64_t(1) << place_shift) - 1));
        }
    }

    template <class Real>
    void run_part(const Part& part, uint64_t number, ReadyPart<Real>& ready) {
        const RayMethods<Real>& methods = case_.methods<Real>();
        const uint64_t place = number << place_shift, plain = ready.plain_count(settings_.quick);
        std::vector<uint64_t> expected;
        if (methods.words) expected = ready.words(IntersectorKind::plain, methods, plain);
        for (Outcome& outcome : outcomes_)
            guarded(outcome, [&] {
                const IntersectorKind by = outcome.intersector;
                if (by == IntersectorKind::lanes && !ready.fits_lanes()) {
                    ++outcome.left_out;
                } else if (methods.words) {
                    const std::vector<uint64_t> found = ready.words(by, methods, plain);
                    for (uint64_t i = 0; i < plain; ++i) {
                        outcome.tally.place = place + i;
                        outcome.tally.expect(found[i] == expected[i]);
                    }
                } else {
                    const bool brute = by == IntersectorKind::brute && !case_.own_traversal;
                    outcome.tally.merge(ready.tally(by, methods, place, brute ? plain : part.count));
                }
            });
    }

    template <class Real>
    Film film_of(IntersectorKind kind, const SceneDescription& scene, FrameSettings settings) {
        std::shared_ptr<CompiledScene<Real>> compiled = compile_scene<Real>(scene);
        if (kind == IntersectorKind::bvh) build_primitive_tree(*compiled);
        const std::unique_ptr<Renderer> renderer = [&] {
            switch (kind) {
                case IntersectorKind::bvh:
                    return make_host_renderer<Real>(compiled, HostIntersector::bvh);
                case IntersectorKind::brute:
                    return make_host_renderer<Real>(compiled, HostIntersector::brute);
                case IntersectorKind::cuda:
                    return make_renderer<Real>(Backend::cuda, compiled, choose_devices(Backend::cuda, {}).options);
                case IntersectorKind::lanes:
                    if (settings.lanes == 0) settings.lanes = settings_.lanes;
                    return make_embree_renderer<Real>(compiled);
                default:
                    return make_embree_renderer<Real>(compiled, always_tree());
            }
        }();
        Film film;
        RenderProgress progress;
        renderer->render(camera_at(scene.camera, 0), settings, film, progress);
        return film;
    }

    static EmbreeOptions always_tree() {
        EmbreeOptions options;
        options.always_tree = true;
        return options;
    }

    void run_images(Outcome& outcome) {
        const IntersectorKind kind = outcome.intersector;
        const auto film = [&](const SceneDescription& scene, const FrameSettings& settings) {
            return precision_ == Precision::double_ ? film_of<double>(kind, scene, settings)
                                                    : film_of<float>(kind, scene, settings);
        };
        Stage stage(settings_.quick, precision_, intersector_name(kind), film);
        outcome.tally.place = 0;
        case_.render(stage, outcome.tally);
        outcome.warned = stage.warned();
        if (outcome.tally.worst_at != no_place) outcome.worst_label = fmt::format("try {}", outcome.tally.worst_at);
    }

    const Case& case_;
    const RunSettings& settings_;
    const Precision precision_;
    std::vector<Outcome> outcomes_;
};

}  // namespace

const char* intersector_name(IntersectorKind kind) {
    constexpr const char* names[] = {"embree", "lanes", "bvh", "brute", "cuda"};
    return names[size_t(kind)];
}

double Outcome::measured() const {
    return of->bound.measure == Measure::failures ? double(tally.failures) : tally.worst;
}

bool Outcome::holds() const {
    if (must_warn() && problem.empty() && tally.tried == 0) return warned > 0;
    if (must_warn() && warned == 0) return false;
    if (!problem.empty() || tally.tried == 0 || (of->is(needs_witness) && tally.witnesses == 0)) return false;
    if (of->bound.must_fail) return measured() >= limit();
    if (of->bound.measure == Measure::worst && tally.failures != 0) return false;
    return measured() <= limit();
}

std::vector<Outcome> run_cases(const std::vector<const Case*>& cases, const RunSettings& settings,
                               StepProgress& progress, const std::function<void(const Outcome&)>& done) {
    std::vector<Outcome> all;
    progress.begin("cases", static_cast<double>(cases.size() * settings.precisions.size()));
    for (const Case* one : cases)
        for (const Precision precision : settings.precisions) {
            progress.name_part(one->name);
            for (Outcome& outcome : CaseRun(*one, settings, precision).run()) {
                done(outcome);
                all.push_back(std::move(outcome));
            }
            progress.advance();
        }
    return all;
}

}  // namespace cistula::verify
