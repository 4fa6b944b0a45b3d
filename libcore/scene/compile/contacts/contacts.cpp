#include "scene/compile/contacts/contacts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <set>
#include <unordered_map>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "cistula/geometry/ray.h"
#include "scene/compile/contacts/contact_moves.h"
#include "scene/compile/contacts/plane_sets.h"
#include "scene/compile/solids/smallest_part.h"
#include "scene/description/mesh_source.h"

namespace cistula {
namespace {

using glm::dvec3;

class ContactSearch {
  public:
    ContactSearch(const SceneSource& source, const SceneNormalization& normalization,
                  const std::vector<ConvexSolid>& polyhedra, const std::vector<MeshSize>& sizes,
                  const ContactLimits& limits)
        : source_(source),
          normalization_(normalization),
          polyhedra_(polyhedra),
          sizes_(sizes),
          range_(source, normalization.factor),
          rounding_(2 * RealTraits<double>::unit * normalization.extent),
          exact_(8 * rounding_),
          limits_(limits),
          as_given_(range_, 0),
          as_moved_(range_, exact_) {}

    Contacts run() {
        contacts_.solids.resize(source_.solids.size());
        find_bodies();
        if (faces_.size() == 0) return std::move(contacts_);
        move_into_contact();
        bind_what_coincides();
        return std::move(contacts_);
    }

  private:
    struct Pair {
        double distance;
        uint32_t first, second;
    };
    static constexpr double reach = 4;     // of 2^-20 M: faces that come as near know of one another's planes
    static constexpr double told = 16;     // tolerances without digits: up to there gaps are told of
    static constexpr double above = 1.01;  // more than what rounding and a gap add to half a side

    // ---- bodies and faces

    void find_bodies() {
        const auto count = uint32_t(source_.solids.size());
        std::vector<const ConvexSolid*> planes(count, nullptr);
        size_t next_polyhedron = 0;
        for (uint32_t i = 0; i < count; ++i)
            if (source_.solids[i].polyhedron) planes[i] = &polyhedra_[next_polyhedron++];
        std::vector<Box> boxes(count);
        places_.resize(count);
        tbb::parallel_for(uint32_t(0), count, [&](uint32_t i) {
            boxes[i] = planes[i] ? planes[i]->box : sizes_[i].box;
            places_[i] = BodyPlace(source_.solids[i], normalization_.factor);
            contacts_.solids[i].reach = reach_of(i);
        });
        find_pads(boxes);
        std::vector<double> pads = pads_;
        for (double& pad : pads) pad = max_or_second(reach * tau(), pad);
        const NearSolids& near = near_.emplace(boxes, pads);
        std::vector<uint8_t> wanted(count);
        tbb::parallel_for(uint32_t(0), count, [&](uint32_t i) {
            wanted[i] = !boxes[i].empty() && (near.meets_another(boxes[i], i) || may_overlap_itself(i));
        });
        std::vector<uint32_t> numbers;
        for (uint32_t i = 0; i < count; ++i)
            if (wanted[i]) numbers.push_back(i);
        bodies_.resize(numbers.size());
        found_.resize(numbers.size());
        find_faces([&](size_t b) { return find_body(b, numbers[b], planes[numbers[b]]); });
    }

    /// Finds by how much boxes are grown where what touches or is told of is looked for: by what a body's own size and
    /// digits say, and by the largest tolerance that it has with one that comes near, since what touches a third body
    /// may be so far apart.
    void find_pads(const std::vector<Box>& boxes) {
        const auto count = uint32_t(boxes.size());
        least_told_ = float_may_hold() ? tau() : 2 * exact_;
        farthest_.resize(count);
        pads_.resize(count);
        for (uint32_t i = 0; i < count; ++i)
            pads_[i] =
                max_or_second(contacts_.solids[i].reach.own, max_or_second(told * above * tau_of(i), least_told_ / 2));
        const NearSolids near(boxes, pads_);
        const double in_crowd = max_or_second(largest_own(), tau());
        tbb::parallel_for(uint32_t(0), count, [&](uint32_t i) {
            size_t asked = 0;
            double farthest = contacts_.solids[i].reach.own;
            const bool crowd = near.any_near(boxes[i], i, [&](uint32_t other) {
                farthest = max_or_second(most_between(i, other), farthest);
                return ++asked > most_asked;
            });
            farthest_[i] = crowd ? in_crowd : farthest;
        });
        for (uint32_t i = 0; i < count; ++i) pads_[i] = max_or_second(farthest_[i], pads_[i]);
    }
    static constexpr size_t most_asked = 4096;

    /// 2^-20 of half a body's longest side.
    double tau_of(uint32_t solid) const { return range_.tau(places_[solid], places_[solid]); }

