// Names of the machine's parts, facts about the build, for records; the memory that a process may use.
#pragma once

#include <cstdint>
#include <string>

namespace cistula {

/// The value after "KEY:" or "KEY\t:" in a table of Linux such as /proc/cpuinfo; empty if missing.
std::string table_value(const char* file, const std::string& key);

/// Name of the processor, from the kernel; "unknown" if missing.
std::string processor_name();

/// Name of the host; "unknown" if it has none.
std::string host_name();

/// Version of NVIDIA's kernel driver, such as "580.159.04"; "unknown" if there is none.
std::string gpu_driver_version();

/// The compiler's flags of the build type and of the floating-point contract.
const char* build_flags();

/// `git describe --always --dirty` of the source tree when the build was configured; "unknown" outside a git tree.
const char* build_commit();

/// Bytes of memory that this process can have at most: the machine's, or less where a control group (cgroup v1 and v2)
/// or `ulimit -v` says so.
uint64_t machine_memory();

/// Bytes of address space that this process uses.
uint64_t address_space();

/// Bytes of address space that `ulimit -v` leaves this process; the largest number where there is no such limit.
uint64_t address_space_left();

}  // namespace cistula
