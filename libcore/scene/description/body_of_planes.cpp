#include <cmath>

#include <fmt/format.h>

#include "base/box.h"
#include "base/error.h"
#include "scene/description/coordinate_rounding.h"
#include "scene/description/polyhedron.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double one_direction = 1e-9;  // sine between planes of one direction

[[noreturn]] void refuse_planes(const std::string& problem, const std::string& remedy) {
    throw Error(ErrorKind::scene, problem, remedy);
}

/// What some planes enclose: its corners, and which of them each plane holds. An edge is what all planes leave of the
/// line of two, so that no point inside needs to be known.
class PlaneBody {
  public:
    explicit PlaneBody(std::span<const BodyPlane> given) : given_(given) {
        take_different();
        require_closed();
        do find_corners();
        while (drop_idle());
    }

    Polyhedron body(std::string_view name) {
        std::vector<BodyFace> faces;
        for (size_t i = 0; i < planes_.size(); ++i) faces.push_back({planes_[i], std::move(on_[i])});
        Polyhedron body = body_of_faces(name, std::move(corners_), std::move(faces));
        body.half_unit = rounding_;
        body.warning = warning();
        return body;
    }

  private:
    [[noreturn]] static void refuse_empty() {
        refuse_planes("no point lies on the inner side of all planes",
                      "normals point outward: inside of [x, y, z, d] the normal times the point is at most d");
    }

    /// Takes the planes with unit normals, of those with one direction the innermost alone.
    void take_different() {
        for (size_t i = 0; i < given_.size(); ++i) {
            const double size = length(given_[i].normal);
            const BodyPlane plane{given_[i].normal / size, given_[i].offset / size};
            const auto same = std::find_if(planes_.begin(), planes_.end(), [&](const BodyPlane& other) {
                const dvec3 sine = cross(other.normal, plane.normal);
                return dot(other.normal, plane.normal) > 0 && dot(sine, sine) < one_direction * one_direction;
            });
            const size_t at = static_cast<size_t>(same - planes_.begin());
            if (at < planes_.size() && !(plane.offset < same->offset)) continue;
            if (at == planes_.size()) planes_.emplace_back(), numbers_.push_back(0);
            planes_[at] = plane, numbers_[at] = i;
        }
    }

    /// Refuses planes that all let go on in one direction: along the line of two, if there are any that cross.
    void require_closed() const {
        bool crossing = false;
        for (size_t i = 0; i < planes_.size(); ++i)
            for (size_t j = 0; j < i; ++j) {
                const dvec3 line = cross(planes_[i].normal, planes_[j].normal);
                if (!(dot(line, line) > one_direction * one_direction)) continue;
                crossing = true;
                for (const dvec3& way : {normalized(line), -normalized(line)})
                    if (std::all_of(planes_.begin(), planes_.end(),
                                    [&](const BodyPlane& p) { return dot(p.normal, way) <= one_direction; }))
                        refuse_planes(fmt::format("the planes leave the body open toward [{:.3g}, {:.3g}, {:.3g}]",
                                                  way.x + 0.0, way.y + 0.0, way.z + 0.0),
                                      "add a plane that faces there");
            }
        if (!crossing) refuse_planes("the planes are parallel and leave the body open", "add planes across them");
    }

    void find_corners() {
        double largest = 0;
        for (const BodyPlane& p : planes_) largest = max_or_second(magnitude(p.offset), largest);
        const std::vector<PlaneEdge> edges = edges_of(planes_, 1e-12 * largest);
        if (edges.empty()) refuse_empty();
        Box box;
        for (const PlaneEdge& edge : edges)
            for (const dvec3& p : edge.ends) box.add(p);
        const double size = 0.5 * largest_component(box.high - box.low);
        const double far = max_or_second(largest_component(box.high), largest_component(-box.low));
        rounding_ = 0;
        for (const size_t number : numbers_) {
            const BodyPlane& plane = given_[number];
            dvec3 turned;
            for (int axis = 0; axis < 3; ++axis) turned[axis] = half_unit_of(plane.normal[axis]);
            const double moved = (length(turned) * far + half_unit_of(plane.offset)) / length(plane.normal);
            rounding_ = max_or_second(moved, rounding_);
        }
        join(edges, in_one_place * size);
    }

