#include "scene/description/camera_turns.h"

#include <fmt/format.h>

#include "cistula/numerics/trigonometry.h"
#include "scene/description/camera_path.h"

namespace cistula {
namespace {

constexpr size_t most_named = 3;

/// Cosine of the angle between a picture's right and that of the next one, after the least rotation that takes the view
/// of the first to that of the next. 1 where the views are opposite, since no rotation is the least then.
double turn_cosine(const Camera& from, const Camera& to) {
    const double cosine = dot(from.forward, to.forward);
    if (!(1 + cosine > 0x1p-40)) return 1;
    const glm::dvec3 axis = cross(from.forward, to.forward);
    const glm::dvec3 moved = cross(axis, from.right);
    return dot(from.right + moved + cross(axis, moved) / (1 + cosine), to.right);
}

/// The angle with a cosine below 0, in whole degrees.
int degrees_of(double cosine) {
    int degrees = 90;
    while (degrees < 180 && elementary::cos((degrees + 0.5) * (3.14159265358979323846 / 180)) > cosine) ++degrees;
    return degrees;
}

}  // namespace

std::string camera_turns(const CameraDescription& description, const std::vector<int>& frames) {
    if (!description.position_path && !description.target_path) return "";
    std::string places;
    size_t count = 0;
    CameraFrame before;
    for (size_t i = 0; i < frames.size(); ++i) {
        const CameraFrame at = camera_at(description, frames[i]);
        const double cosine = i > 0 && at.frame == before.frame + 1 ? turn_cosine(before.camera, at.camera) : 1;
        before = at;
        if (cosine >= 0 || ++count > most_named) continue;
        places += fmt::format("{}by {} degrees between frames {} and {}", count == 1 ? "" : ", ", degrees_of(cosine),
                              at.frame - 1, at.frame);
    }
    if (count == 0) return "";
    if (count > most_named) places += fmt::format(", and in {} places more", count - most_named);
    return fmt::format("{}: the view passes along up and the picture turns at once: {}", description.place, places);
}

}  // namespace cistula
