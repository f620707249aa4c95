#pragma once

#include <span>
#include <string>
#include <vector>

#include "percale/simulation.h"
#include "stress/stress_cell.h"

// What a run under stress is judged by.
namespace percale::scenes {

/// The words of a verdict, from good to bad.
enum class StressVerdict {
    stable,
    refused,     // not run, or a step failed and its status says why; the state stayed good
    not_finite,  // a step ended with that status, whatever energy was gained on the way; the state before it stays
    gained,      // energy above the bound, and a warning or another status said so
    silent,      // energy above the bound, a pin that moved or a state that is not finite, and nothing said so
};
const char* word_of(StressVerdict verdict);

/// Figures of one run. Energies are fractions of the energy put in: kinetic and elastic at the start, work, and the maximum that
/// gravity gave until then.
struct StressFigures {
    bool finite = true;
    bool pins_kept = true;     // to the bit
    double gain = 0.0;         // total energy above that of the start and work, largest; see StressWatch
    double bound = 0.0;        // what `gain` may be
    double step_excess = 0.0;  // backward Euler: gain of a step above its own bound, largest
    double residual = 0.0;     // largest of a step
    double strain = 0.0;       // largest, of structural springs
    int steps = 0;             // accepted
    int halved = 0, not_converged = 0;
    long newton_iterations = 0, linear_iterations = 0;
    std::string status = "ok";  // of the step that failed
    std::string said = {};      // warnings of the plan, or why it was refused
};

/// Collects the figures of a run, step by step. Of backward Euler the work of what the solver left unbalanced counts as work;
/// where pins, seams or obstacles do work its bound becomes that of schemes without a law.
class StressWatch {
public:
    /// The simulation before its first step; it must report energies.
    StressWatch(const Simulation& simulation, std::span<const ClothId> cloths, std::span<const HeldVertex> held);

    /// To be called after each step, a failed one too.
    void look(const StepReport& report, const Simulation& simulation);

    StressFigures figures;

private:
    void add_energy(const StepReport& report);
    double step_bound(const StepReport& report, const Simulation& simulation) const;
    void keep_velocities(const Simulation& simulation);

    std::vector<ClothId> cloths_;
    std::vector<HeldVertex> held_;
    bool backward_euler_ = false;
    double start_ = 0.0, inner_ = 0.0, gravity_ = 0.0;  // J, at the start: total, kinetic and elastic, of gravity
    double before_ = 0.0;                               // J, total before the coming step
    double work_ = 0.0, handled_ = 0.0, fallen_ = 0.0;  // J: work, its magnitude, maximum that gravity gave
    double unbalanced_ = 0.0;                           // J, size of the work of what backward Euler's solver left
    std::vector<std::vector<Vec3>> velocities_;         // m/s, before the coming step
};

/// What `gain` may be for a scheme stepping `time_step` s, whose longest stable step is `stable_step` s.
double gain_bound(Scheme scheme, double time_step, double stable_step);

StressVerdict verdict_of(const StressFigures& figures);

/// Whether the verdict is one that the scheme must not have.
bool is_failure(Scheme scheme, StressVerdict verdict);

}  // namespace percale::scenes
