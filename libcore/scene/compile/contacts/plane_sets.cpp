#include "scene/compile/contacts/plane_sets.h"

#include <algorithm>

#include "cistula/numerics/vec.h"

namespace cistula {

bool PlaneSets::join(uint32_t a, uint32_t b) {
    uint32_t stays = root(a);
    uint32_t goes = root(b);
    if (stays == goes) return true;
    if (FaceTest::is_larger(faces_[set(goes).largest], faces_[set(stays).largest])) std::swap(stays, goes);
    Set &kept = set(stays), &added = set(goes);
    const FlatFace& plane = faces_[kept.largest];
    for (const uint32_t i : added.members) {
        const FlatFace& face = faces_[i];
        if (!test_.lies_in(plane, face, farthest_from(plane, face))) return false;
        const auto apart = apart_.find(i);
        if (apart != apart_.end())
            for (const uint32_t other : apart->second)
                if (root(other) == stays || !stays_apart(face, plane, other)) return false;
        const auto known = kept.along.find(face.solid);
        if (known != kept.along.end() && known->second != (dot(face.normal, plane.normal) > 0)) return false;
    }
    for (const uint32_t i : added.members) {
        if (faces_[i].body->closed) kept.along[faces_[i].solid] = dot(faces_[i].normal, plane.normal) > 0;
        kept.members.push_back(i);
    }
    Set joined = std::move(kept);
    sets_.erase(stays);
    sets_.erase(goes);
    roots_.merge(stays, goes);
    sets_[root(stays)] = std::move(joined);
    return true;
}

bool PlaneSets::stays_apart(const FlatFace& face, const FlatFace& plane, uint32_t other) {
    const FlatFace &over = faces_[other], &its_plane = faces_[set(root(other)).largest];
    const double side = signed_distance(face, over, over.middle) > 0 ? 1 : -1;
    const double turned = dot(face.normal, plane.normal) > 0 ? side : -side;
    const double slope = dot(plane.normal, its_plane.normal);
    const bool first = FaceTest::is_larger(face, over);
    const double least = test_.tolerance(first ? face : over, first ? over : face);
    return std::any_of(over.corners.begin(), over.corners.end(), [&](uint32_t corner) {
        const glm::dvec3& p = over.points()[corner];
        return turned * (signed_distance(plane, over, p) - slope * signed_distance(its_plane, over, p)) > least;
    });
}

PlaneSets::Set& PlaneSets::set(uint32_t root) {
    const auto [found, is_new] = sets_.try_emplace(root);
    if (is_new) {
        found->second = {root, {root}, {}};
        if (faces_[root].body->closed) found->second.along[faces_[root].solid] = true;
    }
    return found->second;
}

}  // namespace cistula