    /// No less than the tolerance of two bodies that come near one another.
    double most_between(uint32_t a, uint32_t b) const {
        const ContactReach &first = contacts_.solids[a].reach, &second = contacts_.solids[b].reach;
        if (range_.given()) return min_or_second(first.own, second.own);
        const double written = most_leverage * (length(first.rounding.half_unit) + length(second.rounding.half_unit));
        return min_or_second(max_or_second(above * (tau_of(a) + tau_of(b)), written),
                             min_or_second(first.most, second.most));
    }
    double largest_own() const {
        double largest = 0;
        for (const SolidContacts& solid : contacts_.solids) largest = max_or_second(solid.reach.own, largest);
        return largest;
    }

    /// Whether no body is so thin that the scene takes double whatever gaps it has.
    bool float_may_hold() const {
        const double least = 0x1p-10 * least_share(Precision::single_) * normalization_.extent;
        for (uint32_t i = 0; i < source_.solids.size(); ++i)
            if (!source_.solids[i].sphere && contacts_.solids[i].reach.most < least) return false;
        return true;
    }

    /// Runs add(first, end, found) for parts of a number of things on all threads, and returns what each part found, in
    /// order.
    template <class Found, class Add>
    static std::vector<Found> find_in_parts(size_t count, const Add& add) {
        constexpr size_t part = 256;
        std::vector<Found> found((count + part - 1) / part);
        tbb::parallel_for(size_t(0), found.size(),
                          [&](size_t i) { add(part * i, std::min(part * (i + 1), count), found[i]); });
        return found;
    }

    /// Finds the faces of a body that may touch some, as given; of a body without any, as moved or given, all is
    /// forgotten. Returns the number of pairs of boxes that were looked at.
    size_t find_body(size_t b, uint32_t solid, const ConvexSolid* planes) {
        size_t asked = 0;
        ContactBody& body = bodies_[b] = body_of(solid, planes);
        found_[b] = faces_that_may_touch(body, as_given_, asked);
        if (found_[b].empty() && faces_that_may_touch(body, as_moved_, asked).empty()) body = {.solid = solid};
        return asked;
    }

    /// Runs find(b) for all bodies on all threads, which returns the number of pairs of boxes that it looked at, and
    /// lists the faces that were found.
    template <class Find>
    void find_faces(const Find& find) {
        tree_ = {};
        std::atomic<size_t> asked{0};
        tbb::parallel_for(size_t(0), bodies_.size(), [&](size_t b) {
            if (asked <= limits_.boxes) asked += find(b);
        });
        const auto solid_of = [&](size_t b) { return bodies_[b].solid; };
        if (asked > limits_.boxes) refuse_crowd(limits_.boxes, find, solid_of, "come near one another");
        size_t count = 0;
        for (const std::vector<FlatFace>& faces : found_) count += faces.size();
        FaceList all;
        all.reserve(count);
        for (std::vector<FlatFace>& faces : found_) all.add(faces);
        tree_ = FaceTree(std::move(all));
    }

    /// The faces of a body that come near another one, or touch one of its own if these count. A flat sheet that has
    /// any brings all.
    std::vector<FlatFace> faces_that_may_touch(ContactBody& body, const FaceTest& test, size_t& asked) const {
        const SourceSolid& from = source_.solids[body.solid];
        std::vector<FlatFace> faces = body.planes           ? polyhedron_faces(body, *from.polyhedron, !test.exact())
                                      : test.exact()        ? single_faces(body)
                                      : body.place->endless ? endless_faces(body)
                                                            : joined_faces(body);
        if (!may_overlap_itself(body.solid)) {
            if (!body.planes)
                std::erase_if(faces,
                              [&](const FlatFace& face) { return !may_come_near_another(face.in_frame, body.solid); });
            faces.shrink_to_fit();
            return faces;
        }
        faces.shrink_to_fit();
        body.flat = test.exact() && test.lie_in_one_plane(faces);
        if (from.disk) return faces;
        FaceList list;
        list.add(faces);
        const FaceTree tree(std::move(list));
        std::vector<bool> wanted(faces.size(), false);
        Box box;
        for (const FlatFace& face : faces) box.add(face.in_frame);
        const bool alone = !may_come_near_another(box, body.solid);
        for (uint32_t i = 0; i < wanted.size(); ++i) {
            const FlatFace& face = faces[i];
            if (!alone && may_come_near_another(face.in_frame, body.solid)) wanted[i] = true;
            tree.any_near(i, body.pad, asked, [&](uint32_t j) {
                const FlatFace& other = faces[j];
                if (j > i && test.touching(face, other, test.distance(face, other)) &&
                    (!test.exact() || FaceTest::overlapping(face, other)))
                    wanted[i] = wanted[j] = true;
                return false;
            });
            if (!wanted[i] && face.parts.size() > 1) wanted[i] = FaceTest::overlapping(face, face);
        }
        if (std::find(wanted.begin(), wanted.end(), true) == wanted.end()) return {};
        if (!body.flat) std::erase_if(faces, [&](const FlatFace& face) { return !wanted[face.number]; });
        faces.shrink_to_fit();
        return faces;
    }

