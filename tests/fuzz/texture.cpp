// Picture files, read as textures and as they stand by the module for OpenImageIO. Programs use it in a process of its
// own, where a crash of a library is an error like any other, so that none is a finding here either, nor what a library
// leaks of a broken file.
#include <dlfcn.h>
#include <setjmp.h>
#include <ucontext.h>

#include <csignal>

#include "checks.h"
#include "image/reader/oiio_module.h"
#include "image/reader/texture_limits.h"
#include "target.h"
#include "testing/support/scratch_directory.h"

extern "C" void __lsan_disable() __attribute__((weak));  // of the sanitizer, where there is one
extern "C" void __lsan_enable() __attribute__((weak));

namespace cistula {
namespace {

constexpr uint64_t limit = 32'000'000;

sigjmp_buf before_library;
volatile std::sig_atomic_t is_in_library = 0;
struct sigaction own_handlers[NSIG];

void enter_library(bool now) {
    if (const auto leaks = now ? __lsan_disable : __lsan_enable) leaks();
    is_in_library = now ? 1 : 0;
}

/// Leaves a library that has crashed. Faults of the module's own code, and all outside of it, are left to the fuzzer.
void leave_library(int number, siginfo_t*, void* context) {
    const auto place = static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP];
    Dl_info file{};
    const bool is_known = dladdr(reinterpret_cast<void*>(place), &file) != 0;  // NOLINT(performance-no-int-to-ptr)
    const std::string_view name = is_known ? file.dli_fname : "";
    if (is_in_library && name.find("cistula") == name.npos && name.find("texture") == name.npos)
        siglongjmp(before_library, 1);
    sigaction(number, &own_handlers[number], nullptr);
    std::raise(number);
}

void catch_faults() {
    struct sigaction action {};
    action.sa_sigaction = leave_library;
    action.sa_flags = SA_SIGINFO;
    for (const int number : {SIGSEGV, SIGFPE, SIGABRT, SIGBUS, SIGILL})
        sigaction(number, &action, &own_handlers[number]);
}

/// A callback's time, in which a fault is this code's.
class Outside {
  public:
    Outside() { is_in_library = 0; }
    ~Outside() { is_in_library = 1; }
    Outside(const Outside&) = delete;
    Outside& operator=(const Outside&) = delete;
};

/// The extension by which the bytes are read as what they begin like.
std::string extension_of(const std::string& bytes) {
    const struct {
        const char* start;
        const char* extension;
    } known[] = {{"\x89PNG", ".png"}, {"\xff\xd8", ".jpg"}, {"BM", ".bmp"},   {"DDS ", ".dds"},   {"#?", ".hdr"},
                 {"GIF8", ".gif"},    {"II*", ".tif"},      {"MM", ".tif"},   {"RIFF", ".webp"},  {"P6", ".ppm"},
                 {"8BPS", ".psd"},    {"\x01\xda", ".sgi"}, {"FORM", ".iff"}, {"v/1\x01", ".exr"}};
    for (const auto& [start, extension] : known)
        if (bytes.starts_with(start)) return extension;
    return ".tga";
}

/// What takes a file, in the place of the program's answer.
struct Taken {
    bool is_texture;
    uint64_t left = limit;
    uint64_t texels = 0;  // still to come
    size_t texel = 0;     // bytes, as they come
    bool has_refused = false;
    bool has_failed = false;
    unsigned sum = 0;  // of all bytes, each of which is looked at
};

void look_at(Taken& taken, const void* bytes, size_t count) {
    for (size_t i = 0; i < count; ++i) taken.sum += static_cast<const unsigned char*>(bytes)[i];
}

bool begin(void* self, const OiioPicture* picture) noexcept {
    const Outside outside;
    auto& taken = *static_cast<Taken*>(self);
    fuzz::require(taken.texels == 0 && !taken.has_refused);
    const StoredTypeFacts& facts = facts_of(picture->type);
    const uint64_t texel = taken.is_texture ? texel_bytes : uint64_t{picture->channels} * facts.value_bytes;
    taken.has_refused =
        !size_problem(taken.is_texture, picture->width, picture->height, texel, taken.left, limit).empty();
    if (taken.has_refused) return false;
    fuzz::require(picture->channels > 0 && picture->channels <= (taken.is_texture ? 3 : most_stored_channels));
    for (uint32_t i = 0; i < picture->channels; ++i) taken.sum += static_cast<unsigned>(*picture->names[i]);
    taken.texels = static_cast<uint64_t>(picture->width) * static_cast<uint64_t>(picture->height);
    taken.left -= texel * taken.texels;
    taken.texel = size_t{picture->channels} * facts.sample_bytes;
    return true;
}

void take(void* self, const void* from, size_t texels) noexcept {
    const Outside outside;
    auto& taken = *static_cast<Taken*>(self);
    fuzz::require(texels > 0 && texels <= taken.texels);
    taken.texels -= texels;
    look_at(taken, from, texels * taken.texel);
}

void read(const OiioModule& oiio, const std::string& path, bool is_texture) {
    Taken taken{is_texture};
    const OiioHost host = {
        &taken,
        is_texture,
        limit,
        begin,
        [](void* self, const void* bytes, size_t count) noexcept { look_at(*static_cast<Taken*>(self), bytes, count); },
        [](void*, const char* name, const char* type, const char* text) noexcept {
            const Outside outside;
            fuzz::require(name && type && text);
        },
        take,
        [](void* self, const char* reason) noexcept {
            const Outside outside;
            fuzz::require(*reason != 0);
            static_cast<Taken*>(self)->has_failed = true;
        }};
    enter_library(true);
    if (sigsetjmp(before_library, 1) != 0) return enter_library(false);
    const bool done = oiio.read(path.c_str(), &host);
    enter_library(false);
    fuzz::require(done ? taken.texels == 0 && !taken.has_failed : taken.has_failed || taken.has_refused);
}

}  // namespace
}  // namespace cistula

FUZZ_TARGET(texture) {
    using namespace cistula;
    static const ScratchDirectory scratch;
    static const OiioModule& oiio = load_oiio(CISTULA_BUILD_MODULES, "tests");
    [[maybe_unused]] static const bool is_caught = (catch_faults(), true);
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const std::string path = scratch.file(std::string("a").append(extension_of(bytes)));
    put_bytes(path, bytes);
    for (const bool is_texture : {true, false}) read(oiio, path, is_texture);
    return 0;
}
