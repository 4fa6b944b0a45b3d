// The module _core: errors, keyword arguments, and work that Ctrl-C and exceptions of callbacks stop.
#include "module.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "base/machine.h"
#include "base/suggest.h"
#include "sequence/backends.h"
#include "sequence/run_context.h"

namespace cistula::python {
namespace {

constexpr std::pair<std::string_view, const char*> other_names[] = {
    {"resolution", "size"}, {"device", "devices"}, {"explore_mb", "mb"}};

constexpr const char* kinds[] = {"usage", "scene", "file", "device", "failed", "target", "interrupted"};

/// Turns an Error into the exception that cistula.errors makes of it.
void translate(const std::exception_ptr& failure, void*) {
    try {
        std::rethrow_exception(failure);
    } catch (const Error& error) {
        const Error told = error.named(argument_name);
        const auto text = [](const std::string& of) {  // names of files need not be UTF-8
            return nb::steal(PyUnicode_DecodeFSDefaultAndSize(of.data(), static_cast<Py_ssize_t>(of.size())));
        };
        const nb::object made =
            nb::module_::import_("cistula.errors")
                .attr("of_library")(text(told.what()), kinds[static_cast<size_t>(told.kind())],
                                    argument_name(told.subject()), text(told.place()), told.remedy());
        PyErr_SetObject(made.type().ptr(), made.ptr());
    }
}

std::atomic<pid_t> working_process{0};

/// The work that goes on without the GIL. Nobody who has the mutex waits for the GIL.
struct NativeWork {
    std::mutex mutex;
    std::condition_variable ended;
    std::multiset<std::atomic<bool>*> stops;  // of each work; null where it has none
    std::optional<std::thread::id> last;      // the thread that ends the interpreter
    pid_t process = 0;

    /// A forked process lacks the threads of its parent's work, which give nothing back.
    void leave_parent() {
        if (process == getpid()) return;
        if (process != 0) nb::set_leak_warnings(false);
        process = getpid();
        stops.clear();
        last.reset();
    }
    bool is_late() const { return last && *last != std::this_thread::get_id(); }
    /// Ends, as far as Python sees, a thread that has the GIL and is late.
    void hold_late_thread() {
        {
            const std::lock_guard lock(mutex);
            leave_parent();
            if (!is_late()) return;
        }
        PyEval_SaveThread();
        for (;;) pause();
    }
};
NativeWork native_work;
thread_local int works_of_thread = 0;  // nested: callbacks may call what has work, too

void end_native_work() {
    // What daemon threads have is never given back; nanobind would tell of it.
    if (nb::cast<int>(nb::module_::import_("threading").attr("active_count")()) > 1) nb::set_leak_warnings(false);
    {
        const std::lock_guard lock(native_work.mutex);
        native_work.leave_parent();
        native_work.last = std::this_thread::get_id();
        for (std::atomic<bool>* const stop : native_work.stops)
            if (stop) *stop = true;
    }
    const nb::gil_scoped_release free;
    std::unique_lock lock(native_work.mutex);
    native_work.ended.wait(lock, [] { return native_work.stops.empty(); });
}

}  // namespace

std::string argument_name(std::string_view key) {
    for (const auto& [name, other] : other_names)
        if (key == name) return other;
    return std::string(key);
}

const std::vector<std::string_view>& frame_keys() {
    static const std::vector<std::string_view> keys = {
        "resolution", "crop",        "supersample", "depth",   "cutoff", "target_error", "max_samples",
        "effects",    "threads",     "lanes",       "bits",    "layers", "z_far",        "background",
        "colorspace", "compression", "dwa_level",   "backend", "device"};
    return keys;
}

RenderRequest request_of(const Keywords& keywords, const std::vector<std::string_view>& allowed) {
    RenderRequest request;
    std::vector<std::string> names;
    for (const RequestKey& key : request_keys()) {
        if (std::find(allowed.begin(), allowed.end(), key.name) == allowed.end()) continue;
        names.push_back(argument_name(key.name));
        for (const auto& [name, value] : keywords) {
            if (name != names.back()) continue;
            try {
                key.set(request, value);
            } catch (const Error& error) {
                throw Error(error.kind(), fmt::format("`{}`={}: {}", key.name, value, error.what()));
            }
        }
    }
    for (const auto& [name, value] : keywords)
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw nb::type_error(fmt::format("there is no argument '{}'; {}", name,
                                             suggestion(name, {names.begin(), names.end()}, "arguments"))
                                     .c_str());
    check_request(request);
    return request;
}

void check_process() {
    pid_t before = 0;
    if (!working_process.compare_exchange_strong(before, getpid()) && before != getpid())
        throw std::runtime_error(
            "this process was forked off one that had used cistula, whose threads it lacks; start processes by "
            "multiprocessing's 'spawn' or 'forkserver', or use cistula in them alone");
}

void warn(const std::string& message, int level) {
    if (PyErr_WarnEx(PyExc_UserWarning, message.c_str(), level) != 0) throw nb::python_error();
}

WithoutGil::WithoutGil(std::atomic<bool>* stop) : stop_(stop) {
    if (works_of_thread++ == 0) native_work.hold_late_thread();
    {
        const std::lock_guard lock(native_work.mutex);
        native_work.stops.insert(stop);
        if (stop && native_work.is_late()) *stop = true;
    }
    state_ = PyEval_SaveThread();
}

WithoutGil::~WithoutGil() {
    PyEval_RestoreThread(state_);  // while the interpreter waits still
    {
        const std::lock_guard lock(native_work.mutex);
        const auto found = native_work.stops.find(stop_);
        if (found != native_work.stops.end()) native_work.stops.erase(found);
    }
    native_work.ended.notify_all();
    if (--works_of_thread == 0) native_work.hold_late_thread();
}

void run_interruptibly(std::atomic<bool>& stop, const std::function<void()>& work, const std::function<void()>& tick) {
    check_process();
    std::exception_ptr failure, raised;
    {
        const WithoutGil free(&stop);
        bool done = false;
        std::mutex mutex;
        std::condition_variable changed;
        std::thread worker([&] {
            works_of_thread = 1;
            try {
                work();
            } catch (...) {
                failure = std::current_exception();
            }
            const std::lock_guard lock(mutex);
            done = true;
            changed.notify_all();
        });
        std::unique_lock lock(mutex);
        while (!changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; })) {
            if (stop) continue;
            lock.unlock();
            {
                const nb::gil_scoped_acquire held;
                try {
                    if (PyErr_CheckSignals() != 0) throw nb::python_error();
                    tick();
                } catch (...) {
                    raised = std::current_exception();
                    stop = true;
                }
            }
            lock.lock();
        }
        lock.unlock();
        worker.join();
    }
    if (raised) std::rethrow_exception(raised);
    if (failure) std::rethrow_exception(failure);
    if (stop) throw std::runtime_error("stopped: Python ends");
}

