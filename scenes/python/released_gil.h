#pragma once

#include <pybind11/pybind11.h>

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
    Asked asked_;  // before the lock
    pybind11::gil_scoped_acquire gil_;
};

/// Has the interpreter say when it is about to end.
void watch_exit();

}  // namespace percale::python
