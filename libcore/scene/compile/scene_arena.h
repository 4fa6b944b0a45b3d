// A compiled scene as one block of bytes, to be uploaded in one copy and viewed at any address.
#pragma once

#include <cstddef>
#include <vector>

#include "cistula/model/scene_view.h"

namespace cistula {

/// The arrays of a scene view in one block, each at an offset aligned for wide loads.
template <class Real>
class SceneArena {
  public:
    static constexpr size_t alignment = 256;

    explicit SceneArena(const SceneView<Real>& view);

    const std::vector<std::byte>& bytes() const { return bytes_; }

    /// The scene view for a copy of bytes() at `base`, which need not be readable here (device memory).
    SceneView<Real> at(const void* base) const;

  private:
    std::vector<std::byte> bytes_;
    SceneView<Real> offsets_;  // its spans' data pointers are offsets into the block
};

}  // namespace cistula
