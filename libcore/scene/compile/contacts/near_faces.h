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

/// Whether the boxes of two faces, one of them grown by `pad`, touch.
bool boxes_touch(const FlatFace& a, const FlatFace& b, double pad);

/// What decides whether two faces of one list touch. Of two of one size the earlier is the larger.
class FaceTest {
  public:
    /// `exact`: how far faces in the frame may be apart; if it is 0, what `range` says of the bodies of faces as given.
    FaceTest(const ContactRange& range, double exact) : range_(range), exact_(exact) {}

    bool exact() const { return exact_ > 0; }
    static bool is_larger(const FlatFace& a, const FlatFace& b) {
        return a.area != b.area ? a.area > b.area : a.number < b.number;
    }

    /// How far a face may be from a larger one's plane beside which it lies. Numbers that a file writes alike were
    /// rounded alike: faces along one axis are as far apart as they say.
    double tolerance(const FlatFace& plane, const FlatFace& face) const {
        return exact() ? exact_ : tolerance(plane, face, rounding(plane, face));
    }

    /// Whether a face's corners, the farthest of them so far from a larger one's plane, lie in it: within the
    /// tolerance, or where the plane may be by the rounding of its corners, which moves it the more the farther beyond
    /// them.
    bool lies_in(const FlatFace& plane, const FlatFace& face, double farthest) const;

    /// The largest distance of the smaller face's corners from the larger one's plane; without end where their middle
    /// is beyond all tolerances.
    double distance(const FlatFace& a, const FlatFace& b) const;

    /// Whether faces of that distance touch.
    bool touching(const FlatFace& a, const FlatFace& b, double distance) const;

    /// Whether two faces overlap, or triangles of one: by more than 2^-18 of half the longest side of the smaller body.
    static bool overlapping(const FlatFace& a, const FlatFace& b);

    /// Whether two faces meet along their planes, or are no farther apart there than `most`.
    static bool meeting(const FlatFace& a, const FlatFace& b, double most);

    /// Whether all faces lie in the plane of the largest.
    bool lie_in_one_plane(const std::vector<FlatFace>& faces) const;

  private:
    /// How far rounding may have moved the corners of a plane and of a face, along the plane's normal.
    struct Rounding {
        double plane = 0, face = 0;
    };
    Rounding rounding(const FlatFace& plane, const FlatFace& face) const;
    double tolerance(const FlatFace& plane, const FlatFace& face, const Rounding& rounding) const;

    const ContactRange& range_;
    const double exact_;
};

/// Faces, and a tree of their boxes in the frame, each grown by its body's pad.
struct FaceTree {
    FaceList faces;
    Tree tree;  // of a few faces none

    FaceTree() = default;
    explicit FaceTree(FaceList of);

    /// Whether found(j) holds for a face other than i whose grown box meets that of i, grown by `pad`; asks no further
    /// once it does. Adds the number of those asked of to `asked`.
    template <class Found>
    bool any_near(uint32_t i, double pad, size_t& asked, const Found& found) const {
        const Box grown = padded(faces[i].in_frame, pad);
        const auto ask = [&](uint32_t j) {
            if (j == i || !touch(grown, faces[j].in_frame, faces[j].body->pad)) return false;
            ++asked;
            return found(j);
        };
        if (!tree.nodes.empty()) return any_in_box(tree, grown, ask);
        for (uint32_t j = 0; j < faces.size(); ++j)
            if (ask(j)) return true;
        return false;
    }
};

}  // namespace cistula
