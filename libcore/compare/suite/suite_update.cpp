#include "compare/suite/suite_update.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/option_text.h"
#include "image/exr/exr.h"
#include "scene/readers/json_reader.h"
#include "sequence/output_name.h"

namespace cistula {
namespace {

/// Keeps other runs from changing a suite.json while this one reads and replaces it. Where the file system has no
/// locks, nothing does.
class FolderLock {
  public:
    explicit FolderLock(const std::string& folder)
        : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        if (descriptor_ >= 0) (void)!flock(descriptor_, LOCK_EX);
    }
    ~FolderLock() {
        if (descriptor_ >= 0) close(descriptor_);
    }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    const int descriptor_;
};

std::string hashes_text(const std::vector<std::string>& hashes) {
    if (hashes.size() == 1) return fmt::format("\"{}\"", hashes[0]);
    return fmt::format("[\n  \"{}\"\n]", fmt::join(hashes, "\",\n  \""));
}

/// Throws unless a golden image lies in the suite's folder, links followed.
void require_inside(const std::string& golden, const std::string& folder) {
    const auto inside =
        std::filesystem::weakly_canonical(golden).lexically_relative(std::filesystem::weakly_canonical(folder));
    if (inside.empty() || *inside.begin() == "..")
        fail_usage(
            fmt::format("{}: is outside of {}, the suite's folder, and `update` writes nothing there", golden, folder),
            "move it");
}

}  // namespace

void SuiteUpdate::record(const SuiteFrame& frame, const LayeredPicture* golden, SuiteResult& result) {
    const SuiteCase& one = *result.of;
    std::string text;
    if (!one.golden.empty() && !(golden && same_bits(*golden, frame.picture))) {
        require_inside(result.golden, suite_.folder);
        make_directory_of(result.golden);
        write_exr(result.golden, frame.picture);
        text = golden ? fmt::format("{} is written; before, {}", result.golden, result.verdict)
               : result.outcome == Outcome::missing
                   ? fmt::format("{} is new", result.golden)
                   : fmt::format("{} is written; before, {}", result.golden, result.verdict);
    } else if (one.golden.empty() && result.hash != result.expected_hash) {
        text = result.expected_hash.empty() ? fmt::format("the hash is new: {}", result.hash)
                                            : fmt::format("the hash is {}, was {}", result.hash, result.expected_hash);
    }
    if (!result.expected_film_hash.empty() && result.film_hash != result.expected_film_hash)
        text += fmt::format("{}film_hash is {}, was {}", text.empty() ? "" : "; ", result.film_hash,
                            result.expected_film_hash);
    result.outcome = Outcome::holds;
    result.verdict = text.empty() ? "unchanged" : "recorded: " + text;
    if (text.empty()) return;
    const std::lock_guard lock(mutex_);
    ++changed_;
}

void SuiteUpdate::finish(const std::vector<SuiteResult>& results) {
    if (results.empty() || std::any_of(results.begin(), results.end(),
                                       [](const SuiteResult& result) { return result.outcome != Outcome::holds; }))
        return;
    const SuiteCase& one = *results[0].of;
    std::vector<std::string> hashes, film_hashes;
    for (const SuiteResult& result : results) {
        hashes.push_back(result.hash);
        film_hashes.push_back(result.film_hash);
    }
    if (one.golden.empty() && hashes != one.hashes) {
        values_[&one]["/hash"] = hashes_text(hashes);
        if (results[0].precision)
            values_[&one]["/recorded"] = fmt::format(R"({{"version": "{}", "precision": "{}"}})", CISTULA_VERSION,
                                                     precision_name(*results[0].precision));
    }
    if (!one.film_hashes.empty() && film_hashes != one.film_hashes)
        values_[&one]["/film_hash"] = hashes_text(film_hashes);
}

void SuiteUpdate::write() const {
    if (values_.empty()) return;
    const FolderLock lock(suite_.folder);
    const Suite now = read_suite(suite_.folder);
    const Json before = parse_json(suite_.text, suite_.path);
    Json after = parse_json(now.text, now.path);
    std::map<std::string, const SuiteCase*> by_name;
    for (const SuiteCase& one : now.cases) by_name[one.name] = &one;
    const bool same_defaults = before.value("defaults", Json()) == after.value("defaults", Json());
    JsonValues values;
    std::string changed;
    for (const auto& [one, own] : values_) {
        const auto found = by_name.find(one->name);
        if (!same_defaults || found == by_name.end() ||
            before.at(Json::json_pointer(one->place)) != after.at(Json::json_pointer(found->second->place))) {
            changed += (changed.empty() ? "" : ", ") + one->name;
            continue;
        }
        for (const auto& [key, value] : own) values[found->second->place + key] = value;
    }
    if (!values.empty()) {
        const std::string text = with_json_values(now.text, values);
        for (const auto& [place, value] : values) after[Json::json_pointer(place)] = Json::parse(value);
        if (parse_json(text, now.path) != after)
            throw std::logic_error("internal error: the new suite.json is not the old one with new hashes");
        write_file_atomically(now.path, text);
    }
    if (!changed.empty())
        throw Error(
            ErrorKind::file,
            fmt::format("was changed while its cases were rendered; the hashes of these are not recorded: {}", changed),
            "run `update` for them again")
            .at(now.path);
}

}  // namespace cistula
