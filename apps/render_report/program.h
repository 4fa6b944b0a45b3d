// The program render-report, from its command line to its files.
#pragma once

namespace cistula::report {

/// Runs the program and returns the exit code. Throws Error.
int report_program(int argc, const char* const* argv);

}  // namespace cistula::report