void on_threads(int threads, const std::function<void()>& work) {
    if (threads == 0) return work();
    tbb::task_arena(threads).execute(work);
}

/// std::condition_variable::wait, of which GCC 12's library has a version that those of manylinux_2_34 lack; the linker
/// puts this in its place.
extern "C" void __wrap__ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE(std::condition_variable& changed,
                                                                                 std::unique_lock<std::mutex>& lock) {
    pthread_cond_wait(changed.native_handle(), lock.mutex()->native_handle());
}

NB_MODULE(_core, m) {
    nb::register_exception_translator(translate);
    m.doc() = "The native part of the package cistula.";
    m.def("end_native_work", end_native_work, "Stops all work and waits for its end, before Python ends. Internal.");
    nb::module_::import_("atexit").attr("register")(m.attr("end_native_work"));
    m.attr("version") = CISTULA_VERSION;
    m.attr("reads_all_pictures") = CISTULA_WITH_OIIO;
    m.def(
        "frame_arguments",
        [] {
            std::vector<std::string> names;
            for (const std::string_view key : frame_keys()) names.push_back(argument_name(key));
            return names;
        },
        "The names of the keyword arguments that say how frames are rendered.");
    m.def(
        "backends",
        [] { return std::vector<std::string>(backend_names, backend_names + (has_cuda_backend() ? 2 : 1)); },
        "The backends of this build.");
    m.def(
        "run_context",
        [](const Keywords& keywords) {
            const RenderRequest request = request_of(keywords, {"backend", "device"});
            const ChosenDevices devices = choose_devices(request.backend, request.devices);
            auto context = run_context("cistula");
            if (!devices.names.empty()) {
                context["devices"] = devices.names;
                context["driver"] = devices.driver;
                context["gpu_driver"] = gpu_driver_version();
            }
            return context.dump(-1, ' ', false, decltype(context)::error_handler_t::replace);
        },
        "keywords"_a, "The JSON that records begin with: date, machine, build, and the GPUs that are chosen.");
    bind_image(m);
    bind_pixel(m);
    bind_scene(m);
    bind_compare(m);
    bind_programs(m);
}

}  // namespace cistula::python
