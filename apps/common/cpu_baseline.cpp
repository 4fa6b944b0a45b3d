// Check of the processor's instruction set before any instruction that it may lack is executed, in every program that
// links the target cistula_cpu_baseline. Compiled for any x86-64. It must use no templates and no inline functions of
// the library: the linker keeps one copy of each, possibly the one compiled for the baseline.
#include <cpuid.h>
#include <string.h>
#include <unistd.h>

namespace cistula {
namespace {

// __builtin_cpu_supports lacks MOVBE and, in some compilers, LZCNT and F16C.
bool has_leaf1_ecx(unsigned bit) {
    unsigned a = 0;
    unsigned b = 0;
    unsigned c = 0;
    unsigned d = 0;
    return __get_cpuid(1, &a, &b, &c, &d) && (c & bit);
}

bool has_lzcnt() {
    unsigned a = 0;
    unsigned b = 0;
    unsigned c = 0;
    unsigned d = 0;
    return __get_cpuid(0x80000001u, &a, &b, &c, &d) && (c & bit_LZCNT);
}

void append(char* line, size_t capacity, const char* text) {
    const size_t used = strlen(line);
    strncat(line, text, capacity - used - 1);
}

/// Writes one line to standard error and ends the program with exit code 2 on a processor (or under a kernel) that
/// lacks any part of x86-64-v3: AVX, AVX2, FMA, BMI1, BMI2, F16C, LZCNT, MOVBE. 101 is the first priority available to
/// programs: before every static constructor without a priority.
__attribute__((constructor(101))) void require_cpu_baseline() {
    __builtin_cpu_init();
    const struct {
        const char* name;
        bool there;
    } parts[] = {
        // The builtin also checks that the kernel saves the wide registers.
        {" AVX", __builtin_cpu_supports("avx") != 0},   {" AVX2", __builtin_cpu_supports("avx2") != 0},
        {" FMA", __builtin_cpu_supports("fma") != 0},   {" BMI1", __builtin_cpu_supports("bmi") != 0},
        {" BMI2", __builtin_cpu_supports("bmi2") != 0}, {" F16C", has_leaf1_ecx(bit_F16C)},
        {" MOVBE", has_leaf1_ecx(bit_MOVBE)},           {" LZCNT", has_lzcnt()},
    };
    char line[256] = "cistula: this processor lacks";
    bool lacks = false;
    for (const auto& part : parts) {
        if (!part.there) {
            append(line, sizeof(line), part.name);
            lacks = true;
        }
    }
    if (!lacks) return;
    append(line, sizeof(line), "; x86-64-v3 is needed (Intel Haswell of 2013, AMD Excavator or Zen, or later)\n");
    // Neither iostream nor atexit handlers are initialized yet.
    const ssize_t written = write(STDERR_FILENO, line, strlen(line));
    (void)written;
    _exit(2);
}

}  // namespace
}  // namespace cistula