    /// Whether what is in a box may come near another solid where contacts move both.
    bool may_come_near_another(const Box& box, uint32_t solid) const {
        return near_->meets_another(padded(box, 2 * most_moved * pads_[solid]), solid);
    }

    /// Moves what touches, but for the digits of a file, into one plane.
    void move_into_contact() {
        PlaneSets sets(faces_, as_given_);
        find_pairs(as_given_);
        for (const Pair& pair : parted_) sets.part(pair.first, pair.second);
        join_pairs(sets, as_given_);
        for (const Pair& pair : closed_)
            if (!joins(sets, pair.first, pair.second) && !joins(sets, pair.second, pair.first)) refuse_gap(pair);
        closed_.clear();
        move_bodies(sets);
    }

    /// Whether a face shares a plane with any of another's solid, so that between the two is that solid itself.
    bool joins(PlaneSets& sets, uint32_t face, uint32_t other) const {
        const std::vector<uint32_t>& members = sets.set(sets.root(face)).members;
        return std::any_of(members.begin(), members.end(),
                           [&](uint32_t i) { return faces_[i].solid == faces_[other].solid; });
    }

    /// Refuses a gap that stays open and that rounding in double closes.
    [[noreturn]] void refuse_gap(const Pair& pair) const {
        const uint32_t a = faces_[pair.first].solid, b = faces_[pair.second].solid;
        const SourceSolid &first = source_.solids[std::min(a, b)], &second = source_.solids[std::max(a, b)];
        throw scene_error(
            *source_.description, second.place,
            fmt::format("{} is {:.2g} from {}: {}, and double precision does not hold that gap in a scene "
                        "that reaches {:.2g} far",
                        name_of(second), pair.distance / normalization_.factor, first.place, name_of(first),
                        normalization_.extent / normalization_.factor),
            "bring what is far away nearer, or close the gap");
    }

    /// The distance, as given, of faces in the frame that coincide only since what is far away makes rounding more than
    /// their tolerance; 0 of others.
    double closed_gap(const FlatFace& a, const FlatFace& b) const {
        const double most = min_or_second(a.body->reach.most, b.body->reach.most);
        const double tau = range_.tau(*a.body->place, *b.body->place);
        if (min_or_second(tau, most) > 4 * exact_) return 0;
        for (const uint32_t plane : joined_[number_of(a)])
            for (const uint32_t other : joined_[number_of(b)])
                if (plane == other) return 0;
        const FlatFace first = seen(a, true, source_.solids[a.solid]), second = seen(b, true, source_.solids[b.solid]);
        const double gap = as_given_.distance(first, second);
        constexpr double alone = 0x1p-29;  // of tau: 16 u M of double in a scene of the two
        const bool both_endless = first.is_endless() && second.is_endless();
        const bool holds = gap <= alone * tau || gap > 4 * exact_ || !FaceTest::meeting(first, second, 2 * gap) ||
                           (both_endless && as_given_.touching(first, second, gap));
        return holds ? 0 : gap;
    }

    /// Finds the planes of what now lies in one plane, to within rounding: the faces that were moved, and those that
    /// coincided from the start and could not be moved, as of two equal curved meshes, each of whose vertices lies in
    /// many planes.
    void bind_what_coincides() {
        find_faces([&](size_t b) {
            size_t asked = 0;
            found_[b] = faces_that_may_touch(bodies_[b], as_moved_, asked);
            return asked;
        });
        pairs_.clear();
        PlaneSets sets(faces_, as_moved_);
        find_flat_sheets();
        find_pairs(as_moved_);
        if (!closed_.empty()) refuse_gap(closed_.front());
        join_pairs(sets, as_moved_);
        list_planes();
    }

    ContactReach reach_of(uint32_t number) const {
        const SourceSolid& solid = source_.solids[number];
        ContactReach reach;
        reach.given = range_.given();
        reach.rounding = solid.mesh.rounding;
        double thickness = solid.closed ? 3 * solid.thickness * normalization_.factor : sizes_[number].half_width;
        if (const SolidObject* polyhedron = solid.polyhedron) {
            const Polyhedron& body = polyhedron_of(*polyhedron);
            thickness = body.inradius * polyhedron->radius * normalization_.factor;
            const double of_size = half_unit_of(polyhedron->radius) * body.reach + polyhedron->radius * body.half_unit;
            for (int axis = 0; axis < 3; ++axis)
                reach.rounding.half_unit[axis] = half_unit_of(polyhedron->center[axis]) + of_size;
            reach.rounding.digits = -1;
        }
        reach.rounding.half_unit *= normalization_.factor;
        const BodyPlace& place = places_[number];
        reach.most = place.endless ? INFINITY : 0x1p-10 * thickness;
        reach.own = range_.tolerance(place, place, 2 * length(reach.rounding.half_unit), reach.most);
        return reach;
    }

