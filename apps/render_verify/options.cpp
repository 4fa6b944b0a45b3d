#include "apps/render_verify/options.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <CLI/CLI.hpp>

#include "apps/common/command_line.h"
#include "apps/common/run_files.h"
#include "scene/base/suggest.h"

namespace cistula::verify {
namespace {

struct Texts {
    std::string backend, precision, lanes, json, html;
    std::vector<std::string> cases;
    bool quick = false, list = false, version = false;
};

void declare(CLI::App& app, Texts& texts) {
    app.add_option("--backend", texts.backend,
                   "embree (the CPU: embree, lanes, bvh, brute), cuda (a GPU) or all; embree")
        ->type_name("NAME");
    app.add_option("--precision", texts.precision, "float, double or both; both")->type_name("NAME");
    app.add_option(
           "--case", texts.cases,
           "only this case, those whose names begin so, or those that a pattern with * and ? fits; may be given "
           "several times")
        ->type_name("NAME")
        ->expected(1)
        ->take_all();
    app.add_option("--lanes", texts.lanes,
                   "the most rays that `lanes` traces at once, 1 to 16; all that the processor can")
        ->type_name("N");
    app.add_flag("--quick", texts.quick, "every case with fewer rays and smaller images");
    app.add_flag("--list", texts.list, "print the cases and exit");
    app.add_option("--json", texts.json, "write the result as JSON")->type_name("FILE");
    app.add_option("--html", texts.html, "write the result as a page that needs nothing else")->type_name("FILE");
    app.add_flag("--version", texts.version, "print the version and exit");
    app.set_help_flag("-h,--help", "print this and exit");
}

bool fits(const std::string& wanted, const std::string& name) {
    if (wanted.find_first_of("*?") != std::string::npos) return fnmatch(wanted.c_str(), name.c_str(), 0) == 0;
    return name.compare(0, wanted.size(), wanted) == 0;
}

std::vector<const CaseEntry*> chosen_cases(const std::vector<std::string>& wanted,
                                           const std::vector<CaseEntry>& cases) {
    std::vector<bool> taken(cases.size(), wanted.empty());
    for (const std::string& text : wanted) {
        bool any = false;
        for (size_t i = 0; i < cases.size() && !any; ++i)
            if (cases[i].info.name == text)
                any = taken[i] = true;  // an exact name is chosen even if it is a prefix of others
        for (size_t i = 0; i < cases.size() && !any; ++i)
            if (fits(text, cases[i].info.name)) taken[i] = true;
        for (size_t i = 0; i < cases.size(); ++i) any = any || fits(text, cases[i].info.name);
        if (any) continue;
        std::vector<std::string_view> names;
        for (const CaseEntry& entry : cases) names.push_back(entry.info.name);
        const std::string near = suggestion(text, names, "cases");
        fail_usage(fmt::format("--case {}: there is no such case; {}--list names them all", text,
                               near.rfind("did you", 0) == 0 ? near + "; " : ""));
    }
    std::vector<const CaseEntry*> chosen;
    for (size_t i = 0; i < cases.size(); ++i)
        if (taken[i]) chosen.push_back(&cases[i]);
    return chosen;
}

}  // namespace

VerifyOptions parse_verify_options(int argc, const char* const* argv, const std::vector<CaseEntry>& cases) {
    CLI::App app;
    Texts texts;
    declare(app, texts);
    VerifyOptions options;
    const bool whole = parse_command_line(app, argc, argv, [](const std::string& extra) {
        return fmt::format("{}: unexpected; a case is chosen by --case", extra);
    });
    if (!whole || texts.version) {
        options.action = whole ? VerifyAction::print_version : VerifyAction::print_help;
        return options;
    }
    using Kinds = std::vector<IntersectorKind>;
    const Kinds host{IntersectorKind::embree, IntersectorKind::lanes, IntersectorKind::bvh, IntersectorKind::brute};
    const Kinds device{IntersectorKind::cuda};
    Kinds both = host;
    both.push_back(IntersectorKind::cuda);
    options.settings.intersectors = chosen<Kinds>("--backend", texts.backend.empty() ? "embree" : texts.backend,
                                                  {{"embree", host}, {"cuda", device}, {"all", both}});
    options.cuda = options.settings.intersectors.back() == IntersectorKind::cuda;
    options.settings.precisions =
        chosen<std::vector<Precision>>("--precision", texts.precision.empty() ? "both" : texts.precision,
                                       {{"float", {Precision::single_}},
                                        {"double", {Precision::double_}},
                                        {"both", {Precision::single_, Precision::double_}}});
    options.settings.quick = texts.quick;
    if (!texts.lanes.empty()) options.settings.lanes = integer_option("--lanes", texts.lanes, 1, 16);
    options.cases = chosen_cases(texts.cases, cases);
    options.json = texts.json;
    options.html = texts.html;
    RunFiles files;
    files.writes(options.json, "--json");
    files.writes(options.html, "--html");
    if (texts.list) options.action = VerifyAction::list;
    return options;
}

std::string verify_help_text() {
    CLI::App app("Checks hard cases against closed forms, on every intersector of this machine.", "render-verify");
    Texts texts;
    declare(app, texts);
    app.footer(R"(
Examples:
  render-verify --quick                           a few minutes on a laptop
  render-verify --backend all --html verify.html  everything, on the GPU too
  render-verify --case geometry/ --precision float

Exit codes: 0 all cases hold, 1 some do not, 2 command line, 3 file, 4 device.)");
    return app.help();
}

}  // namespace cistula::verify
