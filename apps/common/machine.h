// What a program runs on, for the records that it writes.
#pragma once

#include <string>

namespace cistula {

/// What follows "KEY:" or "KEY\t:" in one of Linux's tables; empty: not there.
std::string table_value(const char* file, const std::string& key);

/// The processor's name as the kernel gives it; "unknown" where it does not.
std::string processor_name();

/// "unknown" where it has none.
std::string host_name();

/// NVIDIA's kernel driver, "580.159.04"; "unknown" where there is none.
std::string gpu_driver_version();

}  // namespace cistula
