#include "render/pixel_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace cistula {

const char* name_of(BranchKind kind) {
    constexpr const char* names[] = {"primary", "mirrored", "transmitted"};
    return names[static_cast<size_t>(kind)];
}

const char* name_of(BranchEnd end) {
    constexpr const char* names[] = {"surface", "light", "background", "pruned", "cut", "dropped"};
    return names[static_cast<size_t>(end)];
}

const char* name_of(CrossingKind crossing) {
    constexpr const char* names[] = {"sheet", "enters", "leaves"};
    return names[static_cast<size_t>(crossing)];
}

const char* name_of(LightFate fate) {
    constexpr const char* names[] = {"adds", "behind", "nothing", "shadow"};
    return names[static_cast<size_t>(fate)];
}

glm::dvec3 radiance_of(const FixedColor& sum, const Film& film) {
    const auto value = [&](int64_t units) {
        return std::ldexp(static_cast<double>(units), film.radiance_exponent - film.fixed_shift);
    };
    return {value(sum[0]), value(sum[1]), value(sum[2])};
}

double degrees_of(double cosine) {
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

float shown(const PixelReport& report, const std::string& channel) {
    OutputChannels all;
    all.error = all.id = all.samples = all.cost = all.z = all.normal = all.coverage = true;
    all.z_far = std::numeric_limits<float>::infinity();
    for (const LayeredPicture::Channel& one : to_layers(report.tree.film, all).channels)
        if (one.name == channel) return one.values.at(0);
    throw std::invalid_argument("no channel " + channel);
}

size_t middle_sample(int supersample) {
    const auto k = static_cast<size_t>(supersample);
    return k / 2 * k + k / 2;
}

RayCounts rays_of(const PixelTree& tree) {
    RayCounts rays;
    for (const SampleTree& sample : tree.samples) rays.add(sample.rays);
    return rays;
}

}  // namespace cistula
