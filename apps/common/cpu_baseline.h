// The processor that programs need, asked for before anything that a lesser one could not run.
#pragma once

namespace cistula {

/// Writes one line to standard error and ends the program with exit code 2 on a processor (or under a kernel) that
/// lacks any part of x86-64-v3: AVX, AVX2, FMA, BMI1, BMI2, F16C, LZCNT, MOVBE. Programs that link the target
/// cistula_cpu_baseline run it by themselves, before their first static constructor.
void require_cpu_baseline();

}  // namespace cistula
