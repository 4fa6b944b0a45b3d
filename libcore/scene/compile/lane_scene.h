// Conversion of a scene to the form that rays in lanes trace.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "cistula/lanes/lane_scene.h"

namespace cistula {

struct FrameView;

/// A LaneScene with the arrays that it does not share with the view from which it was made.
template <class Real>
class OwnedLaneScene {
  public:
    /// The view must fit and outlive this. InteriorSets are bits in scenes with at most `most_with_bits` closed solids.
    explicit OwnedLaneScene(const SceneView<Real>& from, uint32_t most_with_bits = LaneScene<Real>::most_with_bits);
    OwnedLaneScene(const OwnedLaneScene&) = delete;

    const LaneScene<Real>& scene() const { return scene_; }
    size_t memory() const;  // bytes of all arrays

  private:
    void number_solids(const SceneView<Real>& from, uint32_t most_with_bits);
    void find_sets(const SceneView<Real>& from);
    void copy_parts();
    void find_tree();
    void find_columns();
    void fill_tables();

    LaneScene<Real> scene_{};
    std::vector<uint32_t> numbers_, places_, convex_, convex_places_, tree_items_, plane_solids_;
    std::deque<std::vector<uint32_t>> sets_;  // of the SolidSets
    std::vector<Solid> solids_;
    std::vector<IndexedSolid<Real>> convex_copies_;
    std::vector<SolidShading> shading_;
    std::vector<SolidsOfIndex> indices_;
    std::vector<Cluster<Real>> clusters_;
    std::vector<Disk<Real>> disks_;
    std::vector<SheetPlane<Real>> planes_;
    std::vector<TriangleSides<Real>> sides_;
    std::vector<Incident> incidents_;
    std::vector<PlaneBodies> plane_bodies_;
    std::vector<TreeNode> tree_;
};

/// The LaneScene of a view; null if the scene does not fit: it has too many solids or triangles, or
/// transparent meshes with faces in the planes of others.
template <class Real>
std::unique_ptr<const OwnedLaneScene<Real>> lane_scene(const SceneView<Real>& scene);

/// Finds the solids around the camera (pixel.h) by a scene for lanes; the frame gets the scene's own numbers.
template <class Real>
bool find_camera_solids(const LaneScene<Real>& scene, FrameView& frame);

}  // namespace cistula
