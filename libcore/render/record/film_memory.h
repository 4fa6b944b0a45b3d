// Memory of films.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <memory>
#include <new>
#include <utility>

namespace cistula {

/// Allocator that leaves trivial elements uninitialized, so that the rendering threads touch their memory first, and
/// takes large pages where the system has them: a fault for each small one would take longer than a GPU needs for the
/// pixels.
template <class T>
struct FilmAllocator : std::allocator<T> {
    static constexpr std::align_val_t large_page{size_t{2} << 20};

    template <class U>
    struct rebind {
        using other = FilmAllocator<U>;
    };
    static bool is_large(size_t count) { return count * sizeof(T) >= size_t(large_page); }
    T* allocate(size_t count) {
        if (!is_large(count)) return std::allocator<T>::allocate(count);
        void* const place = ::operator new(count * sizeof(T), large_page);
        (void)madvise(place, count * sizeof(T) / size_t(large_page) * size_t(large_page), MADV_HUGEPAGE);
        return static_cast<T*>(place);
    }
    void deallocate(T* place, size_t count) {
        is_large(count) ? ::operator delete(place, large_page) : std::allocator<T>::deallocate(place, count);
    }
    template <class U>
    void construct(U* place) {
        ::new (static_cast<void*>(place)) U;
    }
    template <class U, class... Arguments>
    void construct(U* place, Arguments&&... arguments) {
        ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }
};

}  // namespace cistula
