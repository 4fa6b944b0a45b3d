#include "sequence/run_files.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "base/error.h"

namespace cistula {
RunFiles::Place RunFiles::place_of(const std::string& path) {
    namespace fs = std::filesystem;
    struct stat status;
    if (stat(path.c_str(), &status) == 0) return {status.st_dev, status.st_ino, ""};
    const fs::path folder = fs::path(path).parent_path();
    if (folder_ != folder.string()) {
        std::error_code error;
        // Made absolute first: weakly_canonical leaves a relative path unchanged if its first part does not exist.
        const fs::path absolute = folder.empty() ? fs::current_path(error) : fs::absolute(folder, error);
        fs::path real = fs::weakly_canonical(absolute, error), rest;
        if (real.empty()) real = absolute.lexically_normal();
        for (; stat(real.c_str(), &status) != 0 && real.has_relative_path(); real = real.parent_path())
            rest = real.filename() / rest;
        place_of_folder_ = {status.st_dev, status.st_ino, rest.string()};
        folder_ = folder.string();
    }
    Place place = place_of_folder_;
    place.rest += fs::path(path).filename().string();
    return place;
}

RunFiles::RunFiles() {
    add_stream(STDOUT_FILENO, "standard output");
    add_stream(STDERR_FILENO, "standard error");
    if (const char* const config = std::getenv("OCIO")) reads(config, "the config that $OCIO names");
}

void RunFiles::add_stream(int descriptor, const std::string& what) {
    struct stat status;
    if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode))
        uses_.emplace(Place{status.st_dev, status.st_ino, ""}, Use{what, what});
}

void RunFiles::reads(const std::string& path, const std::string& what) {
    if (path == "-")
        add_stream(STDIN_FILENO, what);
    else if (!path.empty())
        uses_.emplace(place_of(path), Use{path, what});
}

void RunFiles::reads_scene(const std::string& path, const std::vector<std::string>& files) {
    reads(path, "the scene");
    for (const std::string& file : files) reads(file, file + ", which the scene names,");
}

void RunFiles::writes(const std::string& path, const std::string& what) {
    if (path.empty()) return;
    const auto [entry, is_new] = uses_.emplace(place_of(path), Use{path, what});
    if (is_new) return;
    const Use& other = entry->second;
    throw Error(ErrorKind::usage,
                fmt::format("would be both {} and {}{}", other.what, what, other.what == what ? ", " + other.path : ""),
                "give each a file of its own")
        .at(path);
}

}  // namespace cistula
