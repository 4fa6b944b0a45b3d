// Stacks for the pending branches of a ray tree. The lighter child is followed first, so that a small stack suffices
// for any tree.
#pragma once

#include <new>
#include <type_traits>

#include "cistula/transport/branch.h"

namespace cistula {

/// The capacity of a stack. While k branches wait, the one that is followed has a weight of at most 2^-k, and a branch
/// under 2^-62 is dropped.
inline constexpr int branch_stack = 67;

/// A stack of branches. Its entries lie in a Storage of the caller, so that the stack itself stays in registers.
template <class Entry>
class BranchStack {
  public:
    /// Uninitialized memory for all entries, of which most trees need a few.
    class Storage {
      public:
        CISTULA_INLINE Storage() {}

      private:
        friend BranchStack;
        union {
            WaitingBranch<Entry> entries_[branch_stack];
        };
    };

    CISTULA_INLINE explicit BranchStack(Storage& storage) : storage_(storage) {}

    /// Pushes a branch; false if the stack is full.
    CISTULA_INLINE bool push(const Entry& branch) {
        if (count_ == branch_stack) return false;
        new (&storage_.entries_[count_++]) WaitingBranch<Entry>(branch);
        return true;
    }
    /// Pops the latest branch; false if there is none.
    CISTULA_INLINE bool pop(Entry& branch) {
        if (count_ == 0) return false;
        storage_.entries_[--count_].give(branch);
        return true;
    }
    CISTULA_INLINE bool empty() const { return count_ == 0; }
    CISTULA_INLINE void clear() { count_ = 0; }
    /// Whether the render was stopped, so that the tree is to end early.
    CISTULA_INLINE bool stopped() const { return false; }

  private:
    Storage& storage_;
    int count_ = 0;
};

/// The stack of trees that do not fork: a branch has at most one child, which is followed next.
template <class Entry>
class OneBranch {
  public:
    struct Storage {};

    CISTULA_INLINE explicit OneBranch(Storage&) {}

    CISTULA_INLINE bool push(const Entry& branch) {
        branch_ = branch;
        waits_ = true;
        return true;
    }
    CISTULA_INLINE bool pop(Entry& branch) {
        if (!waits_) return false;
        branch = branch_;
        waits_ = false;
        return true;
    }
    CISTULA_INLINE bool empty() const { return !waits_; }
    CISTULA_INLINE void clear() { waits_ = false; }
    CISTULA_INLINE bool stopped() const { return false; }

  private:
    Entry branch_;
    bool waits_ = false;
};

/// The stack type of trees that are rendered with effects E.
template <class Real, class E, class Media>
using StackOf = std::conditional_t<E::has(effect_transmission), BranchStack<BranchOf<Real, E, Media>>,
                                   OneBranch<BranchOf<Real, E, Media>>>;

/// A stack whose trees end early once stop() is true, since a tree may be practically endless.
template <class Base, class Stop>
class StoppableStack : public Base {
  public:
    CISTULA_INLINE StoppableStack(typename Base::Storage& storage, const Stop& stop) : Base(storage), stop_(stop) {}
    CISTULA_INLINE bool stopped() const { return stop_(); }

  private:
    const Stop stop_;
};

}  // namespace cistula
