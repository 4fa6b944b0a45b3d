// The program render-verify for any table of cases: main passes all_cases(), tests pass their own.
#pragma once

#include <vector>

#include "apps/render_verify/case.h"

namespace cistula::verify {

/// Runs the program. Returns the exit code; throws Error.
int verify_program(int argc, const char* const* argv, const std::vector<Case>& cases);

}  // namespace cistula::verify
