#include "solve_step.h"

#include <algorithm>
#include <array>

#include "failure.h"
#include "schemes/schemes.h"
#include "substep/advance.h"
#include "substep/targets.h"
#include "support/deadline.h"

namespace percale {
namespace {

/// Halvings of one substep, one inside the other: the shortest is 1/64 of it. Fewer: hard impacts end as steps that did not
/// converge. More: a step that cannot be solved costs twice as much with each before it ends.
constexpr int max_halvings = 6;

/// Adds the figures of a substep, dropped ones too.
void add_figures(const SubstepResult& substep, StepReport& report) {
    report.newton_iterations += substep.newton_iterations;
    report.linear_iterations += substep.linear_iterations;
    report.line_search_cuts += substep.line_search_cuts;
    report.residual = substep.residual;
    report.smallest_fraction = std::min(report.smallest_fraction, substep.smallest_fraction);
    report.contact_stiffness = std::max(report.contact_stiffness, substep.contact_stiffness);
}

void add_flows(const StepEnergy& flows, StepEnergy& sum) {
    sum.work += flows.work;
    for (const auto entry : ledger_entries) sum.*entry += flows.*entry;
}

/// Makes a step out of substeps. Each leads from one state to another in work.ends; a failed one is dropped with its end.
class StepCover {
public:
    StepCover(const StepScene& scene, const StepState& start, Workspace& work, StepReport& report)
        : scene_(scene), start_(start), work_(work), report_(report) {}

    /// Null if a substep failed that cannot be halved any more.
    StepState* cover_whole() {
        StepState* end = cover({0.0, 1.0}, start_);
        report_.time_error = error_;
        return end;
    }

    /// Covers the step by as many lengths as the tolerance requires; the accepted state is in work.ends[2].
    StepState* cover_adaptively() {
        const double whole = scene_.settings.time_step;
        double shortest = whole, longest = 0.0;
        StepControl control = start_.control;
        StepState& accepted = work_.ends[2];
        accepted = start_;
        report_.parts = 0;
        for (double at = 0.0; at < 1.0;) {
            const StepStatus status = report_.status;
            const StepEnergy energy = report_.energy;
            // Once time is up the rest is taken in one substep with its error; an explicit scheme would diverge.
            const bool late = scene_.plan.implicit && (report_.out_of_time || is_past(work_.time.deadline));
            if (late) accepted.past.earlier_length = 0.0;  // BDF2 may not increase its lengths so fast
            const double rest = whole * (1.0 - at), length = late ? rest : next_length(control, rest);
            const double share = length / whole, to = at + share > 1.0 - 1e-9 ? 1.0 : at + share;
            error_ = 0.0;
            StepState* end = cover({at, to}, accepted);
            if (!end) return nullptr;
            const StepAttempt attempt{length, error_, facts_of(scene_.plan.scheme).order, touches()};
            StepControl judged = control;
            const bool exact = accept_attempt(attempt, scene_.settings.tolerance, judged);
            report_.out_of_time = report_.out_of_time || (late && !exact);
            if (exact || !report_.out_of_time) control = judged;
            if (!exact && !report_.out_of_time) {
                accepted.past.earlier_length = 0.0;  // BDF2 continues with shorter lengths as from a start
                report_.status = status;
                report_.energy = energy;
                if (status != StepStatus::not_converged) report_.stretched_cloth = -1, report_.stretch = 0.0;
                report_.dropped.add(SubstepOutcome::inexact);
                ++report_.rejected;
                continue;
            }
            std::swap(accepted, *end);
            if ((control.missed || !exact) && report_.status == StepStatus::ok) report_.status = StepStatus::tolerance_missed;
            ++report_.parts;
            report_.time_error += error_;
            shortest = std::min(shortest, length);
            longest = std::max(longest, length);
            at = to;
        }
        report_.smallest_dt = shortest;
        report_.largest_dt = longest;
        accepted.control = control;
        return &accepted;
    }

private:
    bool touches() const { return scene_.plan.contacts && work_.newton.current.constraints.size() > 0; }

    StepState& other_end(const StepState& state) { return &state == &work_.ends[0] ? work_.ends[1] : work_.ends[0]; }

    /// One step of the scheme over a piece of the step.
    StepState* cover(StepFraction piece, const StepState& start) {
        return scene_.plan.implicit ? cover_by_halves(piece, start) : cover_by_parts(piece, start);
    }

