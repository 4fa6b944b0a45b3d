#include "plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace cistula {
namespace {

/// A task while its frames are found: where it stands in the film.
struct Portion {
    size_t begin = 0, end = 0, tile = 0;
    double seconds = 0;
};

std::vector<Portion> portions_of(size_t frames, size_t tiles, const MeasuredFrames& measured, double seconds) {
    std::vector<Portion> portions;
    for (size_t tile = 0; tile < tiles; ++tile) {
        Portion now{0, 0, tile, 0};
        for (size_t i = 0; i < frames; ++i) {
            const double own = measured.of(i, tile);
            if (now.end > now.begin && now.seconds + own > seconds) {
                portions.push_back(now);
                now = {i, i, tile, 0};
            }
            now.end = i + 1;
            now.seconds += own;
        }
        portions.push_back(now);
    }
    return portions;
}

}  // namespace

double MeasuredFrames::of(size_t index, size_t tile) const {
    const auto after = std::lower_bound(indices.begin(), indices.end(), index);
    const auto next = static_cast<size_t>(after - indices.begin());
    if (after == indices.end()) return seconds.back()[tile];
    if (*after == index || next == 0) return seconds[next][tile];
    const auto span = static_cast<double>(indices[next] - indices[next - 1]);
    const double share = static_cast<double>(index - indices[next - 1]) / span;
    return seconds[next - 1][tile] * (1 - share) + seconds[next][tile] * share;
}

std::vector<size_t> frames_to_measure(size_t frames, size_t most) {
    std::vector<size_t> indices;
    const size_t count = std::min(frames, most);
    for (size_t i = 0; i < count; ++i) indices.push_back(count == 1 ? 0 : i * (frames - 1) / (count - 1));
    return indices;
}

std::vector<FarmTask> plan_tasks(const std::vector<int>& frames, size_t tiles, const MeasuredFrames& measured,
                                 double seconds, size_t most) {
    if (tiles > most)
        throw Error(ErrorKind::usage, fmt::format("--most-tasks {}: there are {} tiles, each of which is a task at "
                                                  "least; give fewer --tiles or more tasks",
                                                  most, tiles));
    std::vector<Portion> portions = portions_of(frames.size(), tiles, measured, seconds);
    while (portions.size() > most) {
        seconds *= std::max(1.1, static_cast<double>(portions.size()) / static_cast<double>(most));
        portions = portions_of(frames.size(), tiles, measured, seconds);
    }
    std::stable_sort(portions.begin(), portions.end(),
                     [](const Portion& a, const Portion& b) { return a.begin < b.begin; });
    std::vector<FarmTask> tasks;
    for (const Portion& portion : portions)
        tasks.push_back({frames_from(frames, portion.begin, portion.end - portion.begin),
                         static_cast<int>(portion.tile), portion.seconds});
    return tasks;
}

}  // namespace cistula
