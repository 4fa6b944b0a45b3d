// Compares the EXRs of two folders that have the same names; exits with 1 unless all are within the threshold.
// usage: compare_folders FOLDER FOLDER THRESHOLD
#include <cistula.h>

#include <cstdio>
#include <filesystem>

using namespace cistula;
namespace fs = std::filesystem;

int main(int argc, char** argv) try {
    if (argc != 4) {
        std::fputs("usage: compare_folders FOLDER FOLDER THRESHOLD\n", stderr);
        return 2;
    }
    Thresholds thresholds;
    thresholds.hardfail = std::stod(argv[3]);
    StoredReader reader;  // decodes files in a process of its own
    bool all_pass = true;
    for (const fs::directory_entry& entry : fs::directory_iterator(argv[1])) {
        const fs::path other = argv[2] / entry.path().filename();
        if (entry.path().extension() != ".exr" || !fs::exists(other)) continue;
        const Comparison comparison =
            compare_files(reader.read(entry.path().string()), reader.read(other.string()), thresholds);
        const bool pass = passes(comparison, thresholds);
        std::printf("%s: %s, largest difference %g, %zu of %zu values differ\n", entry.path().filename().c_str(),
                    pass ? "passes" : "FAILS", comparison.max, comparison.differing(), comparison.values());
        all_pass = all_pass && pass;
    }
    return all_pass ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "compare_folders: %s\n", error.what());
    return 2;
}
