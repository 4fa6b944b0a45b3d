#include "scene/description/camera_path.h"

#include <fmt/format.h>

#include <optional>

#include "base/error.h"
#include "base/suggest.h"
#include "cistula/numerics/trigonometry.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double unit = RealTraits<double>::unit;

/// A point of a path, with a bound on its rounding.
struct PathPoint {
    dvec3 place;
    double rounding;
};

/// Each of r and z is a constant plus a sinusoid. Decimal input, the products and sums in an angle of P = |w t| + |p|,
/// and t itself move the angle by 4 u P at most, and the sinusoid is within 2 u: with its own input, product and sum it
/// is within (5 + 4 P) u of its amplitude. The rotation by phi adds (5 + 4 |phi|) u of r. 8 u (1 + P) covers all.
PathPoint at_time(const CylindricalPath& path, double t) {
    const double r = path.r0 + path.Ar * elementary::sin(path.wr * t + path.pr);
    const double z = path.z0 + path.Az * elementary::sin(path.wz * t + path.pz);
    const double phi = path.phi0 + path.wphi * t;
    const auto angle = [t](double velocity, double start) { return 1 + magnitude(velocity * t) + magnitude(start); };
    const double terms = magnitude(path.r0) + magnitude(path.Ar) * angle(path.wr, path.pr) + magnitude(path.z0) +
                         magnitude(path.Az) * angle(path.wz, path.pz) + magnitude(r) * angle(path.wphi, path.phi0);
    return {{r * elementary::cos(phi), r * elementary::sin(phi), z}, 8 * unit * terms};
}

/// A point as written is within half an ulp of its decimal.
PathPoint as_written(const dvec3& point) {
    return {point, unit * length(point)};
}

struct View {
    dvec3 position, direction;
    double distance;
    double rounding;  // bound on how far rounding turns the direction or `up`, as a sine
};

View view_at(const CameraDescription& description, double time) {
    const PathPoint position =
        description.position_path ? at_time(*description.position_path, time) : as_written(description.position);
    const PathPoint target =
        description.target_path ? at_time(*description.target_path, time) : as_written(description.target);
    const dvec3 view = target.place - position.place;
    const double distance = length(view);
    // 16 u: up as written, 1 u; normalizing it and the view, 3 u each; their cross product, 3 u.
    return {position.place, normalized(view), distance, 16 * unit + (position.rounding + target.rounding) / distance};
}

/// How far off `up` a view must be, in roundings, to say where the picture's right is to within 2^-20 radians.
constexpr double clearly_off = 0x1p20;

/// The right of a view that is more than `roundings` roundings off `up`.
std::optional<dvec3> right_of(const View& view, const dvec3& up, double roundings) {
    const dvec3 right = cross(view.direction, up);
    if (length(right) > roundings * view.rounding) return normalized(right);
    return std::nullopt;
}

/// The camera with the values that keys give it.
CameraDescription held_at(const CameraDescription& description, double frame) {
    return description.at ? description.at(frame) : description;
}

/// The right just before a frame; just after frame 0, which has none before.
std::optional<dvec3> right_beside(const CameraDescription& description, int frame, const dvec3& up) {
    const double side = frame == 0 ? 1 : -1;
    for (double step = 0x1p-32; step <= 1; step *= 2) {
        const double time = frame + side * step;
        const CameraDescription there = held_at(description, time);
        if (const auto right = right_of(view_at(there, time * there.time_step), up, clearly_off)) return right;
    }
    return std::nullopt;
}

/// The right if the position were a little farther from the z axis, or the target where only that has a path.
std::optional<dvec3> right_of_azimuth(const CameraDescription& description, double time, const dvec3& up) {
    const bool of_position = description.position_path.has_value();
    if (!of_position && !description.target_path) return std::nullopt;
    const CylindricalPath& path = of_position ? *description.position_path : *description.target_path;
    const double phi = path.phi0 + path.wphi * time;
    const dvec3 outward{elementary::cos(phi), elementary::sin(phi), 0};
    const dvec3 right = cross(of_position ? -outward : outward, up);
    if (length(right) > clearly_off * 16 * unit) return normalized(right);
    return std::nullopt;
}

/// The axis that is least along the view; of axes that rounding does not tell apart, the first.
dvec3 axis_across(const View& view) {
    int least = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (magnitude(view.direction[axis]) < magnitude(view.direction[least]) - view.rounding) least = axis;
    dvec3 right{0};
    right[least] = 1;
    return right;
}

dvec3 right_along_up(const CameraDescription& moving, const CameraFrame& at, const View& view, const dvec3& up) {
    std::optional<dvec3> right = right_beside(moving, at.frame, up);
    if (!right) right = right_of_azimuth(held_at(moving, at.frame), at.time, up);
    if (!right) right = axis_across(view);
    return normalized(*right - dot(*right, view.direction) * view.direction);
}

}  // namespace

CameraFrame camera_at(const CameraDescription& moving, int frame) {
    const CameraDescription description = held_at(moving, frame);
    CameraFrame result;
    result.frame = frame;
    result.time = frame * description.time_step;
    const View view = view_at(description, result.time);

    const auto refuse = [&](const char* problem, const char* remedy = "") {
        throw Error(ErrorKind::scene, "at frame " + std::to_string(frame) + " " + problem, remedy)
            .at(description.place);
    };
    if (!is_finite(view.direction) || !(view.distance > 0))
        refuse("the camera's position and target coincide", "they must be apart");
    if (!is_finite(description.up) || !(length(description.up) > 0))
        refuse("up is the zero vector", "it must point somewhere, such as [0, 0, 1]");
    if (!(description.field_of_view > 0 && description.field_of_view < 180))
        refuse("the field of view must be above 0 and below 180 degrees");

    const dvec3 up = normalized(description.up);
    Camera& camera = result.camera;
    camera.position = view.position;
    camera.forward = view.direction;
    const std::optional<dvec3> right = right_of(view, up, 1);
    camera.right = right ? *right : right_along_up(moving, result, view, up);
    camera.up = normalized(cross(camera.right, camera.forward));
    camera.tan_half_width = elementary::tan(description.field_of_view * (3.14159265358979323846 / 360));
    return result;
}

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
    if (!description.position_path && !description.target_path && !description.at) return "";
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
