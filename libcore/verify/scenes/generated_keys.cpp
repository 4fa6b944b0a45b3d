#include <utility>

#include "scene/description/platonic.h"
#include "scene/readers/json_reader.h"
#include "scene/readers/read_scene.h"
#include "verify/scenes/generated_parts.h"

namespace cistula::generated {
namespace {

class Keys : Part {
  public:
    Keys(State& state, double unit) : Part(state), unit_(unit) {}

    void set() {
        std::vector<size_t> moving;
        Json objects = Json::array();
        for (size_t i = 0; i < scene_.objects.size() && moving.size() < 3; ++i) {
            Json object = random_.chance(0.6) ? keyed_object(scene_.objects[i].shape) : Json();
            if (object.is_null()) continue;
            object["material"] = "m";
            objects.push_back(std::move(object));
            moving.push_back(i);
        }
        if (moving.empty()) return;
        const Json file = {{"materials", {{"m", Json::object()}}}, {"objects", objects}};
        const SceneDescription keys = read_scene_text(file.dump(), scene_.source, "");
        const auto set = [keys, moving](SceneDescription& scene, int frame) {
            const SceneDescription shown = at_frame(keys, frame);
            for (size_t k = 0; k < moving.size(); ++k) scene.objects[moving[k]].shape = shown.objects[k].shape;
            scene.shown = frame;
        };
        scene_.motion = std::make_shared<const Motion>(Motion{keys.motion->frames, moving, {}, set});
        scene_ = at_frame(std::move(scene_), static_cast<int>(random_.of({1, 2, 2, 2, 3})));
    }

  private:
    /// An object of a scene's file that has this shape at frame 2; null of meshes, and of solids with a body of their
    /// own or lights on their edges.
    Json keyed_object(const Shape& shape) {
        const dvec3 way = random_.direction();
        const double growth = random_.of({0, 0.3});
        const double turn = random_.of({0, 40});
        const char* interpolation = random_.chance(0.5) ? "linear" : "smooth";
        const auto between = [&](const Json& first, const Json& last) {
            return Json{{"keys", {{0, first}, {4, last}}}, {"interpolation", interpolation}};
        };
        const auto moving = [&](const dvec3& p, const dvec3& by) { return between(list(p - by), list(p + by)); };
        const auto growing = [&](double r) { return between((1 - growth) * r, (1 + growth) * r); };
        if (const auto* ball = std::get_if<SphereObject>(&shape))
            return {{"solid", "sphere"},
                    {"center", moving(ball->center, 0.3 * ball->radius * way)},
                    {"radius", growing(ball->radius)},
                    {"rotate", moving(ball->rotation, dvec3(0, 0, turn))}};
        if (const auto* solid = std::get_if<SolidObject>(&shape);
            solid && !solid->body && solid->edge_lights.count == 0)
            return {{"solid", platonic_name(solid->solid)},
                    {"center", moving(solid->center, 0.3 * solid->radius * way)},
                    {"radius", growing(solid->radius)},
                    {"rotate", moving(solid->rotation, dvec3(0, 0, turn))}};
        const auto* disk = std::get_if<DiskObject>(&shape);
        if (!disk) return nullptr;
        const dvec3& n = disk->normal;
        if (!disk->is_endless())
            return {{"disk",
                     {{"center", moving(disk->center, 0.2 * disk->radius * way)},
                      {"normal", list(n)},
                      {"radius", growing(disk->radius)}}}};
        const double offset = dot(n, disk->center);
        const double step = 0.2 * unit_ * length(n);
        return {{"plane", {n.x, n.y, n.z, between(offset - step, offset + step)}}};
    }

    static Json list(const dvec3& v) { return {v.x, v.y, v.z}; }

    const double unit_;
};

}  // namespace

void set_keys(State& state, double unit) {
    Keys(state, unit).set();
}

}  // namespace cistula::generated
