// Reading of whole files, bytes as text, and messages for the operating system's errors.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"

namespace cistula {

/// Longest side in pixels of a picture that is read; files that claim more are taken as damaged.
inline constexpr int64_t largest_picture_side = 65536;

/// An error with the text of `error_number` (errno): "PATH: cannot read: No such file or directory; check the
/// spelling". verb: "read" or "write".
Error file_error(const std::string& path, const std::string& verb, int error_number);

/// An error with a library's reason, line breaks removed: "PATH: cannot read: REASON; REMEDY".
Error file_error(const std::string& path, const std::string& verb, const std::string& reason, const char* remedy = "");

/// The size in bytes of a file; throws Error (file) if there is none, or it is a directory, a pipe or a
/// device. It is not opened, which waits for a writer where it is a pipe.
uint64_t regular_file_size(const std::string& path);

/// Throws Error (file) unless `path` is a regular file that can be opened, and not a Git LFS pointer to one.
void check_readable(const std::string& path);

/// All bytes of a file. Throws Error (file).
std::string read_file(const std::string& path);

/// The first `count` bytes, fewer where the file is shorter. Throws Error (file).
std::string read_file_start(const std::string& path, size_t count);

/// The extension in lower case with its dot: ".exr" for "a/b.EXR"; empty if there is none.
std::string lower_extension(const std::string& path);

/// Bytes as the text of a data: address.
std::string base64(const std::string& bytes);

}  // namespace cistula
