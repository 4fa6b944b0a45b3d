#include "scene/base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>

namespace cistula {
namespace {

std::string random_letters(int count) {
    static constexpr char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
    std::random_device source;
    std::uniform_int_distribution<int> index(0, 35);
    std::string text;
    for (int i = 0; i < count; ++i) text += letters[index(source)];
    return text;
}

/// Flushes a directory to the disk, without which a rename may not survive a power failure. Failure is ignored: some
/// file systems refuse, and the file is complete all the same.
void flush_directory(const std::filesystem::path& directory) {
    const int descriptor = open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    fsync(descriptor);
    close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(path) {
    namespace fs = std::filesystem;
    struct stat status;
    const bool replaces = stat(path.c_str(), &status) == 0;
    if (replaces) {
        if (S_ISDIR(status.st_mode)) throw file_error(path, "write", EISDIR);
        if (!S_ISREG(status.st_mode))
            throw file_error(path, "write", std::string("it is a device or a pipe; give the name of a regular file"));
        std::error_code failure;
        const fs::path resolved = fs::canonical(path, failure);
        if (!failure) target_ = resolved.string();
    }
    const fs::path target(target_);
    if (target.filename().empty()) throw file_error(path, "write", path.empty() ? ENOENT : EISDIR);

    // Leaves room for the random part if the name is as long as the file system allows.
    const std::string name = target.filename().string().substr(0, 200);
    int error_number = EEXIST;
    for (int attempt = 0; attempt < 100 && descriptor_ < 0 && error_number == EEXIST; ++attempt) {
        temporary_ = (target.parent_path() / ("." + name + "." + random_letters(6) + ".part")).string();
        descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        error_number = errno;
    }
    if (descriptor_ < 0) throw file_error(path, "write", error_number);
    if (replaces) (void)!fchmod(descriptor_, status.st_mode & 07777);
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw file_error(path_, "write", errno);
        bytes.remove_prefix(static_cast<size_t>(written));
    }
}

void AtomicFile::commit() {
    if (fsync(descriptor_) != 0) throw file_error(path_, "write", errno);
    const int closed = close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) throw file_error(path_, "write", errno);
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) throw file_error(path_, "write", errno);
    temporary_.clear();
    flush_directory(std::filesystem::path(target_).parent_path());
}

void write_file_atomically(const std::string& path, std::string_view bytes) {
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
}

}  // namespace cistula
