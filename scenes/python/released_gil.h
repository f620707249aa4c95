#pragma once

#include <pybind11/pybind11.h>
#include <signal.h>

#include <atomic>
#include <type_traits>

namespace percale::python {

/// Python's other threads run while one of these lives, as with pybind11's gil_scoped_release; but a thread that comes back to an
/// interpreter which is about to end sleeps until the process is gone. Python 3.11 ends such threads in the midst of a call,
/// which C++ answers with std::terminate: a daemon thread that was stepping aborted the program at its exit.
class ReleasedGil {
public:
    ReleasedGil();
    ~ReleasedGil();
    ReleasedGil(const ReleasedGil&) = delete;
    ReleasedGil& operator=(const ReleasedGil&) = delete;

private:
    PyThreadState* state_;
};

/// The other way round, for a call of Python within.
class TakenGil {
public:
    TakenGil();
    TakenGil(const TakenGil&) = delete;
    TakenGil& operator=(const TakenGil&) = delete;

private:
    struct Asked {
        Asked();
    };
    Asked query_boxes_;  // before the lock
    pybind11::gil_scoped_acquire gil_;
};

/// Python hears of Ctrl-C at the next line of its own code: not before a call ends that has released the GIL. While one of these
/// lives the signal sets `cancel`, too. Only where it would raise KeyboardInterrupt: on the main thread, with Python's own
/// handler.
class InterruptWatch {
public:
    explicit InterruptWatch(std::atomic<bool>& cancel);
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    /// With the GIL: raises KeyboardInterrupt where the signal has come.
    void check() const;

private:
    std::atomic<bool>& cancel_;
    const bool before_;          // what cancel was
    std::atomic<bool>* around_;  // that of a call around this one
    bool watches_;
    bool installed_ = false;
    struct sigaction python_ = {};
};

/// work(), which heeds `cancel` and comes back with the GIL; KeyboardInterrupt instead of what it gives or throws where Ctrl-C
/// ended it.
template <class Work>
auto interruptible(std::atomic<bool>& cancel, Work work) {
    const InterruptWatch watch(cancel);
    try {
        if constexpr (std::is_void_v<decltype(work())>) {
            work();
            watch.check();
        } else {
            auto made = work();
            watch.check();
            return made;
        }
    } catch (const pybind11::error_already_set&) {
        throw;
    } catch (...) {
        watch.check();
        throw;
    }
}

/// Makes the interpreter announce that it is about to end.
void watch_exit();

}  // namespace percale::python
