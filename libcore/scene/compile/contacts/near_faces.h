// Faces that come near one another, and what decides whether two of them touch (docs/rules.md, 11, A3 and A5). Private
// to libcore/scene.
#pragma once

#include <vector>

#include "scene/compile/contacts/flat_faces.h"

namespace cistula {

/// Some faces, wherever they are kept. Each has its number here.
class FaceList {
  public:
    const FlatFace& operator[](size_t i) const { return *faces_[i]; }
    uint32_t size() const { return uint32_t(faces_.size()); }
    void reserve(size_t count) { faces_.reserve(count); }
    void add(std::vector<FlatFace>& faces) {
        for (FlatFace& face : faces) face.number = size(), faces_.push_back(&face);
    }

  private:
    std::vector<const FlatFace*> faces_;
};

/// What decides whether two faces of one list touch. Of two of one size the earlier is the larger.
class FaceTest {
  public:
    /// `exact`: how far faces may be apart if that is above 0; else what `range` and their bodies say. `least`: by how
    /// much what overlaps does.
    FaceTest(const ContactRange& range, double exact, double least) : range_(range), exact_(exact), least_(least) {}

    bool exact() const { return exact_ > 0; }
    static bool is_larger(const FlatFace& a, const FlatFace& b) {
        return a.area != b.area ? a.area > b.area : a.number < b.number;
    }

    /// How far a face may be from a larger one's plane. Numbers that a file writes alike were rounded alike: faces
    /// along one axis are as far apart as they say.
    double tolerance(const FlatFace& plane, const FlatFace& face) const;

    /// The largest distance of the smaller face's corners from the larger one's plane; without end where their middle
    /// is beyond all tolerances.
    double distance(const FlatFace& a, const FlatFace& b) const;

    /// Whether faces of that distance touch.
    bool touching(const FlatFace& a, const FlatFace& b, double distance) const;

    /// Whether triangles of two faces of a mesh overlap, or of one face.
    bool overlapping(const FlatFace& a, const FlatFace& b) const;

    /// Whether all faces lie in the plane of the largest.
    bool lie_in_one_plane(const std::vector<FlatFace>& faces) const;

  private:
    const ContactRange& range_;
    const double exact_, least_;
};

/// Faces, and a tree of their boxes.
struct FaceTree {
    FaceList faces;
    double pad = 0;  // by how much boxes are grown
    Tree tree;       // of a few faces none

    FaceTree() = default;
    FaceTree(FaceList of, double grown);

    /// Whether found(j) holds for a face other than i whose box comes near that of i; asks no further once it does.
    /// Adds the number of those asked of to `asked`.
    template <class Found>
    bool any_near(uint32_t i, size_t& asked, const Found& found) const {
        const auto ask = [&](uint32_t j) {
            if (j == i || !touch(faces[i].box, faces[j].box, pad)) return false;
            ++asked;
            return found(j);
        };
        if (!tree.nodes.empty()) return any_in_box(tree, padded(faces[i].box, pad), ask);
        for (uint32_t j = 0; j < faces.size(); ++j)
            if (ask(j)) return true;
        return false;
    }
};

}  // namespace cistula
