// `render-verify` over any table of cases; main runs it over all_cases(), tests over their own.
#pragma once

#include <vector>

#include "apps/render_verify/case_table.h"

namespace cistula::verify {

/// Returns the exit code; throws Error.
int verify_program(int argc, const char* const* argv, const std::vector<CaseEntry>& cases);

}  // namespace cistula::verify
