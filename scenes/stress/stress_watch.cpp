#include "stress/stress_watch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/text.h"

namespace percale::scenes {

namespace {

/// Fractions of the energy put in: rounding; what backward Euler's unfinished solves may add to its bound of 0; and the bound of
/// schemes without a law of their own. Larger: a gain of energy passes.
constexpr double energy_rounding = 1e-9, unsolved_energy = 1e-6, doubled_energy = 1.0;

/// m <v, w>, J.
double mass_product(const Simulation& simulation, ClothId cloth, std::span<const Vec3> v, std::span<const Vec3> w) {
    const std::span<const double> masses = simulation.masses(cloth);
    double sum = 0.0;
    for (std::size_t i = 0; i < masses.size(); ++i) sum += masses[i] * v[i].dot(w[i]);
    return sum;
}

bool all_finite(const Simulation& simulation, std::span<const ClothId> cloths) {
    return std::all_of(cloths.begin(), cloths.end(), [&](ClothId cloth) {
        const auto finite = [](const Vec3& x) { return x.allFinite(); };
        const std::span<const Vec3> positions = simulation.positions(cloth), velocities = simulation.velocities(cloth);
        return std::all_of(positions.begin(), positions.end(), finite) &&
               std::all_of(velocities.begin(), velocities.end(), finite);
    });
}

bool is_held(const Simulation& simulation, const HeldVertex& held) {
    return simulation.positions(held.cloth)[held.vertex] == held.place;
}

}  // namespace

const char* word_of(StressVerdict verdict) {
    return std::array{"stable", "refused", "not_finite", "gained", "silent"}[static_cast<std::size_t>(verdict)];
}

StressWatch::StressWatch(const Simulation& simulation, std::span<const ClothId> cloths, std::span<const HeldVertex> held)
    : cloths_(cloths.begin(), cloths.end()), held_(held.begin(), held.end()) {
    const ScenePlan plan = simulation.plan();
    backward_euler_ = plan.scheme == Scheme::backward_euler;
    figures.said = joined(plan.warning_texts());
    const StepEnergy energy = simulation.energy();
    start_ = before_ = energy.total();
    inner_ = energy.kinetic + energy.elastic;
    gravity_ = energy.gravity;
    keep_velocities(simulation);
}

void StressWatch::keep_velocities(const Simulation& simulation) {
    if (!backward_euler_) return;
    velocities_.clear();
    for (const ClothId cloth : cloths_) {
        const std::span<const Vec3> now = simulation.velocities(cloth);
        velocities_.emplace_back(now.begin(), now.end());
    }
}

// The end of a step of backward Euler minimises 1/2 |v - v_n|_M^2 + P(q_n + dt v) with the potential P of all forces, damping
// included, which no damping has at v = 0: so that P(q) + 1/2 |v - v_n|^2 <= P(q_n) + T_n, that is
// E - E_n <= T - 1/2 |v - v_n|^2 = <v, v_n>_M - T_n. What the solver left unbalanced adds its work.
double StressWatch::step_bound(const StepReport& report, const Simulation& simulation) const {
    double bound = 0.0;
    for (std::size_t c = 0; c < cloths_.size(); ++c) {
        const std::span<const Vec3> before = velocities_[c];
        bound += mass_product(simulation, cloths_[c], before, simulation.velocities(cloths_[c]));
        bound -= 0.5 * mass_product(simulation, cloths_[c], before, before);
    }
    return std::max(bound, 0.0) + std::abs(report.energy.residual_work);
}

void StressWatch::add_energy(const StepReport& report) {
    const StepEnergy& energy = report.energy;
    work_ += energy.work;
    handled_ += std::abs(energy.work);
    fallen_ = std::max(fallen_, gravity_ - energy.gravity);
    if (!backward_euler_) return;
    unbalanced_ += std::abs(energy.residual_work);
    // Springs that moved pins compress give more than a stretched cloth could: no law there.
    if (energy.work != 0.0) figures.bound = doubled_energy;
    figures.finite = figures.finite && std::isfinite(energy.total());
}

void StressWatch::look(const StepReport& report, const Simulation& simulation) {
    figures.finite = figures.finite && all_finite(simulation, cloths_);
    for (const HeldVertex& held : held_) figures.pins_kept = figures.pins_kept && is_held(simulation, held);
    figures.newton_iterations += report.newton_iterations;
    figures.linear_iterations += report.linear_iterations;
    if (!report.ok()) {
        figures.status = status_word(report.status);
        return;
    }
    ++figures.steps;
    figures.halved += report.status == StepStatus::halved;
    figures.not_converged += report.status == StepStatus::not_converged;
    figures.residual = std::max(figures.residual, report.residual);
    figures.strain = std::max(figures.strain, report.largest_strain);
    add_energy(report);
    const StepEnergy& energy = report.energy;
    const double seen = energy.kinetic + energy.elastic + std::abs(energy.gravity);
    const double put_in = inner_ + handled_ + fallen_ + energy_rounding * seen;
    const double risen = energy.total() - start_ - work_ - unbalanced_;
    if (risen > 0.0) figures.gain = std::max(figures.gain, risen / put_in);
    // Where pins or seams move, the potential at v = 0 is not that of the start.
    if (backward_euler_ && report.halvings == 0 && report.contacts == 0 && energy.work == 0.0) {
        const double excess = energy.total() - before_ - energy.work - step_bound(report, simulation);
        if (excess > 0.0) figures.step_excess = std::max(figures.step_excess, excess / put_in);
    }
    before_ = energy.total();
    keep_velocities(simulation);
}

double gain_bound(Scheme scheme, double time_step, double stable_step) {
    if (scheme == Scheme::backward_euler) return unsolved_energy;
    // Symplectic Euler keeps v^2 + w^2 x^2 - dt w^2 x v of an oscillator: with r = dt w/2 its energy stays between (1 - r) and
    // (1 + r) times a number.
    const double share = time_step / stable_step;
    if (scheme == Scheme::symplectic_euler && share < 1.0) return std::max(doubled_energy, 2.0 * share / (1.0 - share));
    return doubled_energy;
}

StressVerdict verdict_of(const StressFigures& figures) {
    const bool good = figures.finite && figures.pins_kept;
    const bool gained = figures.gain > figures.bound || figures.step_excess > unsolved_energy;
    const bool said = !figures.said.empty() || figures.status != "ok" || figures.not_converged > 0;
    if (!good || (gained && !said)) return StressVerdict::silent;
    if (figures.status == status_word(StepStatus::not_finite)) return StressVerdict::not_finite;
    if (gained) return StressVerdict::gained;
    return figures.status == "ok" ? StressVerdict::stable : StressVerdict::refused;
}

bool is_failure(Scheme scheme, StressVerdict verdict) {
    if (verdict == StressVerdict::silent) return true;
    const bool robust = scheme == Scheme::backward_euler || scheme == Scheme::tr_bdf2;
    return robust && (verdict == StressVerdict::gained || verdict == StressVerdict::not_finite);
}

}  // namespace percale::scenes