    bool may_overlap_itself(uint32_t solid) const {
        const SourceSolid& from = source_.solids[solid];
        return !from.closed && from.mesh.triangles.size() <= most_in_full;
    }

    ContactBody body_of(uint32_t number, const ConvexSolid* planes) const {
        const SourceSolid& from = source_.solids[number];
        ContactBody body;
        body.solid = number;
        body.closed = from.closed;
        body.reach = contacts_.solids[number].reach;
        body.planes = planes;
        body.place = &places_[number];
        body.pad = pads_[number];
        body.given = body.place->vertices(from, normalization_.factor);
        if (planes) {
            body.points = planes->vertices;
            body.facets = triangulated(polyhedron_of(*from.polyhedron));
        } else {
            body.points.reserve(from.mesh.vertices.size());
            for (const dvec3& p : from.mesh.vertices) body.points.push_back(normalization_.point(p));
            body.facets.assign(from.mesh.triangles.begin(), from.mesh.triangles.end());
        }
        body.welded = weld(body.place->endless ? body.points : body.given);
        if (planes) return body;
        const bool all = from.mesh.triangles.size() <= most_in_full;
        const auto find_near = [&](size_t first, size_t end, std::vector<uint32_t>& found) {
            for (auto t = uint32_t(first); t < end; ++t) {
                Box box;
                for (const uint32_t corner : body.facets[t]) box.add(body.points[corner]);
                if (all || near_->meets_another(box, number)) found.push_back(t);
            }
        };
        for (const auto& found : find_in_parts<std::vector<uint32_t>>(body.facets.size(), find_near))
            body.near.insert(body.near.end(), found.begin(), found.end());
        return body;
    }

    /// Keeps flat, of the sheets that lie in one plane, those that overlap themselves or touch something.
    void find_flat_sheets() {
        std::vector<bool> meets(bodies_.size(), false);
        const auto find = [&](uint32_t i, std::vector<size_t>& found) {
            if (faces_[i].body->flat && in_contact_with_any(i)) found.push_back(number_of(faces_[i]));
        };
        for (const auto& found : sweep_faces<std::vector<size_t>>(find))
            for (const size_t b : found) meets[b] = true;
        for (size_t b = 0; b < bodies_.size(); ++b)
            bodies_[b].flat = bodies_[b].flat && (meets[b] || source_.solids[bodies_[b].solid].disk);
    }

    /// Whether a face touches one of another solid, or overlaps a later one of its own.
    bool in_contact_with_any(uint32_t i) const {
        return any_near(i, faces_[i].body->pad, [&](uint32_t j) {
            const FlatFace &a = faces_[i], &b = faces_[j];
            const bool one_solid = a.solid == b.solid;
            return (j > i || !one_solid) && as_moved_.touching(a, b, as_moved_.distance(a, b)) &&
                   (!one_solid || FaceTest::overlapping(a, b));
        });
    }

    // ---- pairs and sets

    size_t number_of(const FlatFace& face) const { return size_t(face.body - bodies_.data()); }

    /// A face of a solid that could not be moved into the plane of another's.
    struct LeftFace {
        uint32_t solid, other;
        std::vector<uint32_t> parts;
    };

    /// Pairs of faces, found in a part: those that touch, those that lie over one another apart, where a third one may
    /// join them, those that nearly touch, and those of a gap that double closes.
    struct FoundPairs {
        std::vector<Pair> touching, parted, near, closed;
        size_t size() const { return touching.size() + parted.size() + near.size(); }
    };

    void find_pairs(const FaceTest& test) {
        std::atomic<size_t> kept{0};
        const auto find = [&](uint32_t i, FoundPairs& found) {
            if (kept <= limits_.touching) kept += find_pairs_of(i, test, found);
        };
        std::vector<FoundPairs> parts = sweep_faces<FoundPairs>(find);
        const auto solid_of = [&](uint32_t i) { return faces_[i].solid; };
        const auto pairs_of = [&](uint32_t i) {
            FoundPairs found;
            return find_pairs_of(i, test, found);
        };
        if (kept > limits_.touching) refuse_crowd(limits_.touching, pairs_of, solid_of, "touch or nearly touch");
        for (FoundPairs& found : parts) {
            for (std::vector<Pair>* pairs : {&found.near, &found.closed})
                std::sort(pairs->begin(), pairs->end(), [](const Pair& a, const Pair& b) {
                    return a.first != b.first ? a.first < b.first : a.second < b.second;
                });
            pairs_.insert(pairs_.end(), found.touching.begin(), found.touching.end());
            parted_.insert(parted_.end(), found.parted.begin(), found.parted.end());
            closed_.insert(closed_.end(), found.closed.begin(), found.closed.end());
            for (const Pair& near : found.near)
                add_near(faces_[near.first], faces_[near.second], near.distance, contacts_.near);
        }
    }

