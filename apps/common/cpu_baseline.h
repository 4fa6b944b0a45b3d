// Check of the processor's instruction set before any instruction that it may lack is executed.
#pragma once

namespace cistula {

/// Writes one line to standard error and ends the program with exit code 2 on a processor (or under a kernel) that
/// lacks any part of x86-64-v3: AVX, AVX2, FMA, BMI1, BMI2, F16C, LZCNT, MOVBE. Programs that link the target
/// cistula_cpu_baseline run it automatically before their first static constructor.
void require_cpu_baseline();

}  // namespace cistula
