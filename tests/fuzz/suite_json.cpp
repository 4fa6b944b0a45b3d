// Suites: suite.json as it is read, and its text with new hashes.
#include "checks.h"
#include "compare/suite/json_edit.h"
#include "compare/suite/suite.h"
#include "scene/readers/json_reader.h"
#include "target.h"
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

}  // namespace
}  // namespace cistula

FUZZ_TARGET(suite_json) {
    using namespace cistula;
    static const ScratchDirectory folder;
    const std::string text(reinterpret_cast<const char*>(data), size);
    put_bytes(folder.file("suite.json"), text);
    try {
        const Suite suite = read_suite(folder.file(""));
        check_edit(suite);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::file) fuzz::check_error(error, ErrorKind::scene);  // a pointer of Git LFS
    }
    return 0;
}
