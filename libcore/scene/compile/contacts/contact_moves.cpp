#include "scene/compile/contacts/contact_moves.h"

#include <algorithm>
#include <set>

#include "cistula/numerics/vec.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double least_determinant = 0x1p-14;  // of the products of the normals of planes that meet in a vertex

/// Solves the symmetric system m x = r of `size` rows, 3 at most, by Cramer's rule.
struct Gram {
    double m[3][3] = {};
    size_t size;

    double determinant() const {
        if (size == 1) return m[0][0];
        if (size == 2) return m[0][0] * m[1][1] - m[0][1] * m[1][0];
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    }
    double solution(size_t column, const double (&right)[3]) const {
        Gram replaced = *this;
        for (size_t row = 0; row < size; ++row) replaced.m[row][column] = right[row];
        return replaced.determinant() / determinant();
    }
};

/// One body and the faces that are to move.
class BodyMove {
  public:
    BodyMove(ContactBody& body, std::vector<BoundFace>& faces, std::span<const PlaneEquation> planes,
             std::span<const double> plane_areas, double rounding)
        : body_(body), faces_(faces), planes_(planes), areas_(plane_areas), rounding_(rounding), moved_(body.points) {
        std::stable_sort(faces_.begin(), faces_.end(), [&](const BoundFace& a, const BoundFace& b) {
            return areas_[a.plane] != areas_[b.plane] ? areas_[a.plane] > areas_[b.plane] : a.plane < b.plane;
        });
    }

    std::vector<BoundFace> run() {
        std::vector<BoundFace> left;
        while (!faces_.empty()) {
            leaving_.assign(faces_.size(), false);
            place_vertices();
            if (none_leave()) keep_triangles();
            if (none_leave()) break;
            size_t kept = 0;
            for (size_t i = 0; i < faces_.size(); ++i) {
                if (leaving_[i])
                    left.push_back(faces_[i]);
                else
                    faces_[kept++] = faces_[i];
            }
            faces_.resize(kept);
            moved_ = body_.points;
        }
        for (size_t i = 0; i < moved_.size(); ++i)
            if (body_.welded[i] < moved_.size()) moved_[i] = moved_[body_.welded[i]];
        body_.points = std::move(moved_);
        return left;
    }

  private:
    bool none_leave() const { return std::find(leaving_.begin(), leaving_.end(), true) == leaving_.end(); }

    /// Moves each corner into the planes of its faces; marks the faces that cannot have it.
    void place_vertices() {
        struct Corner {
            uint32_t vertex;
            size_t face;
        };
        std::vector<Corner> corners;
        for (size_t i = 0; i < faces_.size(); ++i)
            for (const uint32_t vertex : faces_[i].face->corners) corners.push_back({vertex, i});
        std::stable_sort(corners.begin(), corners.end(),
                         [](const Corner& a, const Corner& b) { return a.vertex < b.vertex; });
        for (size_t first = 0; first < corners.size();) {
            std::vector<PlaneEquation> planes;
            std::vector<uint32_t> numbers;
            const uint32_t vertex = corners[first].vertex;
            dvec3 place = body_.points[vertex];
            double most = 0;
            for (size_t i = first; i < corners.size() && corners[i].vertex == vertex; ++i)
                most = max_or_second(most_moved * faces_[corners[i].face].tolerance, most);
            for (; first < corners.size() && corners[first].vertex == vertex; ++first) {
                const uint32_t number = faces_[corners[first].face].plane;
                if (std::find(numbers.begin(), numbers.end(), number) != numbers.end()) continue;
                if (magnitude(planes_[number].distance(place)) <= rounding_ && planes.size() >= 3) continue;
                planes.push_back(planes_[number]);
                numbers.push_back(number);
                const std::optional<dvec3> nearest = settled(planes, body_.points[vertex]);
                if (nearest && length(*nearest - body_.points[vertex]) <= most) {
                    place = *nearest;
                    continue;
                }
                planes.pop_back();
                if (!(magnitude(planes_[number].distance(place)) <= rounding_)) leaving_[corners[first].face] = true;
            }
            moved_[vertex] = place;
        }
    }

    /// The nearest point on planes; the point itself where only rounding keeps it from them.
    std::optional<dvec3> settled(const std::vector<PlaneEquation>& planes, const dvec3& point) const {
        if (std::all_of(planes.begin(), planes.end(),
                        [&](const PlaneEquation& p) { return magnitude(p.distance(point)) <= rounding_; }))
            return point;
        return nearest_on(planes, point);
    }

    /// Marks the faces at corners of triangles that would turn or lose more than half of their area.
    void keep_triangles() {
        std::set<uint32_t> corners;
        bool any = false;
        for (const auto& facet : body_.facets) {
            const auto area = [&](const std::vector<dvec3>& points) {
                const dvec3 &a = points[body_.welded[facet[0]]], &b = points[body_.welded[facet[1]]],
                            &c = points[body_.welded[facet[2]]];
                return cross(b - a, c - a);
            };
            const dvec3 before = area(body_.points);
            if (!(dot(area(moved_), before) < 0.5 * dot(before, before))) continue;
            any = true;
            for (const uint32_t corner : facet) corners.insert(body_.welded[corner]);
        }
        if (!any) return;
        for (size_t i = 0; i < faces_.size(); ++i)
            for (const uint32_t corner : faces_[i].face->corners)
                if (corners.count(corner) != 0) leaving_[i] = true;
        if (none_leave()) leaving_.assign(faces_.size(), true);
    }

    ContactBody& body_;
    std::vector<BoundFace>& faces_;
    const std::span<const PlaneEquation> planes_;
    const std::span<const double> areas_;
    const double rounding_;
    std::vector<dvec3> moved_;
    std::vector<bool> leaving_;
};

}  // namespace

std::optional<dvec3> nearest_on(std::span<const PlaneEquation> planes, const dvec3& point) {
    if (planes.empty()) return point;
    if (planes.size() > 3) return std::nullopt;
    Gram gram;
    gram.size = planes.size();
    for (size_t i = 0; i < planes.size(); ++i)
        for (size_t j = 0; j < planes.size(); ++j) gram.m[i][j] = dot(planes[i].normal, planes[j].normal);
    if (!(gram.determinant() >= least_determinant)) return std::nullopt;
    dvec3 place = point;
    for (int round = 0; round < 3; ++round) {  // the first leaves the rounding of a long way
        double off[3] = {};
        for (size_t i = 0; i < planes.size(); ++i) off[i] = -planes[i].distance(place);
        dvec3 way(0);
        for (size_t i = 0; i < planes.size(); ++i) way += gram.solution(i, off) * planes[i].normal;
        place += way;
    }
    return place;
}

std::vector<BoundFace> move_into_planes(ContactBody& body, std::vector<BoundFace>& faces,
                                        std::span<const PlaneEquation> planes, std::span<const double> plane_areas,
                                        double rounding) {
    return BodyMove(body, faces, planes, plane_areas, rounding).run();
}

}  // namespace cistula
