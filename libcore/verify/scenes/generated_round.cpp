#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "verify/scenes/generated_parts.h"

namespace cistula::generated {
namespace {

class RoundGroup : ObjectMaker {
  public:
    RoundGroup(State& state, const dvec3& center) : ObjectMaker(state), center_(center) {}

    void add_for_loop() {
        const uint32_t kind = random_.below(4);
        if (kind == 0) return add(solid(center_, 0.8), true);
        const Rotation turned(dvec3(0, 0, random_.between(0, 360)));
        const dvec3 middle = kind == 1 ? center_ : dvec3(center_.x, center_.y, floor_height + 0.4);
        add_row(middle, turned(dvec3(1, 0, 0)), kind > 1);
    }

    void add_any() {
        switch (random_.below(15)) {
            case 0:
                return add_row_with_copy();
            case 1:
                return add_shells();
            case 2:
                return add_overlapping();
            case 3:
                return add_cut_by_disk();
            case 4:
                return add_disks();
            case 5:
            case 6:
                return add_fitted();
            case 7:
            case 8:
                return add_on_floor();
            case 9:
            case 10:
                return add_at_plane();
            default:
                add_on_face();
        }
    }

  private:
    void add_ball(const dvec3& center, double radius) {
        cores_.push_back({center, radius});
        add(ball(center, radius), true);
    }

    /// Adds balls in a row, each of which touches the next.
    void add_row(const dvec3& middle, const dvec3& along, bool equal) {
        const uint32_t count = 2 + random_.below(2);
        double radius = equal ? 0.4 : random_.between(0.2, 0.5);
        dvec3 at = middle - 0.4 * (count - 1) * along;
        for (uint32_t i = 0; i < count; ++i) {
            add_ball(at, radius);
            const double next = equal ? radius : random_.between(0.2, 0.5);
            at += (radius + next) * along;
            radius = next;
        }
    }

    /// Adds such a row, whose last ball is there twice.
    void add_row_with_copy() {
        const bool equal = random_.chance(0.5);
        add_row(center_, random_.direction(), equal);
        add(scene_.objects.back().shape, true);
    }

    /// Adds a solid and a ball on one of its faces, from outside or inside, or cut by it; at times with a disk between.
    void add_on_face() {
        const SolidObject s = solid(center_, 0.6);
        const auto& faces = platonic_shape(s.solid).faces;
        const auto& face = faces[random_.below(static_cast<uint32_t>(faces.size()))];
        const dvec3 normal = Rotation(s.rotation)(face.normal);
        const dvec3 middle = s.center + s.radius * platonic_shape(s.solid).inradius * normal;
        const dvec3 corner = world_vertices(s)[face.vertices[0]];
        const dvec3 on = middle + random_.of({0, 0.3}) * (corner - middle);
        const double radius = random_.between(0.2, 0.5);
        const double height = random_.of({1, 1, 1, 0.5, 0, -0.5, -1, -1}) * radius;
        add_of(random_.chance(0.6), s);
        if (random_.chance(0.4)) {
            const double rim = random_.of({0.2, 1});
            add(DiskObject{on, random_.chance(0.5) ? normal : -2.0 * normal, rim}, false);
        }
        add_ball(on + height * normal, radius);
    }

    /// Adds a ball that touches all faces of a solid around it, or all corners of one in it, or misses them by little.
    void add_fitted() {
        const SolidObject s = solid(center_, 0.8);
        const bool inside = random_.chance(0.5);
        const double share = random_.of({1, 1, 0.97, 1.03});
        const double radius = share * s.radius * (inside ? platonic_shape(s.solid).inradius : 1);
        const bool first = random_.chance(0.5);
        if (first) add_ball(center_, radius);
        add_of(random_.chance(0.6), s);
        if (!first) add_ball(center_, radius);
    }

