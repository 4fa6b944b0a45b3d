#include "scene/image/picture_oiio_load.h"

#include <dlfcn.h>

#include <cfenv>
#include <filesystem>
#include <vector>

#include "scene/base/file_bytes.h"

namespace cistula {
namespace {

namespace fs = std::filesystem;

constexpr const char* module_file = CISTULA_OIIO_MODULE;

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

const OiioModule* open_module(const std::string& name, std::string& reason) {
    const KeptFloatingPoint kept;
    void* const library = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const entry = library ? dlsym(library, oiio_module_entry) : nullptr;
    if (entry) return reinterpret_cast<OiioModuleEntry>(entry)();
    const char* const text = dlerror();
    reason = text ? text : "no reason given";
    if (library) dlclose(library);  // belongs to another version of Cistula
    return nullptr;
}

/// Directories relative to the program that may hold the module, nearest first.
std::vector<fs::path> directories_of_program() {
    std::error_code failure;
    const fs::path program = fs::read_symlink("/proc/self/exe", failure);
    if (failure) return {};
    const fs::path directory = program.parent_path(), prefix = directory.parent_path();
    return {directory, prefix / "lib" / "cistula", prefix / "lib"};
}

const OiioModule* find_module(const std::string& path) {
    std::string reason, places = "the library path";
    if (const OiioModule* module = open_module(module_file, reason)) return module;
    for (const fs::path& directory : directories_of_program()) {
        const fs::path file = directory / module_file;
        places += ", " + directory.string();
        std::error_code failure;
        if (!fs::exists(file, failure)) continue;  // an existing file's reason is more helpful
        if (const OiioModule* module = open_module(file.string(), reason)) return module;
    }
    throw file_error(path, "read",
                     std::string("formats other than EXR and .data need the module ") + module_file +
                         ", which cannot be loaded from " + places + ": " + reason);
}

}  // namespace

const OiioModule& load_oiio_module(const std::string& path) {
    static const OiioModule& module = *find_module(path);  // after an exception the next call tries again
    return module;
}

}  // namespace cistula
