// Preloaded into a program: makes one of its allocations fail, in C and C++ alike, in threads and while libraries load.
// CISTULA_FAIL_AT: its number, from 1.
#include <dlfcn.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>

extern "C" {
extern char** environ;
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
}

namespace {

/// getenv and strtol may not be used yet where the first allocations are made.
long number_to_fail() {
    constexpr char name[] = "CISTULA_FAIL_AT=";
    for (char** entry = environ; entry && *entry; ++entry) {
        if (std::strncmp(*entry, name, sizeof name - 1) != 0) continue;
        long number = 0;
        for (const char* digit = *entry + sizeof name - 1; *digit; ++digit) number = 10 * number + (*digit - '0');
        return number;
    }
    return 0;
}

bool fails() {
    static long made = 0, failing = number_to_fail();
    return __atomic_add_fetch(&made, 1, __ATOMIC_RELAXED) == failing;
}

void* none() {
    errno = ENOMEM;
    return nullptr;
}

}  // namespace

extern "C" {

void* malloc(size_t size) {
    return fails() ? none() : __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
    return fails() ? none() : __libc_calloc(count, size);
}
void* realloc(void* from, size_t size) {
    return fails() ? none() : __libc_realloc(from, size);
}
void* memalign(size_t alignment, size_t size) {
    return fails() ? none() : __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
    return fails() ? none() : __libc_memalign(alignment, size);
}
int posix_memalign(void** to, size_t alignment, size_t size) {
    *to = fails() ? nullptr : __libc_memalign(alignment, size);
    return *to ? 0 : ENOMEM;
}

void* mmap(void* at, size_t size, int protection, int flags, int file, off_t offset) {
    if ((flags & MAP_ANONYMOUS) != 0 && fails()) {
        errno = ENOMEM;
        return MAP_FAILED;
    }
    return reinterpret_cast<void*>(syscall(SYS_mmap, at, size, protection, flags, file, offset));
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* with) {
    using Create = int(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static Create* const create = reinterpret_cast<Create*>(dlsym(RTLD_NEXT, "pthread_create"));
    return fails() ? EAGAIN : create(thread, attributes, run, with);
}

}  // extern "C"
