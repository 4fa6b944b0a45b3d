// New golden images and hashes of a suite.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "compare/suite/suite_judge.h"

namespace cistula {

/// Writes the golden images of frames that differ, and collects new hashes for suite.json.
class SuiteUpdate {
  public:
    explicit SuiteUpdate(const Suite& suite) : suite_(suite), text_(suite.text) {}

    /// Writes the frame's golden image if any bit of it is another one, and says in the result what changed: what is
    /// recorded holds. Throws Error (file).
    void record(const SuiteFrame& frame, const LayeredPicture* golden, SuiteResult& result);

    /// Takes the new hashes of a case, if all of its frames were rendered.
    void finish(const std::vector<SuiteResult>& results);

    /// Writes suite.json, if a hash changed. Throws Error (file).
    void write() const;

    /// The pictures that were recorded anew.
    size_t changed() const { return changed_; }

  private:
    void set_hashes(const SuiteCase& one, const char* key, const std::vector<std::string>& hashes);

    const Suite& suite_;
    std::string text_;  // of suite.json
    std::mutex mutex_;
    size_t changed_ = 0;
};

}  // namespace cistula
