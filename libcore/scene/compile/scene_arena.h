// A compiled scene as one block of bytes: one upload, and a view of it wherever it lies.
#pragma once

#include <cstddef>
#include <vector>

#include "cistula/model/scene_view.h"

namespace cistula {

/// Holds what view's spans point to, each at an offset that suits wide loads.
template <class Real>
class SceneArena {
  public:
    static constexpr size_t alignment = 256;

    explicit SceneArena(const SceneView<Real>& view);

    const std::vector<std::byte>& bytes() const { return bytes_; }

    /// The scene, its arrays in a copy of bytes() that begins at `base`, which need not be readable here.
    SceneView<Real> at(const void* base) const;

  private:
    std::vector<std::byte> bytes_;
    SceneView<Real> offsets_;  // the spans' data are offsets
};

}  // namespace cistula
