#include "scene/description/camera_path.h"

#include "cistula/numerics/trigonometry.h"
#include "scene/base/error.h"

namespace cistula {
namespace {

glm::dvec3 at_time(const CylindricalPath& path, double t) {
    const double r = path.r0 + path.Ar * elementary::sin(path.wr * t + path.pr);
    const double z = path.z0 + path.Az * elementary::sin(path.wz * t + path.pz);
    const double phi = path.phi0 + path.wphi * t;
    return {r * elementary::cos(phi), r * elementary::sin(phi), z};
}

}  // namespace

CameraFrame camera_at(const CameraDescription& description, int frame) {
    CameraFrame result;
    result.frame = frame;
    result.time = frame * description.time_step;
    const glm::dvec3 position =
        description.position_path ? at_time(*description.position_path, result.time) : description.position;
    const glm::dvec3 target =
        description.target_path ? at_time(*description.target_path, result.time) : description.target;

    const std::string place = "camera at frame " + std::to_string(frame);
    const glm::dvec3 view = target - position;
    if (!is_finite(view) || !(length(view) > 0))
        throw Error(ExitCode::usage, place + ": position and target coincide; they must be apart");
    if (!is_finite(description.up) || !(length(description.up) > 0))
        throw Error(ExitCode::usage, place + ": up is the zero vector; it must point somewhere, such as [0, 0, 1]");
    if (!(description.field_of_view > 0 && description.field_of_view < 180))
        throw Error(ExitCode::usage, place + ": the field of view must be above 0 and below 180 degrees");

    Camera& camera = result.camera;
    camera.position = position;
    camera.forward = normalized(view);
    const glm::dvec3 right = cross(camera.forward, normalized(description.up));
    if (!(length(right) > 1e-9))
        throw Error(ExitCode::usage, place + ": the view is along up; give the camera another up");
    camera.right = normalized(right);
    camera.up = normalized(cross(camera.right, camera.forward));
    camera.tan_half_width = elementary::tan(description.field_of_view * (3.14159265358979323846 / 360));
    return result;
}

}  // namespace cistula
