// Records of render-report, to its page.
#include "apps/render_report/html_page.h"
#include "apps/render_report/record.h"
#include "checks.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace cistula;
    try {
        const report::Record record =
            report::parse_record(std::string(reinterpret_cast<const char*>(data), size), "a.json");
        const std::string text = report::record_text(record);
        fuzz::require(report::record_text(report::parse_record(text, "b.json")) == text);
        fuzz::require(!report::report_page({record}).empty());
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::file);
    }
    return 0;
}