    StepState* cover_by_parts(StepFraction piece, const StepState& start) {
        const double length = (piece.to - piece.from) / scene_.plan.parts;
        const StepState* at = &start;
        StepState* end = nullptr;
        for (int part = 0; part < scene_.plan.parts; ++part) {
            const bool last = part + 1 == scene_.plan.parts;
            if (cancelled()) return nullptr;
            end = &other_end(*at);
            keep(advance(substep({piece.from + part * length, last ? piece.to : piece.from + (part + 1) * length}, false), *at,
                         work_, *end));
            at = end;
        }
        report_.smallest_dt = std::min(report_.smallest_dt, length * scene_.settings.time_step);
        return end;
    }

    /// Substeps that fail are solved again as two halves, and these in turn.
    StepState* cover_by_halves(StepFraction piece, const StepState& start) {
        struct Pending {
            StepFraction fraction;
            int depth;
        };
        std::array<Pending, max_halvings + 2> pending;
        std::size_t count = 0;
        pending[count++] = {piece, 0};
        const StepState* at = &start;
        StepState* end = nullptr;
        while (count > 0) {
            work_.newton.iterations_left = work_.iterations_left - report_.newton_iterations;
            work_.newton.time = work_.time;
            const auto [fraction, depth] = pending[--count];
            const Substep next = substep(fraction, depth == max_halvings);
            end = &other_end(*at);
            const SubstepResult result = advance(next, *at, work_, *end);
            work_.time = work_.newton.time;
            add_figures(result, report_);
            if (cancelled()) return nullptr;
            const bool worked_out = report_.newton_iterations >= work_.iterations_left;
            const bool taken = result.end == SubstepOutcome::solved || (result.out_of_time && result.is_usable(next.last_try));
            const bool late = work_.time.late_iterations < 0 && !taken;
            if (late || (worked_out && (!taken || count > 0))) {
                report_.status = StepStatus::work_limit;
                report_.out_of_time = late;
                return nullptr;
            }
            if (result.is_usable(next.last_try)) {
                keep(result);
                if (result.end != SubstepOutcome::solved) report_unsolved(scene_, work_, report_);
                report_.out_of_time = report_.out_of_time || result.out_of_time;
                report_.smallest_dt = std::min(report_.smallest_dt, next.length());
                report_.largest_dt = std::max(report_.largest_dt, next.length());
                at = end;
                continue;
            }
            if (next.last_try) {
                report_failure(scene_, result.end, work_, report_);
                return nullptr;
            }
            ++report_.halvings;
            report_.dropped.add(result.end);
            const double middle = 0.5 * (fraction.from + fraction.to);
            pending[count++] = {{middle, fraction.to}, depth + 1};
            pending[count++] = {{fraction.from, middle}, depth + 1};
        }
        return end;
    }

    /// Fails the step if the caller has cancelled it.
    bool cancelled() {
        const bool now = is_cancelled(work_.time.deadline);
        if (now) report_.status = StepStatus::cancelled;
        return now;
    }

    Substep substep(StepFraction fraction, bool last_try) const { return {scene_, start_.cloth.positions, fraction, last_try}; }

    void keep(const SubstepResult& result) {
        add_flows(result.flows, report_.energy);
        error_ += result.error;
    }

    const StepScene& scene_;
    const StepState& start_;
    Workspace& work_;
    StepReport& report_;
    double error_ = 0.0;  // m, estimated, of the substeps kept since it was set to 0
};

/// For a step in which no vertex is free to move.
StepState* stand_still(const StepScene& scene, const StepState& start, Workspace& work) {
    StepState& end = work.ends[0];
    end = start;
    set_rest_length({scene, start.cloth.positions, {0.0, 1.0}}, start, work.rest_length, end.cloth);  // seams still close
    end.contact_energy = 0.0;
    end.cloth.velocities.resize(scene.model.vertex_count());
    return &end;
}

void begin_newton(const StepScene& scene, Workspace& work) {
    if (!scene.plan.implicit || scene.plan.keep_work_space) return;
    const LinearSolver solver = work.newton.system.solver.in_use();
    work.newton = NewtonSpace{};
    work.newton.system.solver.begin_with(solver);
}

}  // namespace

StepState* solve_step(const StepScene& scene, const StepState& start, Workspace& work, StepReport& report) {
    if (!scene.plan.solve) return stand_still(scene, start, work);
    begin_newton(scene, work);
    StepCover cover(scene, start, work, report);
    StepState* end = scene.settings.adaptive ? cover.cover_adaptively() : cover.cover_whole();
    if (scene.plan.implicit) report.linear_solver = work.newton.system.solver.in_use();
    if (end && report.halvings > 0 && report.status == StepStatus::ok) report.status = StepStatus::halved;
    return end;
}

}  // namespace percale
