#include "base/machine.h"

#include <unistd.h>

#include <fstream>
#include <sstream>

namespace cistula {

std::string table_value(const char* file, const std::string& key) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        if (line.rfind(key, 0) != 0) continue;
        const size_t colon = line.find(':');
        const size_t value = colon == line.npos ? line.npos : line.find_first_not_of(" \t", colon + 1);
        if (value != line.npos) return line.substr(value);
    }
    return {};
}

std::string processor_name() {
    const std::string name = table_value("/proc/cpuinfo", "model name");
    return name.empty() ? "unknown" : name;
}

std::string host_name() {
    char name[256] = {};
    return gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

std::string gpu_driver_version() {
    std::istringstream words(table_value("/proc/driver/nvidia/version", "NVRM version"));
    for (std::string word; words >> word;)
        if (word[0] >= '0' && word[0] <= '9' && word.find('.') != word.npos) return word;
    return "unknown";
}

const char* build_flags() {
    return CISTULA_BUILD_FLAGS;
}

const char* build_commit() {
    return CISTULA_BUILD_COMMIT;
}

}  // namespace cistula
