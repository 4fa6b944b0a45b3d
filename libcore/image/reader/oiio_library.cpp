#include "image/reader/oiio_module.h"

#include <dlfcn.h>

#include <cfenv>
#include <new>
#include <stdexcept>

#include "base/machine.h"

namespace cistula {
#ifdef CISTULA_OIIO_MODULE
namespace {

/// Bytes of address space that the module and its libraries may take while they are loaded. With OpenImageIO 2.4 of
/// Debian 12 these are 428 MiB, 32 of them the stacks of threads. Some of the libraries abort, or wait for ever, where
/// that fails.
constexpr uint64_t module_address_space = 512 << 20;

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

const OiioModule* module_in(const std::filesystem::path& directory, const std::string& users) {
    if (address_space_left() < module_address_space) throw std::bad_alloc();
    const KeptFloatingPoint kept;
    void* const library = dlopen((directory / CISTULA_OIIO_MODULE).c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* const entry = library ? dlsym(library, oiio_module_entry) : nullptr;
    if (entry) return reinterpret_cast<OiioModuleEntry>(entry)();
    const char* const text = dlerror();
    throw std::runtime_error(users + " need the module " CISTULA_OIIO_MODULE ", which cannot be loaded from " +
                             directory.string() + ": " + (text ? text : "no reason given"));
}

}  // namespace

const OiioModule& load_oiio(const std::filesystem::path& directory, const std::string& users) {
    static const OiioModule* const module = module_in(directory, users);
    return *module;
}
#else
const OiioModule& load_oiio(const std::filesystem::path&, const std::string& users) {
    throw std::runtime_error("this build has no OpenImageIO (CISTULA_WITH_OIIO=OFF), which " + users +
                             " need; `make build` installs it (Debian: libopenimageio-dev) and builds with it");
}
#endif

}  // namespace cistula
