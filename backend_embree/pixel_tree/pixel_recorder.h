// Records render_pixel's work: its queries to the intersector and the stack determine the ray tree, and the sums
// between two queries tell what each part of it adds.
#pragma once

#include <vector>

#include "backend_embree/pixel_tree/branch_reader.h"

namespace cistula {

/// Records one sample. A branch lasts from one pop to the next; its node is made at its end.
template <class Real, class Intersector>
class SampleRecorder {
  public:
    SampleRecorder(const BranchReader<Real, Intersector>& reader, const PixelRecord& record, const PixelWork& work,
                   const PixelTreeLimits& limits, SampleTree& tree, std::vector<std::string>& crowd)
        : reader_(reader), record_(record), work_(work), limits_(limits), tree_(tree), crowd_(crowd) {
        tree_.branches.emplace_back();
    }

    void looked(const Ray<Real>& ray, const Hit<Real>& hit) { trace_.looks.push_back({ray, hit}); }
    void shadowed(const ShadowRay<Real>& shadow, const Vec3<Real>& arrives) {
        trace_.shadows.push_back({shadow, arrives, colors_of(record_.radiance)});
    }
    void pushed(const Branch<Real>& branch, bool fits) { trace_.pushed.push_back({branch, fits}); }

    /// Ends the current branch. Throws Error where the limits are reached.
    void finish() {
        limits_.stop.check();
        if (tree_.branches.size() > limits_.branches)
            throw Error(ErrorKind::failed, "the pixel's rays branch too often to be followed one by one",
                        "a smaller `depth` or `supersample`, or a larger `cutoff`, leaves fewer");
        trace_.end = Sums::of(record_);
        trace_.flags = work_.flags;
        trace_.start = current_ == 0 ? work_.start : 0;
        if (current_ != none) reader_.read(trace_, tree_, current_, waiting_, crowd_);
        trace_ = {};
        current_ = none;
    }
    void popped(const Branch<Real>& branch) {
        current_ = waiting_.back();
        waiting_.pop_back();
        trace_.weight = branch.weight;
        trace_.begin = Sums::of(record_);
    }

  private:
    static constexpr uint32_t none = ~0u;

    const BranchReader<Real, Intersector>& reader_;
    const PixelRecord& record_;
    const PixelWork& work_;
    const PixelTreeLimits& limits_;  // of this sample
    SampleTree& tree_;
    std::vector<std::string>& crowd_;  // of the pixel
    BranchTrace<Real> trace_;
    std::vector<uint32_t> waiting_;  // nodes of the branches on the stack
    uint32_t current_ = 0;
};

template <class Real, class Inner>
struct ObservedIntersector {
    using Media = typename Inner::Media;
    using Scene = typename Inner::Scene;
    const Inner& inner;
    SampleRecorder<Real, Inner>& recorder;

    template <class E = Effects<all_effects>>
    Hit<Real> closest(const Ray<Real>& ray) const {
        const Hit<Real> hit = inner.template closest<E>(ray);
        recorder.looked(ray, hit);
        return hit;
    }
    template <class E>
    Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        const Throughput<Real, E> arrives = inner.template transmittance<E>(shadow);
        recorder.shadowed(shadow, arrives);
        return arrives;
    }
};

template <class Real, class Inner>
class ObservedStack {
  public:
    explicit ObservedStack(SampleRecorder<Real, Inner>& recorder) : recorder_(recorder), inner_(storage_) {}

    bool push(const Branch<Real>& branch) {
        const bool fits = inner_.push(branch);
        recorder_.pushed(branch, fits);
        return fits;
    }
    bool pop(Branch<Real>& branch) {
        recorder_.finish();
        if (!inner_.pop(branch)) return false;
        recorder_.popped(branch);
        return true;
    }

    void clear() { inner_.clear(); }
    bool stopped() const { return false; }

  private:
    SampleRecorder<Real, Inner>& recorder_;
    typename BranchStack<Branch<Real>>::Storage storage_;
    BranchStack<Branch<Real>> inner_;
};

/// Computes the total of each branch's subtree from what each branch adds by itself.
inline void sum_up(std::vector<PixelBranch>& branches) {
    for (size_t i = branches.size(); i-- > 0;)
        for (const uint32_t child : branches[i].children)
            for (size_t c = 0; c < 3; ++c) {
                branches[i].adds_below[c] += branches[child].adds[c] + branches[child].adds_below[c];
                branches[i].ledger_below[c] += branches[child].ledger[c] + branches[child].ledger_below[c];
            }
}

/// Records the tree of sample `sample` of pixel (x, y). `flags`, the record and the result are those of render_sample.
template <class Real, class Intersector>
bool record_sample(const BranchReader<Real, Intersector>& reader, const SceneView<Real>& scene,
                   const Intersector& intersector, const FrameView& frame, int x, int y, int sample,
                   const TreeThreshold& threshold, const PixelTreeLimits& limits, SampleTree& tree,
                   std::vector<std::string>& crowd, uint32_t& flags) {
    const GridSample place = grid_sample(sample, frame.supersample);
    tree = SampleTree();
    tree.row = place.row;
    tree.column = place.column;
    PixelWork work;
    SampleRecorder<Real, Intersector> recorder(reader, tree.record, work, limits, tree, crowd);
    const ObservedIntersector<Real, Intersector> observed{intersector, recorder};
    ObservedStack<Real, Intersector> stack(recorder);
    const PixelTask<BranchEffects, ObservedIntersector<Real, Intersector>, ObservedStack<Real, Intersector>> task{
        scene, frame, observed, x, y, work, stack};
    begin_pixel(tree.record);
    const bool holds = render_sample(task, threshold, place, tree.record);
    end_pixel(tree.record, work);
    tree.rays = work.rays;
    flags |= work.flags;
    PixelBranch& primary = tree.branches.front();
    primary.direction = sample_direction(frame, x, y, place);
    if (tree.rays.total() == 1 && primary.end == BranchEnd::background) {  // the ray may miss the scene
        primary.distance = RealTraits<double>::infinity;
        primary.adds = colors_of(tree.record.radiance);
    }
    sum_up(tree.branches);
    return holds;
}

/// The trees of pixel (x, y), sample by sample, traced with the thresholds that hold (tree_threshold.h).
template <class Real, class Intersector>
PixelTree record_pixel(const CompiledScene<Real>& compiled, const SceneView<Real>& scene,
                       const Intersector& intersector, const CameraFrame& camera, const FrameSettings& settings, int x,
                       int y, const PixelTreeLimits& limits, uint32_t& flags) {
    FrameView frame = frame_view(compiled, camera, settings);
    PixelTree pixel;
    if (!find_camera_solids(scene, intersector, frame)) {
        flags |= flag_media_overflow;
        frame.camera_sides[0].media.for_each(
            [&](uint32_t solid, int) { pixel.crowd.push_back(compiled.solid_names[solid]); });
    }
    const BranchReader<Real, Intersector> reader(compiled, scene, intersector, frame);
    PixelTreeLimits left = limits;
    for (int sample = 0; sample < settings.supersample * settings.supersample; ++sample) {
        TreeThreshold threshold{frame.tree.threshold};
        SampleTree tree;
        while (
            !record_sample(reader, scene, intersector, frame, x, y, sample, threshold, left, tree, pixel.crowd, flags))
            threshold.shrink();
        tree.branches.front().origin = camera.camera.position;
        left.branches -= std::min(left.branches, tree.branches.size());
        pixel.samples.push_back(std::move(tree));
    }
    return pixel;
}

}  // namespace cistula
