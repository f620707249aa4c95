#include "percale/report.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace percale {
namespace {

std::string numbered(const char* what, int number, const std::string& name) {
    return std::string(what) + " " + std::to_string(number) + (name.empty() ? "" : " (" + name + ")");
}

/// The stretch, unless cloth is held between fixed pins and a moving body, which is not a matter of speed.
std::string stretch_text(const StepReport& report) {
    std::ostringstream text;
    text << "an edge of " << numbered("cloth", report.stretched_cloth, report.stretched_name) << " is stretched to "
         << std::round(10.0 * (1.0 + report.stretch)) / 10.0 << " times its length between its " << report.stretched_pins
         << " pinned vertices and what moves it; should its pins go along?";
    return text.str();
}

/// Why cloth does not follow a body, and which setting would help.
std::string lag_text(const StepReport& report) {
    std::ostringstream text;
    if (report.stretched_cloth >= 0) return stretch_text(report);
    if (report.blocked_by_pin) {
        text << "vertex " << report.blocked_vertex << " of " << numbered("cloth", report.blocked_cloth, report.blocked_name)
             << ", which is in its way, is pinned; should it go along?";
        return text.str();
    }
    return "take a shorter time step or a slower motion";
}

/// The sentence about something that moves too far for a step.
std::string far_text(const std::string& mover, double travel) {
    std::ostringstream text;
    text << mover << " moves " << travel
         << " m beside the cloth in one step, farther than cloth can follow; take a shorter time step or a slower motion, or "
            "teleport cloth and obstacles together and set their targets anew";
    return text.str();
}

/// A step is divided where something moves far in it; only the caller knows whether it moved or jumped.
std::string jump_text(const StepReport& report) {
    if (report.jump <= 0.0) return "";
    std::ostringstream text;
    text
        << "; something moves " << report.jump
        << " m beside the cloth in this one step: if it jumped, teleport cloth and obstacles together and set their targets anew";
    return text.str();
}

const char* limit_text(bool out_of_time) {
    if (out_of_time)
        return "its time was up before pins and obstacles had arrived; teleport what jumps, take a shorter time step, or "
               "raise the limit (set_time_limit)";
    return "more Newton iterations than work_limit allows; take a shorter time step or a slower motion, teleport what "
           "jumps, or raise the limit (set_work_limit)";
}

std::string failure_text(const StepReport& report) {
    std::ostringstream text;
    const bool by_cloth = report.blocking_obstacle < 0 && !report.blocking_name.empty();
    const std::string blocker = report.blocking_obstacle >= 0
                                    ? numbered("obstacle", report.blocking_obstacle, report.blocking_name)
                                : by_cloth ? report.blocking_name
                                           : "the obstacles";
    switch (report.status) {
        case StepStatus::pin_blocked:
            text << "pinned vertex " << report.blocked_vertex << " of "
                 << numbered("cloth", report.blocked_cloth, report.blocked_name);
            if (report.travel > 0.0) {
                text << far_text("", report.travel);
                break;
            }
            text << " cannot reach its target without taking the cloth through " << blocker;
            break;
        case StepStatus::obstacle_too_fast:
            if (report.second_obstacle >= 0) {
                const bool alone = report.second_obstacle == report.blocking_obstacle;
                if (alone)
                    text << "parts of " << blocker;
                else
                    text << blocker << " and " << numbered("obstacle", report.second_obstacle, report.second_name);
                text << " close on the cloth, which cannot get out of their way; "
                     << (report.yielded_in_vain
                             ? "the compliant obstacle gave way, but not enough in 64 parts of the step (are its edges "
                               "longer than a few thicknesses?); "
                             : "a compliant one (on_pinch) would give way; ")
                     << "smallest safe fraction of a move " << report.smallest_fraction;
                break;
            }
            if (report.travel > 0.0) {
                text << far_text(blocker, report.travel);
                break;
            }
            text << blocker << " moves faster than the cloth can follow, smallest safe fraction of a move "
                 << report.smallest_fraction << "; " << lag_text(report);
            break;
        case StepStatus::wrong_derivative:
            text << report.wrong_derivative;
            break;
        case StepStatus::not_finite:
            text << "positions or velocities would become infinite; take a shorter time step or an implicit scheme";
            break;
        case StepStatus::work_limit:
            text << limit_text(report.out_of_time);
            break;
        case StepStatus::cancelled:
            text << "its caller has cancelled it (set_cancel)";
            break;
        default:
            break;
    }
    return text.str();
}

}  // namespace