    /// Calls find(i, found) for all faces on all threads, and returns what each part of them found, in order.
    template <class Found, class Find>
    std::vector<Found> sweep_faces(const Find& find) {
        looked_at_ = 0;
        const auto find_all = [&](size_t first, size_t end, Found& found) {
            for (auto i = uint32_t(first); i < end && looked_at_ <= limits_.boxes; ++i) find(i, found);
        };
        std::vector<Found> parts = find_in_parts<Found>(faces_.size(), find_all);
        const auto solid_of = [&](uint32_t i) { return faces_[i].solid; };
        const auto boxes_near = [&](uint32_t i) {
            size_t count = 0;
            any_near(i, faces_[i].body->pad, [&](uint32_t) { return ++count, false; });
            return count;
        };
        if (looked_at_ > limits_.boxes) refuse_crowd(limits_.boxes, boxes_near, solid_of, "come near one another");
        return parts;
    }

    /// Whether found(j) holds for a face other than i whose box meets that of i, grown by `pad`; asks no further once
    /// it does.
    template <class Found>
    bool any_near(uint32_t i, double pad, const Found& found) const {
        size_t asked = 0;
        const bool any = tree_.any_near(i, pad, asked, found);
        looked_at_ += asked;
        return any;
    }

    /// Adds the later faces that touch a face or nearly do. Returns their number.
    size_t find_pairs_of(uint32_t i, const FaceTest& test, FoundPairs& found) const {
        const size_t before = found.size();
        const bool with_own = may_overlap_itself(faces_[i].solid);
        any_near(i, faces_[i].body->pad, [&](uint32_t j) {
            if (j > i && (with_own || faces_[i].solid != faces_[j].solid)) compare(i, j, test, found);
            return false;
        });
        return found.size() - before;
    }

    /// Refuses the scene at the first face or body up to which there are more than `most` pairs, count(i) of each: no
    /// order of threads decides which.
    template <class Count, class SolidOf>
    [[noreturn]] void refuse_crowd(size_t most, const Count& count, const SolidOf& solid,
                                   const std::string& what) const {
        uint32_t i = 0;
        for (size_t sum = 0; (sum += count(i)) <= most;) ++i;
        throw scene_error(*source_.description, source_.solids[solid(i)].place,
                          "more than " + std::to_string(most / 1'000'000) + " million pairs of faces " + what +
                              ", as where many objects are in one place",
                          "leave out those that are there several times");
    }
    void compare(uint32_t i, uint32_t j, const FaceTest& test, FoundPairs& found) const {
        const FlatFace &a = faces_[i], &b = faces_[j];
        const bool one_solid = a.solid == b.solid;
        const double distance = test.distance(a, b);
        if (test.touching(a, b, distance)) {
            if (!one_solid || !test.exact() || a.body->flat || FaceTest::overlapping(a, b))
                found.touching.push_back({distance, i, j});
            if (const double gap = one_solid || !test.exact() ? 0 : closed_gap(a, b); gap > 0)
                found.closed.push_back({gap, i, j});
        } else if (!test.exact() && !one_solid && distance <= told_between(a, b) && boxes_touch(a, b, 2 * distance) &&
                   magnitude(dot(a.normal, b.normal)) > 0.5 && FaceTest::meeting(a, b, 2 * distance)) {
            if (distance <= farthest_[a.solid] + farthest_[b.solid] && FaceTest::overlapping(a, b))
                found.parted.push_back({distance, i, j});
            if (distance <= 2 * exact_) found.closed.push_back({distance, i, j});
            found.near.push_back({distance, i, j});
        }
    }

    /// Up to which distance two faces are told of: what float closes, too, where it may hold the scene.
    double told_between(const FlatFace& a, const FlatFace& b) const {
        const double joined = farthest_[a.solid] + farthest_[b.solid];
        return max_or_second(warned_between(a, b), max_or_second(joined, least_told_));
    }
    /// Up to which distance a longer "contact" is said to join two faces.
    double warned_between(const FlatFace& a, const FlatFace& b) const {
        return range_.given() ? 0 : told * range_.tau(*a.body->place, *b.body->place);
    }

    double tau() const { return 0x1p-20 * normalization_.extent; }

    void add_near(const FlatFace& a, const FlatFace& b, double gap, std::vector<NearPair>& to) {
        const uint32_t first = std::min(a.solid, b.solid);
        const uint32_t second = std::max(a.solid, b.solid);
        const bool joined =
            gap <= warned_between(a, b) && 1.1 * gap <= min_or_second(a.body->reach.most, b.body->reach.most);
        const auto known =
            near_solids_.try_emplace((uint64_t(first) << 32 | second) << 1 | (&to == &contacts_.near), to.size());
        if (known.second)
            to.push_back({{first, second}, gap, joined});
        else if (NearPair& pair = to[known.first->second]; gap < pair.gap)
            pair = {{first, second}, gap, joined};
    }