    /// Makes corners of the ends of edges: ends near one another are one corner, and shorter edges are none.
    void join(const std::vector<PlaneEdge>& edges, double apart) {
        corners_.clear();
        on_.assign(planes_.size(), {});
        std::vector<double> counts;
        for (const PlaneEdge& edge : edges) {
            const dvec3 along = edge.ends[1] - edge.ends[0];
            if (!(dot(along, along) > apart * apart)) continue;
            for (const dvec3& p : edge.ends) {
                size_t at = 0;
                while (at < corners_.size() && length(p - corners_[at]) > 4 * apart) ++at;
                if (at == corners_.size()) corners_.push_back(p), counts.push_back(0);
                corners_[at] += (p - corners_[at]) / ++counts[at];
                for (const size_t plane : edge.planes) on_[plane].push_back(static_cast<uint32_t>(at));
            }
        }
        for (std::vector<uint32_t>& on : on_) {
            std::sort(on.begin(), on.end());
            on.erase(std::unique(on.begin(), on.end()), on.end());
        }
    }

    /// Drops the planes that hold no face, if there are any.
    bool drop_idle() {
        size_t kept = 0;
        for (size_t i = 0; i < planes_.size(); ++i)
            if (on_[i].size() >= 3) planes_[kept] = planes_[i], numbers_[kept++] = numbers_[i];
        if (kept < 4) refuse_flat_body();
        const bool dropped = kept < planes_.size();
        planes_.resize(kept), numbers_.resize(kept);
        return dropped;
    }

    std::string warning() const {
        constexpr size_t most_named = 8;
        std::string list;
        size_t count = 0;
        for (size_t i = 0; i < given_.size(); ++i) {
            if (std::find(numbers_.begin(), numbers_.end(), i) == numbers_.end() && ++count <= most_named)
                list += fmt::format("{}{}", count > 1 ? ", " : "", i);
        }
        if (count == 0) return "";
        return fmt::format("{} of the planes bound nothing and are left out: {}{}", count, list,
                           count > most_named ? " and others" : "");
    }

    std::span<const BodyPlane> given_;
    std::vector<BodyPlane> planes_;  // with unit normals
    std::vector<size_t> numbers_;    // of each in the list given
    std::vector<dvec3> corners_;
    std::vector<std::vector<uint32_t>> on_;  // corners of each plane, ascending
    double rounding_ = 0;                    // how far rounding of the planes' numbers may have moved a plane
};

/// What all half-spaces leave of the line in which the planes of two meet; false if nothing.
bool cut_line(std::span<const BodyPlane> planes, double slack, PlaneEdge& edge) {
    const BodyPlane &a = planes[edge.planes[0]], &b = planes[edge.planes[1]];
    const dvec3 along = cross(a.normal, b.normal);
    const double square = dot(along, along);
    if (!(square > one_direction * one_direction)) return false;
    const dvec3 origin = (a.offset * cross(b.normal, along) + b.offset * cross(along, a.normal)) / square;
    double low = -INFINITY;
    double high = INFINITY;
    for (size_t k = 0; k < planes.size() && low < high; ++k) {
        if (k == edge.planes[0] || k == edge.planes[1]) continue;
        const double slope = dot(planes[k].normal, along);
        const double rest = planes[k].offset - dot(planes[k].normal, origin);
        if (magnitude(slope) < 1e-12 * square_root(square)) {
            if (rest < -slack) return false;
        } else if (slope > 0) {
            high = min_or_second(rest / slope, high);
        } else {
            low = max_or_second(rest / slope, low);
        }
    }
    edge.ends[0] = origin + low * along;
    edge.ends[1] = origin + high * along;
    return low < high;
}

}  // namespace

std::vector<PlaneEdge> edges_of(std::span<const BodyPlane> planes, double slack) {
    std::vector<PlaneEdge> edges;
    for (size_t i = 0; i < planes.size(); ++i)
        for (size_t j = i + 1; j < planes.size(); ++j) {
            PlaneEdge edge{{i, j}, {}};
            if (cut_line(planes, slack, edge)) edges.push_back(edge);
        }
    return edges;
}

Polyhedron body_of_planes(std::string_view name, std::span<const BodyPlane> planes) {
    return PlaneBody(planes).body(name);
}

}  // namespace cistula
