// What a program was made of, for the records that it writes.
#pragma once

namespace cistula {

/// The compiler's flags: those of the build type and of the floating-point contract.
const char* build_flags();

/// `git describe --always --dirty` of the source tree when the build was configured; "unknown" outside a git tree.
const char* build_commit();

}  // namespace cistula