    void join_pairs(PlaneSets& sets, const FaceTest& test) {
        tbb::parallel_sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
            if (a.distance != b.distance) return a.distance < b.distance;
            return a.first != b.first ? a.first < b.first : a.second < b.second;
        });
        for (const Pair& pair : pairs_)
            if (!sets.join(pair.first, pair.second) && !test.exact())
                add_near(faces_[pair.first], faces_[pair.second], pair.distance, contacts_.apart);
        bind_sets(sets);
    }

    /// Gives each set that is a contact a plane, and its faces the plane's number.
    void bind_sets(PlaneSets& sets) {
        equations_.clear(), areas_.clear(), middles_.clear();
        plane_.assign(faces_.size(), no_plane);
        std::vector<bool> wanted(faces_.size(), false);
        for (const Pair& pair : pairs_)
            if (sets.root(pair.first) == sets.root(pair.second) &&
                (faces_[pair.first].solid != faces_[pair.second].solid ||
                 FaceTest::overlapping(faces_[pair.first], faces_[pair.second])))
                wanted[sets.root(pair.first)] = true;
        for (uint32_t i = 0; i < faces_.size(); ++i)
            if (may_overlap_itself(faces_[i].solid) && faces_[i].parts.size() > 1 &&
                FaceTest::overlapping(faces_[i], faces_[i]))
                wanted[sets.root(i)] = true;
        for (uint32_t i = 0; i < faces_.size(); ++i)
            if (source_.solids[faces_[i].solid].disk) wanted[sets.root(i)] = true;  // alone, too
        for (uint32_t i = 0; i < faces_.size(); ++i) {
            if (sets.root(i) != i || !wanted[i]) continue;
            const PlaneSets::Set& set = sets.set(i);
            const FlatFace& largest = faces_[set.largest];
            for (const uint32_t member : set.members) plane_[member] = uint32_t(equations_.size());
            const FlatFace there = seen(largest, false, source_.solids[largest.solid]);
            equations_.push_back({there.normal, there.offset});
            areas_.push_back(largest.area);
            middles_.push_back(there.middle);
        }
    }

    // ---- moves

    void move_bodies(PlaneSets& sets) {
        std::vector<std::vector<BoundFace>> bound(bodies_.size());
        std::vector<double> largest(equations_.size(), 0);
        const auto plane_face = [&](uint32_t i) -> const FlatFace& { return faces_[sets.set(sets.root(i)).largest]; };
        for (uint32_t i = 0; i < faces_.size(); ++i)
            if (plane_[i] != no_plane && &plane_face(i) != &faces_[i])
                largest[plane_[i]] = max_or_second(most_moved_into(plane_face(i), faces_[i]), largest[plane_[i]]);
        for (uint32_t i = 0; i < faces_.size(); ++i) {
            if (plane_[i] == no_plane) continue;
            const bool is_plane = &plane_face(i) == &faces_[i];
            const double most = is_plane ? largest[plane_[i]] : most_moved_into(plane_face(i), faces_[i]);
            bound[number_of(faces_[i])].push_back({&faces_[i], plane_[i], most});
        }
        std::vector<std::vector<BoundFace>> left(bodies_.size());
        std::vector<double> farthest(bodies_.size(), 0);
        tbb::parallel_for(size_t(0), bodies_.size(), [&](size_t b) {
            if (bound[b].empty()) return;
            ContactBody& body = bodies_[b];
            const std::vector<dvec3> given = body.points;
            left[b] = move_into_planes(body, bound[b], equations_, areas_, rounding_);
            for (size_t i = 0; i < given.size(); ++i)
                if (body.welded[i] != no_vertex)
                    farthest[b] = max_or_second(length(body.points[i] - given[i]), farthest[b]);
        });
        joined_.resize(bodies_.size());
        for (size_t b = 0; b < bodies_.size(); ++b) {
            ContactBody& body = bodies_[b];
            for (const BoundFace& face : bound[b])
                if (joined_[b].empty() || joined_[b].back() != face.plane) joined_[b].push_back(face.plane);
            for (const BoundFace& face : left[b]) leave(face, sets);
            if (!(farthest[b] > 0)) continue;
            body.moved = true;
            contacts_.solids[body.solid].points = body.points;
            if (farthest[b] > contacts_.farthest_move)
                contacts_.farthest_move = farthest[b], contacts_.moved = body.solid;
        }
    }

    double most_moved_into(const FlatFace& plane, const FlatFace& face) const {
        return max_or_second(as_given_.tolerance(plane, face), farthest_from(plane, face));
    }