    /// Adds balls one in the other: around one center, or touching from within, or in the same place.
    void add_shells() {
        const uint32_t count = 2 + random_.below(3);
        const bool touching = random_.chance(0.3);
        dvec3 at = center_;
        double radius = random_.between(0.8, 1.1);
        for (uint32_t i = 0; i < count; ++i) {
            add_ball(at, radius);
            const double next = random_.of({0.95, 0.7, 0.5, 1}) * radius;
            if (touching) at += (radius - next) * random_.direction();
            radius = next;
        }
    }

    /// Adds balls that stand on the floor's place, are sunk into it, or lie under it.
    void add_on_floor() {
        for (const double x : {-0.5, 0.5}) {
            const double radius = random_.between(0.2, 0.5);
            const double height = random_.of({1, 1, 0.4, 0, -0.4, -1}) * radius;
            add_ball({center_.x + x, center_.y, floor_height + height}, radius);
        }
    }

    /// Adds a ball and a disk whose rim lies on it, in it, or around it.
    void add_cut_by_disk() {
        const dvec3 normal = random_.chance(0.5) ? dvec3(0, 0, 1) : random_.direction();
        const double radius = random_.between(0.5, 0.9);
        const double height = random_.of({0, 0.3, 0.6, 1});
        const double rim = random_.of({1, 1, 0.6, 1.5}) * (height < 1 ? square_root(1 - height * height) : 1);
        add_ball(center_, radius);
        add(DiskObject{center_ + height * radius * normal, normal, rim * radius}, random_.chance(0.5));
    }

    /// Adds disks in one plane, one across them, and at times balls on either side.
    void add_disks() {
        const dvec3 normal = random_.direction();
        const dvec3 across = normalized(cross(normal, dvec3(normal.y, normal.z, -normal.x)));
        const double radius = random_.between(0.5, 0.9);
        add(DiskObject{center_, normal, radius}, true);
        add(DiskObject{center_ + 0.4 * across, -normal, radius}, true);
        add(DiskObject{center_, across, random_.of({1, 0.5}) * radius}, true);
        if (random_.chance(0.5)) add_ball(center_ + 0.3 * normal + 0.3 * across, 0.3);
        if (random_.chance(0.5)) add_ball(center_ - 0.25 * normal + 0.3 * across, 0.25);
    }

    /// Adds a solid, planes without end through it or in a face's plane, and a ball that touches one or is cut.
    void add_at_plane() {
        const SolidObject s = solid(center_, 0.6);
        const double inradius = s.radius * platonic_shape(s.solid).inradius;
        const dvec3 facing = Rotation(s.rotation)(platonic_shape(s.solid).faces[0].normal);
        const dvec3 up = random_.chance(0.6) ? facing : random_.direction();
        const dvec3 across = normalized(cross(up, dvec3(up.y, up.z, -up.x)));
        const dvec3 on = center_ + random_.of({1, -1, 0.3}) * inradius * up;
        const double radius = random_.between(0.3, 0.6);
        const double height = random_.of({1, 1, 0.5, 0, -1}) * radius;
        const double length = random_.of({1, 3});
        add(DiskObject::plane(length * up, length * dot(up, on)), true);
        add(s, true);
        add_ball(on + 0.8 * across + height * up, radius);
        if (random_.chance(0.4)) add(DiskObject::plane(across, dot(across, center_) - 0.9), true);
    }

    void add_overlapping() {
        const uint32_t count = 2 + random_.below(2);
        for (uint32_t i = 0; i < count; ++i) {
            const dvec3 at = center_ + random_.in_cube(0.4);
            add_ball(at, random_.between(0.4, 0.7));
        }
        if (random_.chance(0.5)) add(solid(center_, 0.7), true);
    }

    const dvec3 center_;
};

}  // namespace

void add_round_group(State& state, const dvec3& center) {
    RoundGroup group(state, center);
    if (state.bodies == Bodies::balls)
        group.add_for_loop();
    else
        group.add_any();
}

}  // namespace cistula::generated
