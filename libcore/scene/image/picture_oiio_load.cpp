// Loads the module for OpenImageIO, which lies beside the program.
#include <dlfcn.h>

#include <cfenv>
#include <filesystem>

#include "scene/image/picture_oiio.h"

namespace cistula {
namespace {

/// Saves and restores the floating-point control register: libraries built with fast-math flush subnormal numbers to
/// zero once they are loaded.
class KeptFloatingPoint {
  public:
    KeptFloatingPoint() { std::fegetenv(&state_); }
    ~KeptFloatingPoint() { std::fesetenv(&state_); }
    KeptFloatingPoint(const KeptFloatingPoint&) = delete;
    KeptFloatingPoint& operator=(const KeptFloatingPoint&) = delete;

  private:
    std::fenv_t state_;
};

const OiioModule* module = nullptr;

}  // namespace

std::string load_oiio() {
    if (module) return "";
    std::error_code failure;
    const std::filesystem::path directory = std::filesystem::read_symlink("/proc/self/exe", failure).parent_path();
    const KeptFloatingPoint kept;
    void* const library = dlopen((directory / CISTULA_OIIO_MODULE).c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* const entry = library ? dlsym(library, oiio_module_entry) : nullptr;
    if (entry) {
        module = reinterpret_cast<OiioModuleEntry>(entry)();
        return "";
    }
    const char* const text = dlerror();
    return std::string("formats other than EXR and .data need the module " CISTULA_OIIO_MODULE
                       ", which cannot be loaded from ") +
           directory.string() + ": " + (text ? text : "no reason given");
}

bool oiio_read(const std::string& path, const OiioHost& host) {
    return module->read(path.c_str(), &host);
}

}  // namespace cistula
