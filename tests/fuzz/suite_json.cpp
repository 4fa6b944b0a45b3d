// Suites: suite.json as it is read, its text with new hashes, and the JUnit file and the page of its cases.
#include "checks.h"
#include "compare/suite/json_edit.h"
#include "compare/suite/suite_report.h"
#include "scene/readers/json_reader.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

/// Hashes put into the text change nothing else.
void check_edit(const Suite& suite) {
    JsonValues values;
    Json expected = parse_json(suite.text, suite.path);
    for (const SuiteCase& one : suite.cases) {
        values[one.place + "/hash"] = "[\n  \"a\",\n  \"b\"\n]";
        expected[Json::json_pointer(one.place + "/hash")] = {"a", "b"};
    }
    fuzz::require(parse_json(with_json_values(suite.text, values), suite.path) == expected);
}

/// Whatever text is in a report, it is UTF-8 without characters that XML lacks.
void check_reports(const Suite& suite, const std::string& text) {
    std::vector<SuiteResult> results;
    for (const SuiteCase& one : suite.cases) {
        SuiteResult& result = results.emplace_back();
        result.of = &one;
        result.outcome = Outcome::broken;
        result.verdict = text;
        result.notes = {text};
    }
    const std::string xml = junit_xml(suite, results);
    fuzz::require(is_utf8(xml) && is_utf8(suite_page(suite, results, count_results(results, results.size()))));
    for (const char* none : {"\xef\xbf\xbe", "\xef\xbf\xbf", "\x01", "\x1b"})
        fuzz::require(xml.find(none) == std::string::npos);
}

}  // namespace
}  // namespace cistula

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace cistula;
    static const ScratchDirectory folder;
    const std::string text(reinterpret_cast<const char*>(data), size);
    put_bytes(folder.file("suite.json"), text);
    try {
        const Suite suite = read_suite(folder.file(""));
        check_edit(suite);
        check_reports(suite, text);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::file) fuzz::check_error(error, ErrorKind::scene);  // a pointer of Git LFS
    }
    return 0;
}
