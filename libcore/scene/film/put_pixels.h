// Pixels into a film past the caches: nobody reads them soon, and what lies in the caches is wanted.
#pragma once

#include <immintrin.h>

#include <cstddef>

#include "cistula/model/pixel_record.h"

namespace cistula {

/// Writes pixels one after the other; what one object has written is there for other threads once it is gone.
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
