#include "backend_cuda/locked_pages.h"

#include <cuda_runtime_api.h>

#include <map>
#include <mutex>

namespace cistula {

namespace {

enum class Pages { seen, locked, refused };

std::mutex& access() {
    static std::mutex mutex;
    return mutex;
}

/// By where pixels begin. Never destroyed: films may outlive all that is static here.
std::map<const void*, Pages>& known() {
    static auto* pages = new std::map<const void*, Pages>();
    return *pages;
}

void unlock(void* pixels) {
    const std::lock_guard<std::mutex> guard(access());
    const auto found = known().find(pixels);
    if (found == known().end()) return;
    if (found->second == Pages::locked) cudaHostUnregister(pixels);
    known().erase(found);
}

}  // namespace

bool has_locked_pages(const Film& film) {
    const auto pixels = const_cast<PixelRecord*>(film.pixels.data());
    const std::lock_guard<std::mutex> guard(access());
    before_pixels_go = unlock;
    const auto [found, is_new] = known().try_emplace(pixels, Pages::seen);
    if (!is_new && found->second == Pages::seen) {
        const size_t bytes = film.pixels.capacity() * sizeof(PixelRecord);
        const bool locks = cudaHostRegister(pixels, bytes, cudaHostRegisterPortable) == cudaSuccess;
        if (!locks) cudaGetLastError();  // copies by way of other memory do as well
        found->second = locks ? Pages::locked : Pages::refused;
    }
    return found->second == Pages::locked;
}

}  // namespace cistula
