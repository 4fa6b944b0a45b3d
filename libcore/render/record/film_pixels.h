// The pixels of a film: of each its radiance, and the other parts of its record that are asked for.
#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "cistula/model/pixel_record.h"
#include "render/record/film_memory.h"

namespace cistula {

/// The parts of records that a film keeps beside the radiance; by default all.
struct KeptParts {
    bool losses = true;
    bool sights = true;

    /// Bytes of a pixel.
    size_t bytes() const {
        return sizeof(PixelRadiance) + (losses ? sizeof(PixelLosses) : 0) + (sights ? sizeof(PixelSight) : 0);
    }
    bool operator==(const KeptParts&) const = default;
};

/// Reads as a container of records, in which parts that are not kept are 0.
class FilmPixels {
  public:
    /// Makes this so many pixels, uninitialized, in the memory that it has if that suffices.
    void begin(size_t count, KeptParts parts = {}) {
        parts_ = parts;
        renew(radiance_, count);
        renew(losses_, parts.losses ? count : 0);
        renew(sights_, parts.sights ? count : 0);
    }
    /// Makes this so many pixels with this record.
    void assign(size_t count, const PixelRecord& record = {}, KeptParts parts = {}) {
        begin(count, parts);
        for (size_t i = 0; i < count; ++i) set(i, record);
    }

    size_t size() const { return radiance_.size(); }
    bool empty() const { return radiance_.empty(); }
    KeptParts parts() const { return parts_; }
    size_t bytes() const { return size() * parts_.bytes(); }
    size_t capacity() const { return radiance_.capacity(); }

    /// A copy; const, so that no one takes changing it for changing the film.
    const PixelRecord operator[](size_t pixel) const {
        PixelRecord record = {};
        static_cast<PixelRadiance&>(record) = radiance_[pixel];
        if (parts_.losses) static_cast<PixelLosses&>(record) = losses_[pixel];
        if (parts_.sights) static_cast<PixelSight&>(record) = sights_[pixel];
        return record;
    }
    const PixelRecord at(size_t pixel) const {
        if (pixel >= size()) throw std::out_of_range("a pixel beyond the film");
        return (*this)[pixel];
    }
    const PixelRadiance& radiance(size_t pixel) const { return radiance_[pixel]; }
    const PixelSight& sight(size_t pixel) const { return sights_[pixel]; }

    void set(size_t pixel, const PixelRecord& record) { planes().put(pixel, record); }
    /// Calls change(record) and keeps what that becomes.
    template <class Change>
    void change(size_t pixel, const Change& change) {
        PixelRecord record = (*this)[pixel];
        change(record);
        set(pixel, record);
    }

    /// Where the parts are; those that are not kept are null.
    PixelPlanes planes() {
        return {radiance_.data(), parts_.losses ? losses_.data() : nullptr, parts_.sights ? sights_.data() : nullptr};
    }

    class Iterator {
      public:
        using iterator_category = std::input_iterator_tag;
        using value_type = PixelRecord;
        using difference_type = ptrdiff_t;
        using pointer = void;
        using reference = const PixelRecord;

        Iterator(const FilmPixels& pixels, size_t pixel) : pixels_(&pixels), pixel_(pixel) {}
        const PixelRecord operator*() const { return (*pixels_)[pixel_]; }
        Iterator& operator++() {
            ++pixel_;
            return *this;
        }
        bool operator==(const Iterator&) const = default;

      private:
        const FilmPixels* pixels_;
        size_t pixel_;
    };
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, size()}; }

  private:
    template <class T>
    using Plane = std::vector<T, FilmAllocator<T>>;

    template <class T>
    static void renew(Plane<T>& plane, size_t count) {
        if (count == 0 || count > plane.capacity()) plane = {};
        plane.clear();  // else a larger one would be moved
        plane.resize(count);
    }

    KeptParts parts_;
    Plane<PixelRadiance> radiance_;
    Plane<PixelLosses> losses_;
    Plane<PixelSight> sights_;
};

/// Non-temporal stores of pixels into a film: they are not read soon, so they should not displace the caches' contents.
/// They are visible to other threads after the object is destroyed.
class PixelWriter {
  public:
    /// Makes what is stored before its end visible to other threads.
    struct Fence {
        Fence() = default;
        Fence(const Fence&) = delete;
        Fence& operator=(const Fence&) = delete;
        ~Fence() { _mm_sfence(); }
    };

    explicit PixelWriter(const PixelPlanes& to) : to_(to), fence_() {}

    void put(size_t pixel, const PixelRecord& from) const {
        put<PixelRadiance>(to_.radiance + pixel, from);
        if (to_.losses != nullptr) put<PixelLosses>(to_.losses + pixel, from);
        if (to_.sights != nullptr) put<PixelSight>(to_.sights + pixel, from);
    }
    /// Writes a part of a record; a fence must follow.
    template <class Part>
    static void put(Part* to, const Part& from) {
        constexpr int words = sizeof(Part) / sizeof(long long);
        static_assert(words * sizeof(long long) == sizeof(Part));
        long long copy[words];
        memcpy(copy, &from, sizeof from);
        for (int i = 0; i < words; ++i) _mm_stream_si64(reinterpret_cast<long long*>(to) + i, copy[i]);
    }

    void fill(size_t first, size_t count, const PixelRecord& from) const {
        for (size_t i = first; i < first + count; ++i) put(i, from);
    }

  private:
    const PixelPlanes to_;
    const Fence fence_;
};

}  // namespace cistula
