#include "python/released_gil.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace percale::python {

namespace {

std::atomic<bool> is_ending = false;
std::thread::id ending_thread;        // written before is_ending
std::atomic<int> threads_at_door{0};  // that will take the lock without asking again

// The state of the handler of SIGINT.
std::atomic<std::atomic<bool>*> watched = nullptr;
std::atomic<bool> has_cancelled = false;
std::atomic<int> handlers_at_work = 0;
std::atomic<void (*)(int)> handler_of_python = nullptr;

void cancel_and_report_to_python(int signal) {
    ++handlers_at_work;
    if (std::atomic<bool>* cancel = watched; cancel != nullptr) {
        has_cancelled = true;
        *cancel = true;
    }
    --handlers_at_work;
    handler_of_python.load()(signal);
}

/// Whether Python would raise KeyboardInterrupt in this thread.
bool interrupts_raise() {
    const auto threading = pybind11::module_::import("threading"), signals = pybind11::module_::import("signal");
    return threading.attr("current_thread")().is(threading.attr("main_thread")()) &&
           signals.attr("getsignal")(SIGINT).is(signals.attr("default_int_handler"));
}

/// Returns where the lock may be waited for, and never at the end.
void come_to_door() {
    ++threads_at_door;
    if (!is_ending || std::this_thread::get_id() == ending_thread) return;
    --threads_at_door;
    while (true) pause();
}

/// Called with the lock. Whoever asked before is_ending was set is let through first.
void begin_ending() {
    ending_thread = std::this_thread::get_id();
    is_ending = true;
    const pybind11::gil_scoped_release others_pass;
    while (threads_at_door > 0) std::this_thread::sleep_for(std::chrono::microseconds(100));
}

}  // namespace

ReleasedGil::ReleasedGil() : state_(PyEval_SaveThread()) {}

ReleasedGil::~ReleasedGil() {
    come_to_door();
    PyEval_RestoreThread(state_);
    --threads_at_door;
}

TakenGil::Asked::Asked() { come_to_door(); }
TakenGil::TakenGil() { --threads_at_door; }

InterruptWatch::InterruptWatch(std::atomic<bool>& cancel)
    : cancel_(cancel), before_(cancel), around_(watched), watches_(interrupts_raise()) {
    if (!watches_) return;
    if (around_ == nullptr) {
        sigaction(SIGINT, nullptr, &python_);
        const bool plain = (python_.sa_flags & SA_SIGINFO) == 0 && python_.sa_handler != SIG_DFL && python_.sa_handler != SIG_IGN;
        handler_of_python = python_.sa_handler;
        struct sigaction both = python_;
        both.sa_handler = &cancel_and_report_to_python;
        installed_ = watches_ = plain && sigaction(SIGINT, &both, nullptr) == 0;
    }
    if (watches_) watched = &cancel_;
}

InterruptWatch::~InterruptWatch() {
    struct sigaction now = {};
    // Python's code may have set another handler meanwhile.
    if (installed_ && sigaction(SIGINT, nullptr, &now) == 0 && now.sa_handler == &cancel_and_report_to_python)
        sigaction(SIGINT, &python_, nullptr);
    if (!watches_) return;
    watched = around_;
    while (handlers_at_work > 0) std::this_thread::yield();  // in another thread, with what was watched
    if (has_cancelled.exchange(false)) cancel_ = before_;    // else it is what its caller's other threads made it
}

void InterruptWatch::check() const {
    if (watches_ && PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

void watch_exit() {
    pthread_atfork(nullptr, nullptr, [] { threads_at_door = 0; });  // of os.fork: the other threads stayed behind
    pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(&begin_ending));
}

}  // namespace percale::python
