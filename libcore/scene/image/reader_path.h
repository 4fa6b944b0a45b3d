// Where the program that reads pictures lies.
#pragma once

#include <string>

namespace cistula {

/// The path of cistula-read-picture. It is searched where the dynamic linker searches the libraries of whatever this
/// code is linked to (its RUNPATH among them), then in the running program's own directory and in ../lib/cistula and
/// ../lib beside it. Throws std::runtime_error that names these directories, and what needs it, `users`.
std::string reader_path(const std::string& users);

}  // namespace cistula
