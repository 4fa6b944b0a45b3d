#include "apps/common/command_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include <cerrno>
#include <csignal>
#include <cstdio>

#include "apps/common/interrupt.h"
#include "base/file_bytes.h"
#include "base/stages.h"
#include "base/suggest.h"

namespace cistula {
namespace {

std::vector<std::string> long_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

/// Opens standard streams that are closed on /dev/null, the lowest numbers first: open() gives the lowest that is free.
/// Writing to a closed standard output stays an error.
void open_standard_streams() {
    for (int stream = 0; stream < 3; ++stream)
        if (fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            (void)!open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

[[noreturn]] void fail_unexpected(const CLI::App& app,
                                  const std::function<std::string(const std::string&)>& extra_positional) {
    for (const std::string& extra : app.remaining()) {
        if (extra.size() < 2 || extra[0] != '-') fail_usage(extra_positional(extra));
        const std::vector<std::string> names = long_names(app);
        fail_usage(fmt::format("{}: no such option; {}; --help lists them", extra,
                               suggestion(extra.substr(0, extra.find('=')), {names.begin(), names.end()}, "options")));
    }
    fail_usage("the command line cannot be read; --help shows its form");
}

}  // namespace

void read_given(const std::string& option, const std::string& text, const OptionReader& read) {
    constexpr size_t longest = 200;
    if (text.empty()) fail_usage(fmt::format("{}: the value is empty; --help shows what it takes", option));
    try {
        read(text);
    } catch (const Error& error) {
        throw Error(error.code(), fmt::format("{} {}: {}", option, first_characters(text, longest), error.what()));
    }
}

CLI::Option* add_option(CLI::App& app, const std::string& names, const std::string& value,
                        const std::string& description, const OptionReader& read) {
    const std::string name = names.substr(names.rfind(',') + 1);
    const auto read_text = [name, read](const std::string& text) { read_given(name, text, read); };
    // option_text: without what the option needs, which its description says.
    return app.add_option_function<std::string>(names, read_text, description)->type_name(value)->option_text(value);
}

void add_valued_flag(CLI::App& app, const std::string& name, const std::string& alone, const std::string& description,
                     const OptionReader& read) {
    // expected(0, 1) would take the scene's name that follows as the value; expected(0) would turn the lone flag into
    // "true".
    add_option(app, name, "", description, read)->expected(0, 0)->default_str(alone)->take_last()->option_text(" ");
}

std::string given_text(const CLI::App& app, const std::string& name) {
    const CLI::Option* const option = app.get_option(name);
    return option->count() > 0 ? option->results().back() : "";
}

bool parse_command_line(CLI::App& app, int argc, const char* const* argv,
                        const std::function<std::string(const std::string&)>& extra_positional) {
    app.allow_extras();
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return false;
    } catch (const Error&) {
        if (app.get_help_ptr()->count() > 0) return false;
        throw;
    } catch (const CLI::ParseError& error) {
        fail_usage(fmt::format("{}; --help shows the options", error.what()));
    }
    if (!app.remaining().empty()) fail_unexpected(app, extra_positional);
    for (const CLI::Option* option : app.get_options())
        if (option->count() > 0 && option->get_items_expected_min() > 0 && option->get_type_size() > 0 &&
            option->results().front().empty())
            fail_usage(fmt::format("{}: the value is empty; --help shows what it takes", option->get_name()));
    return true;
}

void print(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw file_error("standard output", "write", errno);
}

void note(const std::string& line) {
    std::fputs((message_line(line) + "\n").c_str(), stderr);
}

int run_program(const char* name, const std::string& memory_advice, const std::function<int()>& work) {
    begin_stages();
    open_standard_streams();
    std::signal(SIGXFSZ, SIG_IGN);  // exceeding a file size limit then is a write error
    // So is a pipe that nobody reads. A handler, unlike SIG_IGN, leaves it to InterruptGuard to catch what others send.
    if (std::signal(SIGPIPE, SIG_IGN) == SIG_DFL) std::signal(SIGPIPE, [](int) {});
    // Asks render for a snapshot, and ends nothing before render can make one, nor any other program.
    if (std::signal(SIGUSR1, SIG_IGN) == SIG_DFL) std::signal(SIGUSR1, [](int) {});
    const InterruptGuard guard(name);
    try {
        return work();
    } catch (const std::exception& error) {
        const Failure failure = failure_of(error, memory_advice);
        note(fmt::format("{}: {}", name, failure.text));
        return static_cast<int>(failure.code);
    }
}

}  // namespace cistula
