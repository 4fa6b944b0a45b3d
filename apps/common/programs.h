// The programs as functions of their command lines, which the Python package has too. Each returns the exit code.
#pragma once

#include <functional>

namespace cistula {

struct SceneDescription;

/// `described` is called with a scene once it is read.
int render_program(int argc, const char* const* argv,
                   const std::function<void(SceneDescription&)>& described = nullptr);
int render_merge_program(int argc, const char* const* argv);
int render_compare_program(int argc, const char* const* argv);
int render_verify_program(int argc, const char* const* argv);

}  // namespace cistula
