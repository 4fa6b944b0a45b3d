// Whole files as bytes, and the wording of the errors that the operating system gives.
#pragma once

#include <cstdint>
#include <string>

#include "scene/base/error.h"

namespace cistula {

/// Pictures with a longer side are taken for damaged files.
inline constexpr int64_t largest_picture_side = 65536;

/// "PATH: cannot read: No such file or directory; check the spelling" from errno's value. verb: "read" or "write".
Error file_error(const std::string& path, const std::string& verb, int error_number);

/// "PATH: cannot read: REASON", with the line breaks that libraries put into their reasons taken out.
Error file_error(const std::string& path, const std::string& verb, const std::string& reason);

/// Throws Error(ExitCode::file) unless `path` is a file that can be opened and is no directory.
void check_readable(const std::string& path);

/// All bytes of a file. Throws Error(ExitCode::file).
std::string read_file(const std::string& path);

/// The first `count` bytes, fewer where the file is shorter. Throws Error(ExitCode::file).
std::string read_file_start(const std::string& path, size_t count);

/// ".exr" of "a/b.EXR": the extension in lower case with its dot, empty where there is none.
std::string lower_extension(const std::string& path);

}  // namespace cistula
