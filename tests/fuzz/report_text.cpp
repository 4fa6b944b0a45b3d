// Texts from outside, names and messages of any bytes, in the JUnit file, the JSON and the page of a suite.
#include "checks.h"
#include "compare/suite/suite_report.h"
#include "target.h"

FUZZ_TARGET(report_text) {
    using namespace cistula;
    using Json = nlohmann::json;
    const std::string text(reinterpret_cast<const char*>(data), size);
    SuiteCase one;
    one.name = text;
    one.scene = text;
    Suite suite{text, text, text, "", {}};
    std::vector<SuiteResult> results;
    for (const Outcome outcome : {Outcome::differs, Outcome::missing, Outcome::broken, Outcome::skipped}) {
        SuiteResult& result = results.emplace_back();
        result.of = &one;
        result.outcome = outcome;
        result.verdict = text;
        result.notes = {text, ""};
        result.golden = text;
    }
    const SuiteCounts counts = count_results(results, 1);
    fuzz::check_markup(junit_xml(suite, results));
    fuzz::check_markup(suite_page(suite, results, counts));
    fuzz::require(is_utf8(suite_json(suite, results, {}, counts).dump(2, ' ', false, Json::error_handler_t::replace)));
    one.name = "one";  // tables show names, which are letters, as they are
    for (const std::string& rows : {table_rows(results, 0), summary_text(counts)})
        for (const char c : rows) fuzz::require(c == '\n' || static_cast<unsigned char>(c) >= 0x20);
    return 0;
}