void DroppedSubsteps::add(SubstepOutcome end) {
    if (end == SubstepOutcome::not_converged) ++not_converged;
    if (end == SubstepOutcome::blocked) ++blocked;
    if (end == SubstepOutcome::not_finite) ++not_finite;
    if (end == SubstepOutcome::inexact) ++inexact;
}

DroppedSubsteps& DroppedSubsteps::operator+=(const DroppedSubsteps& more) {
    not_converged += more.not_converged;
    blocked += more.blocked;
    not_finite += more.not_finite;
    inexact += more.inexact;
    return *this;
}

std::string DroppedSubsteps::text() const {
    const std::pair<int, const char*> counts[] = {
        {not_converged, "not converged"}, {blocked, "blocked"}, {not_finite, "not finite"}, {inexact, "not exact enough"}};
    std::string text;
    for (const auto& [count, words] : counts) {
        if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + words;
    }
    return text;
}

double StepEnergy::closure() const {
    double largest = 0.0;
    for (const double entry : {kinetic, gravity, elastic, contact, work, dissipated_material, dissipated_friction,
                               dissipated_contact, dissipated_integrator, residual_work}) {
        largest = std::max(largest, std::abs(entry));
    }
    return largest > 0.0 ? std::abs(imbalance) / largest : std::abs(imbalance);
}

void set_stored_energy(const StepEnergy& stored, StepEnergy& energy) {
    energy.kinetic = stored.kinetic;
    energy.gravity = stored.gravity;
    energy.elastic = stored.elastic;
    energy.contact = stored.contact;
}

void add_step_energy(const StepEnergy& step, StepEnergy& sum) {
    const StepEnergy before = sum;
    sum = step;
    sum.work += before.work;
    for (const auto entry : ledger_entries) sum.*entry += before.*entry;
}

const char* status_word(StepStatus status) {
    switch (status) {
        case StepStatus::ok:
            return "ok";
        case StepStatus::halved:
            return "halved";
        case StepStatus::not_converged:
            return "not_converged";
        case StepStatus::tolerance_missed:
            return "tolerance_missed";
        case StepStatus::pin_blocked:
            return "pin_blocked";
        case StepStatus::obstacle_too_fast:
            return "obstacle_too_fast";
        case StepStatus::wrong_derivative:
            return "wrong_derivative";
        case StepStatus::not_finite:
            return "not_finite";
        case StepStatus::work_limit:
            return "work_limit";
        case StepStatus::cancelled:
            return "cancelled";
    }
    return "unknown";
}

const char* solver_word(LinearSolver solver) {
    switch (solver) {
        case LinearSolver::automatic:
            return "none";
        case LinearSolver::cg:
            return "cg";
        case LinearSolver::multigrid:
            return "multigrid";
        case LinearSolver::direct:
            return "direct";
    }
    return "";
}

std::string StepReport::explanation() const {
    std::ostringstream text;
    text << "step from t = " << (ok() ? time - dt : time) << " s over " << dt << " s: " << status_word(status);
    if (!ok()) text << ", " << failure_text(*this);
    if (status == StepStatus::not_converged && stretched_cloth >= 0) text << ", " << stretch_text(*this);
    text << jump_text(*this) << " (" << newton_iterations << " Newton and " << linear_iterations
         << " linear iterations, relative residual " << residual << ", " << halvings << " halvings"
         << (dropped.total() > 0 ? "; dropped: " + dropped.text() : "") << (out_of_time ? "; ended by its time limit" : "");
    if (ok() && time_error > 0.0) text << "; estimated error " << time_error << " m";
    text << ")";
    return text.str();
}

void StepReport::explain(std::FILE* out) const { std::fprintf(out, "%s\n", explanation().c_str()); }

}  // namespace percale