    /// Takes a face out of its plane.
    void leave(const BoundFace& left, PlaneSets& sets) {
        const uint32_t face = left.face->number;
        plane_[face] = no_plane;
        const FlatFace& other = faces_[sets.set(sets.root(face)).largest];
        if (other.solid == left.face->solid) return;
        add_near(*left.face, other, farthest_from(other, *left.face), contacts_.apart);
        left_.push_back({left.face->solid, other.solid, {left.face->parts.begin(), left.face->parts.end()}});
    }

    // ---- results

    void list_planes() {
        std::vector<uint32_t> number(equations_.size(), no_plane);
        std::vector<const FlatFace*> first(equations_.size(), nullptr);
        std::vector<bool> needed(equations_.size(), false);
        for (uint32_t i = 0; i < faces_.size(); ++i) {
            const uint32_t plane = plane_[i];
            if (plane == no_plane) continue;
            if (!first[plane]) first[plane] = &faces_[i];
            needed[plane] =
                needed[plane] || first[plane]->solid != faces_[i].solid || may_overlap_itself(faces_[i].solid);
        }
        for (uint32_t i = 0; i < faces_.size(); ++i) {
            const uint32_t plane = plane_[i];
            if (plane == no_plane || !needed[plane]) {
                plane_[i] = no_plane;
                continue;
            }
            if (number[plane] == no_plane) {
                number[plane] = uint32_t(contacts_.planes.size());
                contacts_.planes.push_back({equations_[plane].normal, middles_[plane], {}});
            }
            plane_[i] = number[plane];
            SolidContacts& solid = contacts_.solids[faces_[i].solid];
            for (const uint32_t part : faces_[i].parts) solid.parts.push_back({part, plane_[i]});
            solid.near.push_back(plane_[i]);
            std::vector<dvec3>& corners = contacts_.planes[plane_[i]].corners;
            for (const uint32_t corner : faces_[i].corners) corners.push_back(faces_[i].body->points[corner]);
        }
        list_near();
        forget_joined();
        for (const Pair& pair : pairs_) contacts_.pairs += in_contact(pair) && !of_one_disk(pair);
        const auto earliest = std::min_element(pairs_.begin(), pairs_.end(),
                                               [&](const Pair& a, const Pair& b) { return order_of(a) < order_of(b); });
        if (earliest != pairs_.end() && in_contact(*earliest)) {
            contacts_.first[0] = faces_[earliest->first].solid;
            contacts_.first[1] = faces_[earliest->second].solid;
        }
    }

    /// Takes out of the pairs that could not be moved into one plane those that lie in one all the same, with every
    /// face that was left at first.
    void forget_joined() {
        if (contacts_.apart.empty()) return;
        std::set<std::pair<uint32_t, uint32_t>> joined;
        for (const Pair& pair : pairs_)
            if (in_contact(pair)) joined.insert(std::minmax(faces_[pair.first].solid, faces_[pair.second].solid));
        std::set<std::pair<uint32_t, uint32_t>> planes;  // of each solid
        for (uint32_t i = 0; i < faces_.size(); ++i)
            if (plane_[i] != no_plane) planes.insert({faces_[i].solid, plane_[i]});
        for (const LeftFace& left : left_)
            if (std::none_of(left.parts.begin(), left.parts.end(), [&](uint32_t part) {
                    return planes.contains({left.other, contacts_.plane_of(left.solid, part)});
                }))
                joined.erase(std::minmax(left.solid, left.other));
        std::erase_if(contacts_.apart, [&](const NearPair& pair) {
            return joined.contains({pair.solids[0], pair.solids[1]});
        });
    }

    bool of_one_disk(const Pair& pair) const {
        const uint32_t solid = faces_[pair.first].solid;
        return source_.solids[solid].disk && faces_[pair.second].solid == solid;
    }
    bool in_contact(const Pair& pair) const {
        return plane_[pair.first] != no_plane && plane_[pair.first] == plane_[pair.second];
    }
    /// Pairs of two solids first, by their faces; those that are not in contact last.
    std::tuple<bool, bool, uint32_t, uint32_t> order_of(const Pair& pair) const {
        return {!in_contact(pair), faces_[pair.first].solid == faces_[pair.second].solid, pair.first, pair.second};
    }

