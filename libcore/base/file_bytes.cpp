#include "base/file_bytes.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <system_error>

#include "base/suggest.h"

namespace cistula {
namespace {

constexpr size_t largest_pipe = size_t{1} << 30;  // what has no size may have no end

using FileHandle = std::unique_ptr<FILE, int (*)(FILE*)>;

/// Advice for the user; empty where the system's message is clear enough.
std::string remedy(const std::string& path, const std::string& verb, int error_number) {
    const std::string directory = std::filesystem::path(path).parent_path().string();
    const bool writes = verb == "write";
    switch (error_number) {
        case ENOENT:
            if (!writes) return "check the spelling";
            return directory.empty() ? "give a file name"
                                     : "create the directory " + directory + " first, or give another";
        case ENOTDIR:
            return directory + " is not a directory, give another";
        case EISDIR:
            return "give the name of a file in it";
        case EACCES:
        case EPERM:
            return writes ? "give a place that you may write to" : "ask for the right to read it";
        case EROFS:
            return "give a place that can be written to";
        case ENOSPC:
        case EDQUOT:
            return "free some space, or give a place on another disk";
        case EFBIG:
            return "raise the limit on file sizes (ulimit -f), or give a place on another disk";
        case ENAMETOOLONG:
            return "give a shorter name";
        default:
            return "";
    }
}

FileHandle open_for_reading(const std::string& path) {
    if (path.find('\0') != std::string::npos)  // the system would open what is before it
        throw Error(ErrorKind::file, "cannot read: a zero byte is in the name", "check the spelling").at(path);
    FileHandle file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) throw file_error(path, "read", errno);
    struct stat status;
    if (fstat(fileno(file.get()), &status) != 0) throw file_error(path, "read", errno);
    if (S_ISDIR(status.st_mode)) throw file_error(path, "read", EISDIR);
    if (S_ISCHR(status.st_mode))  // such as /dev/zero, which has no end
        throw file_error(path, "read", std::string("it is a device"), "give the name of a file");
    return file;
}

std::string read_up_to(const std::string& path, size_t most) {
    const FileHandle file = open_for_reading(path);
    struct stat status;
    if (fstat(fileno(file.get()), &status) != 0) throw file_error(path, "read", errno);
    const bool has_size = S_ISREG(status.st_mode);
    if (!has_size) most = std::min(most, largest_pipe + 1);
    const size_t expected = std::max<size_t>(has_size ? static_cast<size_t>(status.st_size) + 1 : 0, 1 << 16);
    std::string bytes;
    while (bytes.size() < most) {
        const size_t old_size = bytes.size();
        const size_t step = std::min(most - old_size, std::max(old_size, expected));
        bytes.resize(old_size + step);
        const size_t got = std::fread(bytes.data() + old_size, 1, step, file.get());
        bytes.resize(old_size + got);
        if (std::ferror(file.get())) throw file_error(path, "read", errno);
        if (got < step) break;
    }
    if (!has_size && bytes.size() > largest_pipe)
        throw file_error(path, "read", std::string("it is a pipe of more than 1 GiB"), "write it to a file first");
    return bytes;
}

}  // namespace

Error file_error(const std::string& path, const std::string& verb, int error_number) {
    return Error(ErrorKind::file, "cannot " + verb + ": " + std::generic_category().message(error_number),
                 remedy(path, verb, error_number))
        .at(path);
}

Error file_error(const std::string& path, const std::string& verb, const std::string& reason, const char* remedy) {
    std::string line;
    for (const char c : reason) {
        const bool blank = c == '\n' || c == '\r' || c == '\t' || c == ' ';
        if (!blank)
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    }
    while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
    return Error(ErrorKind::file, "cannot " + verb + ": " + line, remedy).at(path);
}

uint64_t regular_file_size(const std::string& path) {
    struct stat status;
    if (stat(path.c_str(), &status) != 0) throw file_error(path, "read", errno);
    if (S_ISDIR(status.st_mode)) throw file_error(path, "read", EISDIR);
    if (!S_ISREG(status.st_mode))
        throw file_error(path, "read", std::string("it is a pipe, a socket or a device"), "give a file");
    return static_cast<uint64_t>(status.st_size);
}

void check_readable(const std::string& path) {
    regular_file_size(path);  // before it is opened
    constexpr std::string_view pointer = "version https://git-lfs.github.com/spec/";
    if (read_file_start(path, pointer.size()) == pointer)
        throw file_error(path, "read",
                         std::string("it is a pointer of Git LFS, not the file; git lfs pull brings that"));
}

std::string read_file(const std::string& path) {
    return read_up_to(path, std::numeric_limits<size_t>::max());
}

std::string read_file_start(const std::string& path, size_t count) {
    return read_up_to(path, count);
}

std::string lower_extension(const std::string& path) {
    return lower_case(std::filesystem::path(path).extension().string());
}

std::string base64(const std::string& bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace cistula
