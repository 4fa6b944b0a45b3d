// Branches of ray trees in lanes, and the queues in which they wait (docs/wide.md).
#pragma once

#include <memory>
#include <vector>

#include "cistula/lanes/lane_hit.h"
#include "cistula/transport/branch.h"

namespace cistula {

/// A register's worth of branches of one depth, all mirrored or all transmitted.
template <class Real, class Media, class Weight>
struct LaneBranch {
    static constexpr int by_mirror = 1 << 29;  // a bit beside the pixel

    Ray<Real, Media> ray;
    Weight weight{Real(1)};
    IndexOf<Real> pixel = 0;  // in the tile; with layers also by_mirror, of what the first surface mirrors
    MaskOf<Real> no_light_ahead = false;
    uint32_t depth = 0;
    bool mirrored = false;

    /// Becomes what is constructed, value by value: a copy of the whole is slow.
    CISTULA_INLINE void begin() {
        ray.from_solid = no_solid;
        ray.from_face = 0;
        ray.from_plane = ScalarOf<IndexOf<Real>>(no_plane);
        ray.after = {Real(-1), 0};
        weight = Weight(Real(1));
        no_light_ahead = false;
        depth = 0;
        mirrored = false;
    }
    /// A child without its ray.
    CISTULA_INLINE LaneBranch child(const Weight& of, bool is_mirrored) const {
        LaneBranch branch;
        branch.weight = of;
        branch.pixel = pixel;
        branch.depth = depth + 1;
        branch.mirrored = is_mirrored;
        return branch;
    }
};

template <class T, int n, class Media, class Weight>
struct BranchType<Lanes<T, n>, Media, Weight> {
    using Type = LaneBranch<Lanes<T, n>, Media, Weight>;
};

/// Branches of one depth that wait, value by value, so that a register is loaded or stored at once.
template <class Entry>
class LaneQueue;
template <class T, int n, class Media, class Weight>
class LaneQueue<LaneBranch<Lanes<T, n>, Media, Weight>> {
  public:
    using Real = Lanes<T, n>;
    using Index = IndexOf<Real>;
    using Entry = LaneBranch<Real, Media, Weight>;

    bool is_full() const { return count_ >= n; }
    bool is_empty() const { return count_ == 0; }
    void clear() { count_ = 0; }

    /// Adds the branches where `active` holds. There must be fewer than n.
    CISTULA_INLINE void push(const Entry& branch, const MaskOf<Real>& active) {
        const uint32_t bits = active.bits();
        int row = 0;
        each(branch, [&](const auto& value) {
            using Value = std::remove_cvref_t<decltype(value)>;
            Value(native::packed(value.v, bits)).put(at<Value>(row++));
        });
        const Index state = branch.pixel | (minus_one_where(branch.no_light_ahead) & Index(dark));
        Index(native::packed(state.v, bits)).put(at<Index>(row));
        count_ += __builtin_popcount(bits);
    }

    /// Takes up to n branches, and returns where they are.
    CISTULA_INLINE MaskOf<Real> pop(Entry& branch) {
        const int taken = count_ < n ? count_ : n;
        count_ -= taken;
        int row = 0;
        each(branch, [&](auto& value) {
            using Value = std::remove_cvref_t<decltype(value)>;
            value = Value::at(at<Value>(row++));
        });
        const Index state = Index::at(at<Index>(row));
        branch.no_light_ahead = (state & Index(dark)) != 0;
        branch.pixel = state & Index(dark - 1);
        return MaskOf<Real>::first(taken);
    }

  private:
    static constexpr int dark = 2 * Entry::by_mirror;  // bit of no_light_ahead beside the pixel
    static constexpr int rows = 3 + 3 + sizeof(Weight) / sizeof(Real) + 6;

    /// Calls visit(value) for every value that is stored as it is.
    template <class Branch, class Visit>
    CISTULA_INLINE static void each(Branch& branch, const Visit& visit) {
        visit(branch.ray.origin.x), visit(branch.ray.origin.y), visit(branch.ray.origin.z);
        visit(branch.ray.direction.x), visit(branch.ray.direction.y), visit(branch.ray.direction.z);
        if constexpr (sizeof(Weight) == sizeof(Real))
            visit(branch.weight);
        else
            visit(branch.weight.x), visit(branch.weight.y), visit(branch.weight.z);
        visit(branch.ray.after.t), visit(branch.ray.after.key);
        visit(branch.ray.from_solid), visit(branch.ray.from_face), visit(branch.ray.media.bits);
    }

    /// Where the next branches of a row begin.
    template <class Value>
    CISTULA_INLINE auto* at(int row) {
        using Scalar = std::remove_cvref_t<decltype(Value()[0])>;
        return reinterpret_cast<Scalar*>(rows_) + row * 2 * n + count_;
    }

    alignas(lane_bytes) T rows_[rows * 2 * n] = {};  // what lies beyond the branches is old, but not arbitrary
    int count_ = 0;
};

/// All branches that wait: two queues for each depth. A queue that holds a register's worth is followed next, and
/// filled anew only afterwards, so that none ever holds two.
template <class Entry>
class LaneQueues {
  public:
    template <class Mask>
    CISTULA_INLINE void push(const Entry& branch, const Mask& active) {
        const size_t number = 2 * size_t(branch.depth) + (branch.mirrored ? 1 : 0);
        while (queues_.size() <= number) queues_.push_back(std::make_unique<LaneQueue<Entry>>());
        LaneQueue<Entry>& queue = *queues_[number];
        const bool was_full = queue.is_full();
        queue.push(branch, active);
        if (queue.is_full() && !was_full) full_.push_back(uint32_t(number));
        if (number < lowest_) lowest_ = number;
    }

    /// Whether a queue holds a register's worth.
    bool has_full() const { return !full_.empty(); }

    /// Takes branches from the full queue of the greatest depth; if there is none, from the queue of the least, so that
    /// the others fill up. Returns where they are; nowhere if none wait.
    CISTULA_INLINE auto pop(Entry& branch) {
        size_t number;
        if (!full_.empty()) {
            number = full_.back();
            full_.pop_back();
        } else {
            while (lowest_ < queues_.size() && queues_[lowest_]->is_empty()) ++lowest_;
            if (lowest_ >= queues_.size()) return decltype(queues_[0]->pop(branch))(false);
            number = lowest_;
        }
        branch.depth = uint32_t(number / 2);
        branch.mirrored = number % 2 != 0;
        return queues_[number]->pop(branch);
    }

    void clear() {
        for (auto& queue : queues_) queue->clear();
        full_.clear();
    }

  private:
    std::vector<std::unique_ptr<LaneQueue<Entry>>> queues_;  // 2 depth + mirrored
    std::vector<uint32_t> full_;
    size_t lowest_ = 0;  // no queue below it holds anything
};

}  // namespace cistula
