// `render-compare suite`.
#pragma once

namespace cistula {

/// Does what the words after `suite` say; returns the exit code. Throws Error.
int run_suite(int argc, const char* const* argv);

}  // namespace cistula
