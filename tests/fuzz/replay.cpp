// Runs files through a fuzz target, without a fuzzer.
// usage: replay TARGET FOLDER...
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "target.h"

int main(int count, char** arguments) {
    const auto& targets = cistula::fuzz::targets();
    const auto target = targets.find(count > 1 ? arguments[1] : "");
    if (target == targets.end()) {
        std::fprintf(stderr, "usage: replay TARGET FOLDER...; the targets are the sources of tests/fuzz\n");
        return 2;
    }
    std::vector<std::filesystem::path> files;
    for (int i = 2; i < count; ++i)
        for (const auto& entry : std::filesystem::recursive_directory_iterator(arguments[i]))
            if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        std::printf("%s\n", file.c_str());  // the last one is the one that fails
        std::fflush(stdout);
        std::ifstream stream(file, std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
        target->second(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
    }
    if (files.empty()) std::fprintf(stderr, "no files to replay\n");
    return files.empty() ? 1 : 0;
}
