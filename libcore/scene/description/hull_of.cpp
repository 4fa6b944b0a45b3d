#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <libqhull_r/libqhull_r.h>

#include "base/box.h"
#include "base/error.h"
#include "scene/description/coordinate_rounding.h"
#include "scene/description/polyhedron.h"

namespace cistula {
namespace {

using glm::dvec3;

/// The facets of a hull as Qhull finds them (Barber, Dobkin, Huhdanpaa 1996): planes with all points that are corners
/// of theirs, in no order. Rounding decides which of the facets that lie in one plane are one.
std::vector<BodyFace> facets_of(const std::vector<dvec3>& points) {
    const auto state = std::make_unique<qhT>();
    qhT* qh = state.get();  // as the library's macros have it
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> quiet(std::fopen("/dev/null", "w"), std::fclose);
    qh_zero(qh, quiet.get());
    std::vector<double> numbers;
    for (const dvec3& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    char command[] = "qhull Pp";
    const int status =
        qh_new_qhull(qh, 3, static_cast<int>(points.size()), numbers.data(), false, command, nullptr, quiet.get());
    std::vector<BodyFace> facets;
    if (status == 0) {
        facetT* facet;
        FORALLfacets {
            BodyFace found{{{facet->normal[0], facet->normal[1], facet->normal[2]}, -facet->offset}, {}};
            vertexT *vertex, **vertexp;
            FOREACHvertex_(facet->vertices)
                found.corners.push_back(static_cast<uint32_t>(qh_pointid(qh, vertex->point)));
            facets.push_back(std::move(found));
        }
    }
    qh_freeqhull(qh, !qh_ALL);
    int left, total;
    qh_memfreeshort(qh, &left, &total);
    if (status != 0)
        throw Error(ErrorKind::scene, "the points lie in one plane, or nearly so",
                    "give corners of a body with an inside");
    return facets;
}

/// Joins facets into faces, the largest first, so that slivers do not decide on planes. A face has all corners of the
/// hull that lie in its plane.
std::vector<BodyFace> faces_of(const std::vector<dvec3>& points, std::vector<BodyFace> facets, double flat) {
    std::vector<bool> is_corner(points.size(), false);
    for (BodyFace& facet : facets) {
        for (const uint32_t c : facet.corners) is_corner[c] = true;
        put_in_order(points, facet);
    }
    std::vector<double> sizes;
    std::vector<size_t> order;
    for (const BodyFace& facet : facets) {
        order.push_back(order.size());
        sizes.push_back(length(twice_area(points, facet.corners)));
    }
    const auto before = [&](size_t a, size_t b) {
        return sizes[a] != sizes[b] ? sizes[a] > sizes[b] : facets[a].corners < facets[b].corners;
    };
    std::sort(order.begin(), order.end(), before);
    std::vector<BodyFace> faces;
    for (const size_t i : order) {
        const auto lies_in = [&](const BodyFace& face) {
            return dot(face.plane.normal, facets[i].plane.normal) > 0 &&
                   std::all_of(facets[i].corners.begin(), facets[i].corners.end(), [&](uint32_t c) {
                       return magnitude(dot(face.plane.normal, points[c]) - face.plane.offset) <= flat;
                   });
        };
        if (!(sizes[i] > 0) || std::any_of(faces.begin(), faces.end(), lies_in)) continue;
        if (faces.size() == most_faces)
            throw Error(ErrorKind::scene, fmt::format("the hull has more than {} faces", most_faces),
                        "leave out points that are no corners, or give it as a mesh");
        const BodyFace plane = face_through(points, facets[i].corners);
        BodyFace face{plane.plane, {}};
        for (uint32_t c = 0; c < points.size(); ++c)
            if (is_corner[c] && magnitude(dot(face.plane.normal, points[c]) - face.plane.offset) <= flat)
                face.corners.push_back(c);
        put_in_order(points, face);
        faces.push_back(face_through(points, std::move(face.corners)));
    }
    // Which facets there are depends on rounding in Qhull, the faces do not, nor their order.
    std::sort(faces.begin(), faces.end(), [](const BodyFace& a, const BodyFace& b) { return a.corners < b.corners; });
    return faces;
}

}  // namespace

Polyhedron hull_of(std::string_view name, const std::vector<dvec3>& points) {
    Box box;
    for (const dvec3& p : points) box.add(p);
    const double flat = in_one_place * 0.5 * largest_component(box.high - box.low);
    Polyhedron body = body_of_faces(name, points, faces_of(points, facets_of(points), flat));
    body.half_unit = largest_component(coordinate_rounding(points).half_unit);
    return body;
}

}  // namespace cistula
