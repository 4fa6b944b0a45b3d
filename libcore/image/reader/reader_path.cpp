#include "image/reader/reader_process.h"

#include <dlfcn.h>
#include <link.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace cistula {
namespace {

namespace fs = std::filesystem;

/// The file of the program or library that contains this code; empty where it is not known.
fs::path own_file() {
    Dl_info info = {};
    const bool found = dladdr(reinterpret_cast<const void*>(&reader_path), &info) != 0 && info.dli_fname;
    return found ? info.dli_fname : "";
}

/// Its handle.
void* own_handle() {
    if (void* const library = dlopen(own_file().c_str(), RTLD_LAZY | RTLD_NOLOAD)) return library;
    return dlopen(nullptr, RTLD_LAZY);  // the program itself
}

/// The directories that the dynamic linker searches for libraries of this code, nearest first.
std::vector<fs::path> library_directories() {
    std::vector<fs::path> directories;
    void* const handle = own_handle();
    if (!handle) return directories;
    Dl_serinfo sizes = {};
    if (dlinfo(handle, RTLD_DI_SERINFOSIZE, &sizes) == 0) {
        std::vector<std::max_align_t> room(sizes.dls_size / sizeof(std::max_align_t) + 1);
        auto* const list = reinterpret_cast<Dl_serinfo*>(room.data());
        if (dlinfo(handle, RTLD_DI_SERINFOSIZE, list) == 0 && dlinfo(handle, RTLD_DI_SERINFO, list) == 0)
            for (unsigned i = 0; i < list->dls_cnt; ++i) directories.emplace_back(list->dls_serpath[i].dls_name);
    }
    dlclose(handle);
    return directories;
}

/// Directories relative to the library that contains this code and to the running program, nearest first.
std::vector<fs::path> directories_beside() {
    std::vector<fs::path> directories;
    std::error_code failure;
    for (const fs::path& file : {own_file(), fs::read_symlink("/proc/self/exe", failure)}) {
        const fs::path directory = file.parent_path();
        const fs::path prefix = directory.parent_path();
        for (const fs::path& one : {directory, prefix / "lib" / "cistula", prefix / "lib"})
            if (one.is_absolute() && std::find(directories.begin(), directories.end(), one) == directories.end())
                directories.push_back(one);
    }
    return directories;
}

/// The program in a directory; empty where there is none.
std::string program_in(const fs::path& directory) {
    const fs::path file = directory / CISTULA_READ_PICTURE;
    std::error_code failure;
    const bool found = directory.is_absolute() && fs::is_regular_file(file, failure) && access(file.c_str(), X_OK) == 0;
    return found ? file.string() : std::string();
}

}  // namespace

std::string reader_path(const std::string& users) {
    for (const fs::path& directory : library_directories())
        if (std::string found = program_in(directory); !found.empty()) return found;
    std::string places = "the library path";
    for (const fs::path& directory : directories_beside()) {
        if (std::string found = program_in(directory); !found.empty()) return found;
        places += ", " + directory.string();
    }
    throw std::runtime_error(users + " need the program " CISTULA_READ_PICTURE ", which is not found on " + places +
                             "; install it with Cistula, or put it into one of them");
}

}  // namespace cistula
