#pragma once

#include <pybind11/numpy.h>

#include <atomic>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "format/scene.h"
#include "percale/simulation.h"
#include "python/released_gil.h"

namespace percale::python {

namespace py = pybind11;

/// What of a cloth an array shows.
enum class Shown { positions, velocities, masses };

/// A simulation as Python holds it. Its arrays are memory of their own, not the engine's, which moves and frees its own: they can
/// be read at any time, whatever becomes of cloth and simulation, and are brought up to date by every call that changes it, as
/// long as somebody holds them. All calls hold the GIL; those inside `run` let it go, and others are then refused.
class SharedSimulation {
public:
    explicit SharedSimulation(const scenes::Scene& settings);

    /// Throws RuntimeError for Python while another thread is in `run`.
    const Simulation& look() const {
        check_idle();
        return simulation_;
    }

    /// work(simulation), after which arrays are up to date.
    template <class Work>
    auto change(Work work) {
        check_idle();
        const UpToDate after{*this};
        return work(simulation_);
    }

    /// The same without the GIL; Ctrl-C cancels the step.
    template <class Work>
    auto run(Work work) {
        check_idle();
        const UpToDate after{*this};
        const Busy busy(running_);
        return interruptible(cancel_, [&] {
            const ReleasedGil others_run;
            return work(simulation_);
        });
    }

    /// For `run` in another thread, too.
    void set_cancel(bool wish) { cancel_ = wish; }

    /// The array of a cloth, read-only: (n, 3) or (n).
    py::array array(ClothId cloth, Shown what);

    StepSettings settings;  // as they are now
    const scenes::Detector detector;

private:
    struct UpToDate {
        SharedSimulation& shared;
        ~UpToDate() { shared.update_arrays(); }
    };
    struct Busy {
        explicit Busy(bool& running) : flag(running) { flag = true; }
        ~Busy() { flag = false; }
        Busy(const Busy&) = delete;
        Busy& operator=(const Busy&) = delete;
        bool& flag;
    };

    void check_idle() const;
    void update_arrays() noexcept;

    using Key = std::pair<int, Shown>;
    std::span<const double> numbers(const Key& key) const;

    std::atomic<bool> cancel_ = false;
    Simulation simulation_;
    std::map<Key, std::shared_ptr<std::vector<double>>> arrays_;
    bool running_ = false;
};

}  // namespace percale::python
