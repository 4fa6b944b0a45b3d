// The memory that a process may use.
#pragma once

#include <cstdint>

namespace cistula {

/// Bytes of memory that this process can have at most: the machine's, or less where a control group (cgroup v1 and v2)
/// or `ulimit -v` says so.
uint64_t machine_memory();

}  // namespace cistula
