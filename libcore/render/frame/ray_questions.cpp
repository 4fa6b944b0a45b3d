#include "render/frame/ray_questions.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "base/default_rounding.h"
#include "base/error.h"

namespace cistula {
namespace {

/// Coordinates in the frame that a question may have: their squares fit float.
constexpr double largest_coordinate = 0x1p60;

bool is_within(const glm::dvec3& point) {
    const auto is_small = [](double x) { return magnitude(x) <= largest_coordinate; };
    return is_small(point.x) && is_small(point.y) && is_small(point.z);
}

/// Calls visit(i) for each i < count, in any order, by several threads.
template <class Visit>
void for_each(size_t count, const Visit& visit) {
    constexpr size_t together = 1024;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, together), [&](const auto& range) {
        const DefaultRounding rounding;
        for (size_t i = range.begin(); i != range.end(); ++i) visit(i);
    });
}

/// Calls visit(i), which says whether i is right, for each i < count; the first that is not, or `count`.
template <class Visit>
size_t first_wrong(size_t count, const Visit& visit) {
    std::atomic<size_t> first{count};
    for_each(count, [&](size_t i) {
        if (visit(i)) return;
        size_t known = first;
        while (i < known && !first.compare_exchange_weak(known, i)) {
        }
    });
    return first;
}

[[noreturn]] void refuse(const char* what, size_t i, const char* why) {
    throw Error(ErrorKind::usage, fmt::format("{} {}: {}", what, i, why));
}

void require_pairs(size_t starts, size_t ends, const char* what) {
    if (starts != ends)
        throw Error(ErrorKind::usage, fmt::format("{}: there are {} and {}; must be as many", what, starts, ends));
}

}  // namespace

template <class Real>
RayHits ray_hits(const CompiledScene<Real>& scene, std::span<const glm::dvec3> origins,
                 std::span<const glm::dvec3> directions, const Answerer<RayAnswer>& answer) {
    require_pairs(origins.size(), directions.size(), "origins and directions of rays");
    const size_t count = origins.size();
    const double unit = elementary::power_of_two(scene.scale);
    const double unit_length = 1 / unit;
    std::vector<RayQuestion> questions(count);
    const size_t wrong = first_wrong(count, [&](size_t i) {
        const double square = dot(directions[i], directions[i]);
        if (!(square >= 0x1p-1000 && square <= 0x1p1000)) return false;
        questions[i] = {(origins[i] - scene.center) * unit, normalized(directions[i])};
        return is_within(questions[i].origin);
    });
    if (wrong != count)
        refuse("ray", wrong, "needs an origin near the scene and a direction that is not 0, in finite numbers");
    std::vector<RayAnswer> answers(count);
    answer(questions, answers);
    RayHits hits;
    hits.names = scene.layer_names;
    hits.distance.resize(count);
    hits.object.resize(count);
    hits.material.resize(count);
    hits.face.resize(count);
    hits.crossing.resize(count);
    hits.point.resize(count);
    hits.normal.resize(count);
    hits.uv.resize(count);
    const size_t overfull = first_wrong(count, [&](size_t i) {
        const RayAnswer& found = answers[i];
        const bool any = found.solid != no_solid;
        hits.distance[i] = found.t * unit_length;
        hits.object[i] = any ? static_cast<int32_t>(found.solid) : -1;
        hits.material[i] = any ? static_cast<int32_t>(found.material) : -1;
        hits.face[i] = any ? static_cast<int32_t>(found.face) : -1;
        hits.crossing[i] = found.crossing;
        hits.point[i] = any ? found.point * unit_length + scene.center : glm::dvec3(0);
        hits.normal[i] = found.normal;
        hits.uv[i] = found.uv;
        return found.t == found.t;
    });
    if (overfull != count) refuse("ray", overfull, "starts inside more solids than are told apart, 8");
    return hits;
}

template <class Real>
std::vector<glm::dvec3> segment_shares(const CompiledScene<Real>& scene, std::span<const glm::dvec3> from,
                                       std::span<const glm::dvec3> to, const Answerer<glm::dvec3>& answer) {
    require_pairs(from.size(), to.size(), "starts and ends of segments");
    const size_t count = from.size();
    const double unit = elementary::power_of_two(scene.scale);
    std::vector<RayQuestion> questions(count);
    const size_t wrong = first_wrong(count, [&](size_t i) {
        questions[i] = {(from[i] - scene.center) * unit, (to[i] - scene.center) * unit};
        return is_within(questions[i].origin) && is_within(questions[i].toward);
    });
    if (wrong != count) refuse("segment", wrong, "needs two ends near the scene, in finite numbers");
    std::vector<glm::dvec3> shares(count);
    answer(questions, shares);
    const size_t overfull = first_wrong(count, [&](size_t i) { return shares[i].x == shares[i].x; });
    if (overfull != count) refuse("segment", overfull, "starts inside more solids than are told apart, 8");
    return shares;
}

template RayHits ray_hits(const CompiledScene<float>&, std::span<const glm::dvec3>, std::span<const glm::dvec3>,
                          const Answerer<RayAnswer>&);
template RayHits ray_hits(const CompiledScene<double>&, std::span<const glm::dvec3>, std::span<const glm::dvec3>,
                          const Answerer<RayAnswer>&);
template std::vector<glm::dvec3> segment_shares(const CompiledScene<float>&, std::span<const glm::dvec3>,
                                                std::span<const glm::dvec3>, const Answerer<glm::dvec3>&);
template std::vector<glm::dvec3> segment_shares(const CompiledScene<double>&, std::span<const glm::dvec3>,
                                                std::span<const glm::dvec3>, const Answerer<glm::dvec3>&);

}  // namespace cistula
