#include "scene/compile/contacts/smooth_faces.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <fmt/format.h>

namespace cistula {
namespace {

using glm::dvec3;

constexpr double same_normal = 0x1p-8;    // distance of unit normals that are one
constexpr double widest_corner = 0x1p-4;  // of a triangle's least height: corners that are one are no farther apart
constexpr double moved_apart = 2 * most_moved;  // of a tolerance: corners of two bodies, by what contacts move

/// A part of a solid's surface on a shared plane.
struct Part {
    uint32_t solid, number, plane;
    std::array<dvec3, 3> corners;  // of a triangle
};

dvec3 area_of(const std::array<dvec3, 3>& corners) {
    return cross(corners[1] - corners[0], corners[2] - corners[0]);
}

class SmoothFaceSearch {
  public:
    SmoothFaceSearch(const SceneSource& source, const PlacedBodies& bodies)
        : source_(source), bodies_(bodies), range_(source, bodies.normalization.factor) {
        faces_.kept.resize(source.solids.size());
    }

    SmoothFaces find() {
        collect();
        std::vector<RTCBuildPrimitive> boxes;
        for (uint32_t i = 0; i < parts_.size(); ++i) boxes.push_back(padded_primitive(box_of(parts_[i].corners), 0, i));
        const Tree tree = build_tree(boxes, 0);
        for (const Part& part : parts_) {
            if (!is_smooth(part)) continue;
            source_.stop.check();
            const auto described = described_.find(part.plane);
            uint32_t other = described == described_.end() ? no_solid : described->second;
            any_in_box(tree, box_of(part.corners), [&](uint32_t i) {
                const Part& near = parts_[i];
                if (near.plane == part.plane && &near != &part && spoils(part, near)) other = near.solid;
                return other != no_solid;
            });
            if (other == no_solid)
                faces_.kept[part.solid].push_back(part.number);
            else if (flat_++ == 0)
                first_[0] = part.solid, first_[1] = other;
        }
        if (flat_ > 0)
            faces_.warning = fmt::format(
                "{}: {} smooth triangle{} where bodies touch {} made flat, first against {}: only where "
                "every body there has the same triangles and normals do they stay smooth",
                place_of(first_[0]), flat_, flat_ == 1 ? "" : "s", flat_ == 1 ? "is" : "are", place_of(first_[1]));
        return std::move(faces_);
    }

  private:
    std::string place_of(uint32_t solid) const {
        return source_.solids[solid].place + ": " + name_of(source_.solids[solid]);
    }

    /// Lists the parts on all planes on which a smooth triangle lies, and the planes with faces of described solids.
    void collect() {
        std::set<uint32_t> planes;
        const auto for_each_part = [&](const auto& visit) {
            for (uint32_t i = 0; i < source_.solids.size(); ++i)
                for (const PartOnPlane& on : bodies_.contacts.solids[i].parts) visit(i, on);
        };
        for_each_part([&](uint32_t solid, const PartOnPlane& on) {
            if (is_smooth({solid, on.part, on.plane, {}})) planes.insert(on.plane);
        });
        if (planes.empty()) return;
        for_each_part([&](uint32_t solid, const PartOnPlane& on) {
            if (!planes.contains(on.plane)) return;
            const SourceSolid& from = source_.solids[solid];
            if (from.polyhedron) {
                described_.emplace(on.plane, solid);
                return;
            }
            const NormalizedMesh mesh(from.mesh, bodies_.normalization, bodies_.contacts.solids[solid].points, false);
            parts_.push_back({solid, on.part, on.plane, mesh.triangle(on.part)});
            if (!places_.contains(solid)) places_.emplace(solid, BodyPlace(from, bodies_.normalization.factor));
        });
    }

    bool is_smooth(const Part& part) const {
        const auto& normals = source_.solids[part.solid].normals;
        return !normals.empty() && normals[part.number][0] != dvec3(0);
    }

    /// Whether another part overlaps a smooth triangle without being the same.
    bool spoils(const Part& part, const Part& other) const {
        const double near = corner_tolerance(part, other);
        return overlap(part.corners, other.corners, near) && !(other.solid != part.solid && is_same(part, other, near));
    }

    /// How far apart corners of two parts may be that are one.
    double corner_tolerance(const Part& part, const Part& other) const {
        double rounding = 0, most = INFINITY, longest = 0;
        for (const Part* one : {&part, &other}) {
            const ContactReach& reach = bodies_.contacts.solids[one->solid].reach;
            rounding += length(reach.rounding.half_unit);
            most = min_or_second(reach.most, most);
        }
        for (int c = 0; c < 3; ++c)
            longest = max_or_second(length(part.corners[size_t(c)] - part.corners[size_t(c + 1) % 3]), longest);
        const double moved =
            moved_apart * range_.tolerance(places_.at(part.solid), places_.at(other.solid), rounding, most);
        return min_or_second(widest_corner * length(area_of(part.corners)) / longest, moved);
    }

    /// Whether two triangles have the same corners, and the same normals there once they look to one side.
    bool is_same(const Part& part, const Part& other, double near) const {
        if (!is_smooth(other)) return false;
        const double side = dot(area_of(part.corners), area_of(other.corners)) > 0 ? 1 : -1;
        const auto& own = source_.solids[part.solid].normals[part.number];
        const auto& others = source_.solids[other.solid].normals[other.number];
        for (size_t c = 0; c < 3; ++c) {
            const auto* const nearest =
                std::min_element(other.corners.begin(), other.corners.end(), [&](const dvec3& a, const dvec3& b) {
                    return length(a - part.corners[c]) < length(b - part.corners[c]);
                });
            if (!(length(*nearest - part.corners[c]) <= near)) return false;
            const dvec3& normal = others[size_t(nearest - other.corners.begin())];
            if (!(length(own[c] - side * normal) <= same_normal)) return false;
        }
        return true;
    }

    const SceneSource& source_;
    const PlacedBodies& bodies_;
    const ContactRange range_;
    std::map<uint32_t, BodyPlace> places_;  // of the solids of parts
    std::vector<Part> parts_;
    std::map<uint32_t, uint32_t> described_;  // planes with a face of a solid that is given by planes, and which
    SmoothFaces faces_;
    uint32_t flat_ = 0, first_[2] = {0, 0};
};

}  // namespace

bool SmoothFaces::keeps(uint32_t solid, uint32_t triangle) const {
    return std::binary_search(kept[solid].begin(), kept[solid].end(), triangle);
}

SmoothFaces find_smooth_faces(const SceneSource& source, const PlacedBodies& bodies) {
    return SmoothFaceSearch(source, bodies).find();
}

}  // namespace cistula
