#include "compare/suite/suite_update.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/atomic_file.h"
#include "compare/suite/json_edit.h"
#include "image/exr/exr.h"
#include "sequence/output_name.h"

namespace cistula {

void SuiteUpdate::record(const SuiteFrame& frame, const LayeredPicture* golden, SuiteResult& result) {
    const SuiteCase& one = *result.of;
    std::string text;
    if (!one.golden.empty() && !(golden && same_bits(*golden, frame.picture))) {
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

void SuiteUpdate::set_hashes(const SuiteCase& one, const char* key, const std::vector<std::string>& hashes) {
    std::string value = fmt::format("\"{}\"", hashes[0]);
    if (hashes.size() > 1) value = fmt::format("[\n  \"{}\"\n]", fmt::join(hashes, "\",\n  \""));
    text_ = with_json_value(text_, fmt::format("{}/{}", one.place, key), value);
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
        set_hashes(one, "hash", hashes);
        text_ = with_json_value(text_, one.place + "/recorded",
                                fmt::format(R"({{"version": "{}", "precision": "{}"}})", CISTULA_VERSION,
                                            precision_name(*results[0].precision)));
    }
    if (!one.film_hashes.empty() && film_hashes != one.film_hashes) set_hashes(one, "film_hash", film_hashes);
}

void SuiteUpdate::write() const {
    if (text_ != suite_.text) write_file_atomically(suite_.path, text_);
}

}  // namespace cistula
