// Vectors as the arrays of a scene.
#pragma once

#include <cstddef>
#include <vector>

#include "cistula/numerics/portable.h"

namespace cistula {

/// A vector's elements, which must outlive the span.
template <class T>
Span<T> span_of(const std::vector<T>& all) {
    return {all.data(), static_cast<uint32_t>(all.size())};
}

/// The bytes of the elements.
template <class T>
size_t bytes_of(const std::vector<T>& all) {
    return all.size() * sizeof(T);
}

}  // namespace cistula
