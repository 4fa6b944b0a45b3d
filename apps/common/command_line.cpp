#include "apps/common/command_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>

#include "apps/common/interrupt.h"
#include "base/atomic_file.h"
#include "base/file_bytes.h"
#include "base/stages.h"
#include "base/suggest.h"
#include "sequence/render_request.h"

namespace cistula {
namespace {

/// Options that are not called after their keys.
constexpr std::pair<std::string_view, std::string_view> other_names[] = {
    {"scene", "SCENE"},      {"output", "--output,-o"}, {"frames", "-f,--frames"},
    {"resolution", "--res"}, {"quiet", "-q,--quiet"},   {"verbose", "-v,--verbose"}};

/// Settings that messages of the library name and that are no keys of a request.
constexpr std::string_view other_settings[] = {
    "failflip", "failssim", "jobs",         "run_commands",   "fail",       "hardfail",       "mask",
    "filter",   "update",   "list_devices", "print_template", "explore_mb", "allow_nonfinite"};

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
        const std::string name = extra.substr(0, extra.find('='));
        const std::string key(scene_key_of_option(name));
        const auto has = [&](const std::string& option) { return std::ranges::count(names, option) > 0; };
        if (!key.empty() && has("--res") && !has("--" + key))  // of a program that renders scenes
            fail_usage(fmt::format("{}: no such option; the scene file says it, as '{}'", extra, key));
        fail_usage(fmt::format("{}: no such option; {}; --help lists them", extra,
                               suggestion(name, {names.begin(), names.end()}, "options")));
    }
    fail_usage("the command line cannot be read; --help shows its form");
}

}  // namespace

std::string option_names(std::string_view key) {
    for (const auto& [name, names] : other_names)
        if (name == key) return std::string(names);
    std::string option = "--" + std::string(key);
    std::replace(option.begin(), option.end(), '_', '-');
    return option;
}

std::string option_name(std::string_view key) {
    const auto is_it = [&](const RequestKey& known) { return known.name == key; };
    if (std::none_of(request_keys().begin(), request_keys().end(), is_it) &&
        std::count(std::begin(other_settings), std::end(other_settings), key) == 0)
        return "";
    const std::string names = option_names(key);
    return names.substr(names.rfind(',') + 1);
}

std::string with_options(std::string_view text) {
    return name_keys(text, option_name);
}

void read_given(const std::string& option, const std::string& text, const OptionReader& read) {
    constexpr size_t longest = 200;
    if (text.empty()) fail_usage(fmt::format("{}: the value is empty; --help shows what it takes", option));
    try {
        read(text);
    } catch (const Error& error) {
        throw Error(error.kind(), fmt::format("{} {}: {}", option, first_characters(text, longest), error.what()));
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
        for (const CLI::Option* option : app.get_options())
            if (option->count() > 1 && option->get_expected_max() == 1)
                fail_usage(fmt::format("{}: given {} times, as {} and {}; give it once", option->get_name(),
                                       option->count(), option->results()[0], option->results()[1]));
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

void write_output(const std::string& path, const std::string& text) {
    if (path == "-")
        print(text);
    else if (!path.empty())
        write_file_atomically(path, text);
}

void note(const std::string& line) {
    std::fputs((with_options(message_line(line)) + "\n").c_str(), stderr);
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
        return static_cast<int>(exit_code(failure.kind));
    }
}

}  // namespace cistula
