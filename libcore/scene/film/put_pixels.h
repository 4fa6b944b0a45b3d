// Non-temporal stores of pixels into a film: they are not read soon, so they should not displace the caches' contents.
#pragma once

#include <immintrin.h>

#include <cstddef>

#include "cistula/model/pixel_record.h"

namespace cistula {

/// Writes consecutive pixels; they are visible to other threads after the object is destroyed.
class PixelWriter {
  public:
    PixelWriter() = default;
    PixelWriter(const PixelWriter&) = delete;
    PixelWriter& operator=(const PixelWriter&) = delete;
    ~PixelWriter() { _mm_sfence(); }

    void put(PixelRecord& to, const PixelRecord& from) const {
        constexpr int words = sizeof(PixelRecord) / sizeof(long long);
        static_assert(words * sizeof(long long) == sizeof(PixelRecord) && alignof(PixelRecord) == alignof(long long));
        long long copy[words];
        memcpy(copy, &from, sizeof from);
        for (int i = 0; i < words; ++i) _mm_stream_si64(reinterpret_cast<long long*>(&to) + i, copy[i]);
    }

    void fill(PixelRecord* to, size_t count, const PixelRecord& from) const {
        for (size_t i = 0; i < count; ++i) put(to[i], from);
    }
};

}  // namespace cistula
