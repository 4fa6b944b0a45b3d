#include "base/error.h"

#include <algorithm>
#include <new>

namespace cistula {

Error::Error(ErrorKind kind, std::string_view problem, std::string_view remedy)
    : std::runtime_error(
          message_line(std::string(problem) + (problem.empty() || remedy.empty() ? "" : "; ") + std::string(remedy))),
      kind_(kind),
      remedy_(remedy) {
    if (problem.starts_with('`')) subject_ = problem.substr(1, problem.find('`', 1) - 1);
}

Error Error::saying(std::string_view text) const {
    Error error = *this;
    static_cast<std::runtime_error&>(error) = std::runtime_error(message_line(text));
    return error;
}

Error Error::of(std::string_view key, std::string_view value) const {
    Error error = saying('`' + std::string(key) + "` " + std::string(value) + ": " + what());
    error.subject_ = key;
    return error;
}

Error Error::at(std::string_view place) const {
    const std::string before = std::string(place) + ": ";
    Error error = saying(before + what());
    error.place_ = place_.empty() ? place : before + place_;
    return error;
}

Error Error::named(const KeyNames& names) const {
    Error error = saying(name_keys(what(), names));
    error.remedy_ = name_keys(remedy_, names);
    return error;
}

std::string name_keys(std::string_view text, const KeyNames& names) {
    std::string named;
    for (size_t begin = text.find('`'), end; begin != text.npos; begin = text.find('`')) {
        end = std::min(text.find('`', begin + 1), text.size());
        const std::string other = end < text.size() ? names(text.substr(begin + 1, end - begin - 1)) : "";
        // A mark that begins no key may end one.
        named.append(text.substr(0, begin + other.empty())).append(other);
        text.remove_prefix(other.empty() ? begin + 1 : end + 1);
    }
    return named.append(text);
}

Failure failure_of(const std::exception& error, const std::string& memory_advice) {
    const std::string_view text = error.what();
    const auto says = [&](const char* words) { return text.find(words) != std::string_view::npos; };
    if (says("Resource temporarily unavailable"))  // of the system, by the standard library or TBB
        return {"cannot start a thread, for want of memory or of processes (ulimit -u); " + memory_advice,
                ErrorKind::failed};
    if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error) ||
        says("Cannot allocate memory") ||
        text.ends_with("failed to map segment from shared object"))  // the loader's; another reason would follow
        return {"out of memory; " + memory_advice, ErrorKind::failed};
    const auto* ours = dynamic_cast<const Error*>(&error);
    return {error.what(), ours ? ours->kind() : ErrorKind::failed};
}

}  // namespace cistula
