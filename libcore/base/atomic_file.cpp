#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <string>

namespace cistula {
namespace {

/// Flushes a directory to the disk, without which a rename may not survive a power failure. Failure is ignored: some
/// file systems refuse, and the file is complete all the same.
void flush_directory(int directory) {
    const int readable = openat(directory, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (readable < 0) return;
    fsync(readable);
    close(readable);
}

constexpr int most_temporaries = 100;  // of one target

/// The name of a target's temporary.
std::string temporary_name(const std::string& prefix, int number) {
    return prefix + std::to_string(number) + ".part";
}

/// Removes a temporary that no living process has locked, if it is a regular file. False if there is none.
bool remove_unlocked(int directory, const std::string& name) {
    const int file = openat(directory, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return errno != ENOENT;
    struct stat status;
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && flock(file, LOCK_EX | LOCK_NB) == 0)
        unlinkat(directory, name.c_str(), 0);
    close(file);
    return true;
}

/// Removes the temporaries of a target that no living process has locked.
void remove_all_unlocked(int directory, const std::string& prefix) {
    // A temporary gets the least number that is free: so many writers would have ended well, and a later one died.
    constexpr int most_missing = 10;
    for (int number = 0, missing = 0; number < most_temporaries && missing < most_missing; ++number)
        missing = remove_unlocked(directory, temporary_name(prefix, number)) ? 0 : missing + 1;
}

/// Locks a temporary. False if another process took it for stale before that, and removes it. Where the file system has
/// no locks, there are no such processes.
bool lock(int temporary) {
    if (flock(temporary, LOCK_EX | LOCK_NB) != 0) return errno != EWOULDBLOCK;
    struct stat status;
    return fstat(temporary, &status) == 0 && status.st_nlink > 0;
}

/// The files that are being written, as far as there is room for them.
std::array<std::atomic<const AtomicFile*>, 256> open_files;

void replace_open(const AtomicFile* which, const AtomicFile* by) noexcept {
    for (std::atomic<const AtomicFile*>& file : open_files)
        if (const AtomicFile* expected = which; file.compare_exchange_strong(expected, by)) return;
}

bool is_same(const struct stat& a, const struct stat& b) {
    return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

}  // namespace

AtomicFile::Descriptor::~Descriptor() {
    if (number >= 0) close(number);
}

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
    find_target();
    create_temporary();
}

/// Opens the directory of the file that is to be replaced or made.
void AtomicFile::find_target() {
    namespace fs = std::filesystem;
    fs::path target(path_);
    if (path_.empty()) throw file_error(path_, "write", ENOENT);
    const Descriptor replaced{open(path_.c_str(), O_PATH | O_CLOEXEC)};
    const int reason = errno;
    struct stat status, link;
    const bool is_link = lstat(path_.c_str(), &link) == 0 && S_ISLNK(link.st_mode);
    if (replaced.number >= 0) {
        if (fstat(replaced.number, &status) != 0) throw file_error(path_, "write", errno);
        if (S_ISDIR(status.st_mode)) throw file_error(path_, "write", EISDIR);
        if (!S_ISREG(status.st_mode))
            throw file_error(path_, "write", std::string("it is a device or a pipe"),
                             "give the name of a regular file");
        permissions_ = static_cast<int>(status.st_mode & 0777);
        std::error_code failure;
        if (is_link) target = fs::canonical(target, failure);
        if (failure) throw file_error(path_, "write", failure.value());
    } else if (reason != ENOENT) {
        throw file_error(path_, "write", reason);
    } else if (is_link) {
        throw file_error(path_, "write", std::string("it is a symbolic link to a file that does not exist"),
                         "remove the link or give another name");
    }
    name_ = target.filename().string();
    if (name_.empty()) throw file_error(path_, "write", EISDIR);
    const fs::path directory = target.parent_path();
    directory_.number = open(directory.empty() ? "." : directory.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (directory_.number < 0) throw file_error(path_, "write", errno);
    if (replaced.number >= 0 &&
        (fstatat(directory_.number, name_.c_str(), &link, AT_SYMLINK_NOFOLLOW) != 0 || !is_same(link, status)))
        throw file_error(path_, "write", std::string("it was replaced by another file meanwhile"), "run it again");
}

/// What the names of the target's temporaries begin with.
std::string AtomicFile::prefix() const {
    // Leaves room for the rest if the name is as long as the file system allows.
    constexpr long rest = 9;  // of ".NAME.99.part"
    const long longest = fpathconf(directory_.number, _PC_NAME_MAX);
    const auto most = static_cast<size_t>(longest > 2 * rest ? longest - rest : 200);
    return std::string(1, '.').append(name_, 0, most).append(1, '.');
}

void AtomicFile::create_temporary() {
    const std::string start = prefix();
    remove_all_unlocked(directory_.number, start);
    int failure = EEXIST;
    for (int i = 0; i < most_temporaries && failure == EEXIST; ++i) {
        temporary_ = temporary_name(start, i);
        failure = open_temporary();
        if (failure != 0 || lock(descriptor_)) continue;
        close_temporary(false);
        failure = EEXIST;
    }
    if (failure != 0) throw file_error(path_, "write", failure);
    replace_open(nullptr, this);
    if (permissions_ >= 0) (void)!fchmod(descriptor_, static_cast<mode_t>(permissions_));
}

/// Creates the temporary. Returns the error's number, or 0.
int AtomicFile::open_temporary() {
    descriptor_ =
        openat(directory_.number, temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    return descriptor_ < 0 ? errno : 0;
}

/// Closes the temporary if it is open.
void AtomicFile::close_temporary(bool remove) noexcept {
    if (remove) unlinkat(directory_.number, temporary_.c_str(), 0);
    if (descriptor_ >= 0) close(descriptor_);
    descriptor_ = -1;
}

AtomicFile::~AtomicFile() {
    replace_open(this, nullptr);
    close_temporary(!temporary_.empty());
}

void AtomicFile::remove_stale(const std::string& path) {
    AtomicFile file;
    file.path_ = path;
    file.find_target();
    remove_all_unlocked(file.directory_.number, file.prefix());
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
    // EINVAL: the file system has nothing to flush.
    if (fsync(descriptor_) != 0 && errno != EINVAL) throw file_error(path_, "write", errno);
    if (renameat(directory_.number, temporary_.c_str(), directory_.number, name_.c_str()) != 0)
        throw file_error(path_, "write", errno);
    temporary_.clear();
    const int closed = close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) throw file_error(path_, "write", errno);
    flush_directory(directory_.number);
}

void remove_temporaries() noexcept {
    for (const std::atomic<const AtomicFile*>& file : open_files)
        if (const AtomicFile* const open = file; open && !open->temporary_.empty())
            unlinkat(open->directory_.number, open->temporary_.c_str(), 0);
}

void write_file_atomically(const std::string& path, std::string_view bytes) {
    AtomicFile file(path);
    file.write(bytes);
    file.commit();
}

}  // namespace cistula
