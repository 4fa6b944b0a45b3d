// The memory that a process may use, and the addresses for it.
#pragma once

#include <cstdint>

namespace cistula {

/// Bytes of memory that this process can have at most: the machine's, or less where a control group (cgroup v1 and v2)
/// or `ulimit -v` says so.
uint64_t machine_memory();

/// Bytes of address space that this process uses.
uint64_t address_space();

/// Bytes of address space that `ulimit -v` leaves this process; the largest number where there is no such limit.
uint64_t address_space_left();

}  // namespace cistula
