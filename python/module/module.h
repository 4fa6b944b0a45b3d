// What the sources of the module _core share. Each binds one room of the libraries.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sequence/render_request.h"

namespace cistula::python {

namespace nb = nanobind;
using namespace nb::literals;

using Triple = std::array<double, 3>;
inline nb::tuple triple(const glm::dvec3& v) {
    return nb::make_tuple(v.x, v.y, v.z);
}

/// An array that looks into memory of an object of the module, and keeps that alive.
template <class T, ssize_t... shape>
using View = nb::ndarray<nb::numpy, const T, nb::shape<shape...>, nb::device::cpu>;
/// An array that is given.
template <class T, ssize_t... shape>
using Given = nb::ndarray<const T, nb::shape<shape...>, nb::c_contig, nb::device::cpu>;

/// Keyword arguments: names of keys of a request, or what Python calls them, and values as texts.
using Keywords = std::vector<std::pair<std::string, std::string>>;

/// The request of keyword arguments that are among `allowed`. Throws Error (usage): the argument, its value and what
/// would be right; TypeError for others.
RenderRequest request_of(const Keywords& keywords, const std::vector<std::string_view>& allowed);
/// The keys that say how frames are rendered.
const std::vector<std::string_view>& frame_keys();
/// What Python calls a key.
std::string argument_name(std::string_view key);

/// Gives a UserWarning at the line `level` calls above. Throws where warnings are errors.
void warn(const std::string& message, int level);

/// Work without the GIL. Before the interpreter ends, it sets the work's `stop`, where there is one, and waits until
/// all work has ended; threads other than its own then never have the GIL again. Python would end them in the midst of
/// C++.
class WithoutGil {
  public:
    explicit WithoutGil(std::atomic<bool>* stop = nullptr);
    ~WithoutGil();
    WithoutGil(const WithoutGil&) = delete;
    WithoutGil& operator=(const WithoutGil&) = delete;

  private:
    std::atomic<bool>* stop_;
    PyThreadState* state_;
};

/// Calls work() on a thread of its own, without the GIL. This thread has Python handle signals meanwhile and calls
/// tick() with the GIL, 20 times a second, until `stop` is set; if either raises, it is, and the exception goes on once
/// work() is done. Throws where the process was forked since work began in it: its threads are gone.
void run_interruptibly(
    std::atomic<bool>& stop, const std::function<void()>& work, const std::function<void()>& tick = [] {});
void check_process();

/// On so many threads; 0: all.
void on_threads(int threads, const std::function<void()>& work);

void bind_scene(nb::module_& m);
void bind_image(nb::module_& m);
void bind_pixel(nb::module_& m);
void bind_compare(nb::module_& m);
void bind_programs(nb::module_& m);

}  // namespace cistula::python
