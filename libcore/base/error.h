// Errors that a user can act on, and how texts name settings.
#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/shown_text.h"

namespace cistula {

enum class ErrorKind {
    usage,        // what is asked for is wrong: a setting or an argument
    scene,        // a scene, or a suite of them, is wrong as it is written
    file,         // a file cannot be read or written
    device,       // there is no usable GPU, or CUDA is not in this build
    failed,       // what came out cannot be trusted, or does not fit together
    target,       // the target error was not met
    interrupted,  // a StopSignal was given
};

/// What somebody calls a setting; empty: it stays as it is.
using KeyNames = std::function<std::string(std::string_view key)>;

/// The text with each `key` in it as `names` calls it.
std::string name_keys(std::string_view text, const KeyNames& names);

/// An error for the user. what() is the whole message on one line (shown_text.h): "PLACE: PROBLEM; REMEDY". Settings
/// stand in it as `layers`, by their keys in a request (request_keys()) or by their names where they are another's, so
/// that name_keys() can write them as who asked knows them.
class Error : public std::runtime_error {
  public:
    /// A `problem` that begins with a setting is the setting's.
    explicit Error(ErrorKind kind, std::string_view problem, std::string_view remedy = {});

    ErrorKind kind() const { return kind_; }
    /// The setting that is wrong, "layers"; empty: none, or several.
    const std::string& subject() const { return subject_; }
    /// "a.obj:3", "scene.json:2:7" (line and column), "scene.json: /objects/0" (JSON pointer) or a path; empty: none.
    const std::string& place() const { return place_; }
    /// What would be right, where what() says it.
    const std::string& remedy() const { return remedy_; }

    /// This error, of a setting that has this value: "`KEY` VALUE: " begins what().
    Error of(std::string_view key, std::string_view value) const;
    /// This error at a place, which stands before the one that it has.
    Error at(std::string_view place) const;
    /// This error with settings named so, as by name_keys().
    Error named(const KeyNames& names) const;

  private:
    Error saying(std::string_view text) const;

    ErrorKind kind_;
    std::string subject_, place_, remedy_;
};

/// What is told of an exception that ends a program.
struct Failure {
    std::string text;  // without the program's name
    ErrorKind kind;
};

/// An exception as it is told: where memory ran out or a thread could not be started, that, and `memory_advice`.
Failure failure_of(const std::exception& error, const std::string& memory_advice);

/// A flag by which any thread stops long work, which looks at it every few milliseconds. Without a flag nothing stops.
class StopSignal {
  public:
    StopSignal() = default;
    StopSignal(const std::atomic<bool>& flag) : flag_(&flag) {}

    bool is_given() const { return flag_ && *flag_; }
    /// Throws Error (interrupted) if the signal is given.
    void check() const {
        if (is_given()) throw Error(ErrorKind::interrupted, "interrupted; nothing was written");
    }

  private:
    const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace cistula
