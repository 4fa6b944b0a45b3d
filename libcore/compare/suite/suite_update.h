// New golden images and hashes of a suite.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "compare/suite/json_edit.h"
#include "compare/suite/suite_judge.h"

namespace cistula {

/// Writes the golden images of frames that differ, and collects new hashes for suite.json.
class SuiteUpdate {
  public:
    explicit SuiteUpdate(const Suite& suite) : suite_(suite) {}

    /// Writes the frame's golden image if any bit of it is another one, and says in the result what changed: what is
    /// recorded holds. Throws Error: `usage` for a golden image outside of the suite's folder, `file`.
    void record(const SuiteFrame& frame, const LayeredPicture* golden, SuiteResult& result);

    /// Takes the new hashes of a case, if all of its frames were rendered.
    void finish(const std::vector<SuiteResult>& results);

    /// Puts the hashes that changed into suite.json as it stands now, which other runs may have changed meanwhile.
    /// Throws Error (file) if it cannot, or if a case of these is another than was rendered; those of the others are
    /// written.
    void write() const;

    /// The pictures that were recorded anew.
    size_t changed() const { return changed_; }

  private:
    const Suite& suite_;
    std::map<const SuiteCase*, JsonValues> values_;  // new ones of each case, by key
    std::mutex mutex_;
    size_t changed_ = 0;
};

}  // namespace cistula
