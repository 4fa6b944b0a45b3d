#include "image/reader/oiio_module.h"

#include <dlfcn.h>

#include <cfenv>
#include <new>
#include <stdexcept>

#include "base/machine.h"

namespace cistula {
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
    const std::filesystem::path file = directory / CISTULA_OIIO_MODULE;
    if (std::error_code unknown; !std::filesystem::exists(file, unknown))
        throw std::runtime_error(users + " need the module " CISTULA_OIIO_MODULE ", which is not in " +
                                 directory.string() +
                                 "; builds with OpenImageIO have it: `make build` installs and uses that");
    void* const library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
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

}  // namespace cistula