    void list_near() {
        using SolidAndPlane = std::pair<uint32_t, uint32_t>;
        const auto find = [&](uint32_t i, std::vector<SolidAndPlane>& found) {
            if (plane_[i] == no_plane) return;
            std::set<uint32_t> reached;
            any_near(i, 2 * reach * tau(), [&](uint32_t j) {
                if (faces_[j].solid != faces_[i].solid && boxes_touch(faces_[i], faces_[j], 2 * reach * tau()))
                    reached.insert(faces_[j].solid);
                return false;
            });
            for (const uint32_t solid : reached) found.emplace_back(solid, plane_[i]);
        };
        for (const auto& found : sweep_faces<std::vector<SolidAndPlane>>(find))
            for (const auto& [solid, plane] : found) contacts_.solids[solid].near.push_back(plane);
        list_near_endless();
        for (SolidContacts& solid : contacts_.solids) {
            std::sort(solid.near.begin(), solid.near.end());
            solid.near.erase(std::unique(solid.near.begin(), solid.near.end()), solid.near.end());
            std::sort(solid.parts.begin(), solid.parts.end(),
                      [](const PartOnPlane& a, const PartOnPlane& b) { return a.part < b.part; });
        }
    }

    /// Planes without end meet one another, if not in the scene's box.
    void list_near_endless() {
        std::vector<uint32_t> solids, planes;
        for (uint32_t i = 0; i < source_.solids.size(); ++i)
            if (const DiskObject* disk = source_.solids[i].disk; disk && disk->is_endless()) {
                solids.push_back(i);
                planes.insert(planes.end(), contacts_.solids[i].near.begin(), contacts_.solids[i].near.end());
            }
        for (const uint32_t i : solids)
            contacts_.solids[i].near.insert(contacts_.solids[i].near.end(), planes.begin(), planes.end());
    }

    const SceneSource& source_;
    const SceneNormalization& normalization_;
    const std::vector<ConvexSolid>& polyhedra_;
    const std::vector<MeshSize>& sizes_;
    ContactRange range_;
    const double rounding_;  // what lies as near to a plane lies in it
    const double exact_;     // how near to its plane what was moved into it lies
    Contacts contacts_;
    const ContactLimits limits_;
    const FaceTest as_given_, as_moved_;  // before and after things are moved into one plane
    std::vector<BodyPlace> places_;       // of each solid; with the next two
    std::vector<double> farthest_;        // no two faces that touch the same are farther apart than the sum of theirs
    std::vector<double> pads_;
    double least_told_ = 0;  // gaps that are told of whatever the bodies
    std::optional<NearSolids> near_;
    std::vector<ContactBody> bodies_;
    std::vector<std::vector<FlatFace>> found_;   // of each body
    std::vector<std::vector<uint32_t>> joined_;  // of each body the planes into which it was moved
    std::vector<LeftFace> left_;
    FaceTree tree_;
    const FaceList& faces_ = tree_.faces;
    mutable std::atomic<size_t> looked_at_{0};  // pairs of boxes in this sweep
    std::vector<Pair> pairs_, parted_, closed_;
    std::unordered_map<uint64_t, size_t> near_solids_;
    std::vector<uint32_t> plane_;  // of each face
    std::vector<PlaneEquation> equations_;
    std::vector<double> areas_;  // of the largest face on each plane
    std::vector<dvec3> middles_;
};

}  // namespace

uint32_t Contacts::plane_of(uint32_t solid, uint32_t part) const {
    const std::vector<PartOnPlane>& parts = solids[solid].parts;
    const auto found = std::lower_bound(parts.begin(), parts.end(), part,
                                        [](const PartOnPlane& a, uint32_t wanted) { return a.part < wanted; });
    return found != parts.end() && found->part == part ? found->plane : no_plane;
}

std::vector<std::string> contact_warnings(const SceneSource& source, const SceneNormalization& normalization,
                                          const Contacts& contacts) {
    std::vector<std::string> warnings;
    const auto add = [&](const std::vector<const NearPair*>& pairs, const std::string& rest) {
        const SourceSolid &first = source.solids[pairs[0]->solids[0]], &second = source.solids[pairs[0]->solids[1]];
        const size_t others = pairs.size() - 1;
        warnings.push_back(second.place + ": " + name_of(second) + " and " + first.place + ": " + name_of(first) +
                           " have faces that " + rest +
                           (others == 0 ? "" : fmt::format(" (and so for {} other pairs of objects)", others)));
    };
    std::vector<const NearPair*> near, apart;
    for (const NearPair& pair : contacts.near)
        if (pair.joined) near.push_back(&pair);
    for (const NearPair& pair : contacts.apart) apart.push_back(&pair);
    if (!near.empty()) {
        const double gap = near[0]->gap / normalization.factor;
        add(near, fmt::format("are {:.2g} apart and do not touch; \"contact\": {:.2g} joins them", gap, 1.1 * gap));
    }
    if (!apart.empty())
        add(apart,
            "touch but cannot be moved into one plane: rays may go wrong there; give more digits, or move them apart");
    return warnings;
}

Contacts find_contacts(const SceneSource& source, const SceneNormalization& normalization,
                       const std::vector<ConvexSolid>& polyhedra, const std::vector<MeshSize>& sizes,
                       const ContactLimits& limits) {
    return ContactSearch(source, normalization, polyhedra, sizes, limits).run();
}

}  // namespace cistula
