// Command line handling shared by all programs: numbers, names, unknown options, the end of main.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/option_text.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace cistula {

/// Exit codes of every program (docs/programs.md).
enum class ExitCode : int {
    done = 0,
    failed = 1,  // a comparison or a test case failed
    usage = 2,   // the command line or the scene is wrong
    file = 3,    // a file cannot be read or written
    device = 4,  // no usable GPU, or CUDA is not in this build
    target = 5,  // --target-error was not met
    interrupted = 130,
};

/// That of a program which an error ends.
constexpr ExitCode exit_code(ErrorKind kind) {
    constexpr ExitCode codes[] = {ExitCode::usage,  ExitCode::usage,  ExitCode::file,       ExitCode::device,
                                  ExitCode::failed, ExitCode::target, ExitCode::interrupted};
    return codes[static_cast<size_t>(kind)];
}

/// The option by which programs take a setting, with all its names, that of messages last: "--output,-o".
std::string option_names(std::string_view key);
/// The one of messages; empty if no program takes it.
std::string option_name(std::string_view key);
/// A text of the library in which settings are named as options.
std::string with_options(std::string_view text);

/// Reads the text of an option into a variable, which outlives it. Throws Error (usage): what would be right. Who calls
/// it puts the option and the text before that.
using OptionReader = std::function<void(const std::string& text)>;

/// A reader of whole numbers, of finite numbers, of one of several names: see the functions above.
template <class T>
OptionReader read_whole(T& value, int low, int high) {
    return [=, &value](const std::string& text) { value = integer_in(text, low, high); };
}
template <class T>
OptionReader read_number(T& value, double low, double high, const char* what) {
    return [=, &value](const std::string& text) { value = static_cast<T>(number_in(text, low, high, what)); };
}
template <class T>
OptionReader read_choice(T& value, std::vector<std::pair<std::string_view, T>> choices) {
    return [=, &value](const std::string& text) { value = chosen<T>(text, choices); };
}

/// A reader of what `parse` makes of a text.
template <class T, class Parse>
OptionReader read_by(T& value, Parse parse) {
    return [=, &value](const std::string& text) { value = parse(text); };
}

/// Reads the text that was given to an option. Throws Error (usage): "OPTION TEXT: " and what the reader says.
void read_given(const std::string& option, const std::string& text, const OptionReader& read);

/// Adds an option with a value, which --help calls `value`, and messages the last of its `names`. Options are read in
/// the order in which they are added, once the whole command line is known.
CLI::Option* add_option(CLI::App& app, const std::string& names, const std::string& value,
                        const std::string& description, const OptionReader& read);

/// Adds an option with an optional value: --NAME reads `alone`, --NAME=VALUE reads VALUE. The next word is never taken
/// as the value.
void add_valued_flag(CLI::App& app, const std::string& name, const std::string& alone, const std::string& description,
                     const OptionReader& read);

/// The text of an option that was given, of a flag "true"; else nothing.
std::string given_text(const CLI::App& app, const std::string& name);

/// Parses the command line into the variables bound to the options of `app`; false if --help was given. Throws Error
/// (usage) as readers do, and for unknown options and empty values; `extra_positional` makes the message for a
/// superfluous word.
bool parse_command_line(CLI::App& app, int argc, const char* const* argv,
                        const std::function<std::string(const std::string&)>& extra_positional);

/// Writes to standard output. Throws Error (file).
void print(const std::string& text);

/// Writes a text to a file, whole or not at all; "-": to standard output; "": nowhere. Throws Error (file).
void write_output(const std::string& path, const std::string& text);

/// Writes a line to standard error, settings in it as options. A failure changes nothing: what is said there never
/// decides about files.
void note(const std::string& line);

/// Runs a program's work and returns the exit code; exceptions become a line on standard error that begins with `name`.
/// `memory_advice`: advice on using less memory, for when it runs out; `work` may change it. Standard streams that are
/// closed are opened on /dev/null first, so that no file takes their numbers; writing to a closed pipe is an error of
/// that write alone.
int run_program(const char* name, const std::string& memory_advice, const std::function<int()>& work);

}  // namespace cistula
