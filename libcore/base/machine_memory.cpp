#include "base/machine.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace cistula {
namespace {

namespace fs = std::filesystem;

/// The least number in files `name` of the folder root/group and of those above it, down to `most`. Where there is no
/// limit, the file says "max" or a number beyond all memory.
uint64_t least_limit(const fs::path& root, const std::string& group, const char* name, uint64_t most) {
    for (fs::path folder = fs::path(group).relative_path();; folder = folder.parent_path()) {
        std::ifstream file(root / folder / name);
        if (uint64_t limit = 0; file >> limit) most = std::min(most, limit);
        if (folder.empty()) return most;
    }
}

}  // namespace

uint64_t machine_memory() {
    uint64_t most = static_cast<uint64_t>(std::max(sysconf(_SC_PHYS_PAGES), 0L)) *
                    static_cast<uint64_t>(std::max(sysconf(_SC_PAGESIZE), 0L));
    if (rlimit limit = {}; getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        most = std::min<uint64_t>(most, limit.rlim_cur);
    std::ifstream groups("/proc/self/cgroup");  // lines NUMBER:CONTROLLERS:GROUP; version 2 has no controllers
    for (std::string line; std::getline(groups, line);) {
        const size_t first = line.find(':');
        const size_t second = line.find(':', first + 1);
        if (first == line.npos || second == line.npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::string group = line.substr(second + 1);
        if (controllers.empty())
            most = least_limit("/sys/fs/cgroup", group, "memory.max", most);
        else if (controllers == "memory")
            most = least_limit("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes", most);
    }
    return most;
}

uint64_t address_space() {
    uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

uint64_t address_space_left() {
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return UINT64_MAX;
    return limit.rlim_cur - std::min<uint64_t>(limit.rlim_cur, address_space());
}

}  // namespace cistula
