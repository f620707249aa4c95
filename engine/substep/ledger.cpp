#include "ledger.h"

#include <array>

#include "forces/elastic.h"
#include "forces/spring_loss.h"
#include "forces/wind.h"
#include "schemes/schemes.h"
#include "state_forces.h"
#include "targets.h"

namespace percale {
namespace {

/// The stages of an explicit scheme: weights b and how far each is ahead of the last one's slopes, in steps.
struct Tableau {
    std::span<const double> weights, ahead;
};

constexpr double euler_weights[] = {1.0}, midpoint_weights[] = {0.0, 1.0}, midpoint_ahead[] = {0.5};
constexpr double rk4_weights[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0}, rk4_ahead[] = {0.5, 0.5, 1.0};

Tableau tableau_of(Scheme scheme) {
    if (scheme == Scheme::rk4) return {rk4_weights, rk4_ahead};
    if (scheme == Scheme::midpoint) return {midpoint_weights, midpoint_ahead};
    return {euler_weights, {}};
}

/// sum w . (M (v - v_n) - dt sum b_i f_i), J, over free and over prescribed vertices, and the loss of velocities.
struct Balance {
    double free = 0.0, prescribed = 0.0, kinetic = 0.0;
};

/// The account of one substep: forces are evaluated stage by stage, then compared with the momentum.
class SubstepAccount {
public:
    SubstepAccount(const Substep& substep, const SubstepStates& states, Workspace& work, StepEnergy& flows)
        : scene_(substep.scene),
          start_(states.start.cloth),
          end_(states.end.cloth),
          dt_(substep.length()),
          work_(work),
          flows_(flows) {
        work_.impulse.resize(scene_.model.vertex_count());
    }

    /// Adds a stage with the weight b; its forces are those `known`, N, or evaluated without contact.
    void take(double weight, const ForcePlace& place, const Vec3Arrays* known = nullptr) {
        if (scene_.plan.ledger) take_losses(weight, place);
        if (!known) evaluate_at(scene_, place, work_);
        add_scaled(work_.impulse, weight * dt_, known ? *known : work_.explicit_space.forces.total);
    }

    Balance balance() const {
        Balance balance;
        for (int i = 0; i < scene_.model.vertex_count(); ++i) {
            const Vec3 before = start_.velocities.at(i), after = end_.velocities.at(i);
            const Vec3 mean = (end_.positions.at(i) - start_.positions.at(i)) / dt_;
            const Vec3 momentum = scene_.model.mass[i] * (after - before);
            balance.kinetic += (mean - 0.5 * (before + after)).dot(momentum);
            (scene_.is_free(i) ? balance.free : balance.prescribed) += mean.dot(momentum - work_.impulse.at(i));
        }
        return balance;
    }

    /// Work of the air around a place on cloth that moves over the substep while the drag keeps the value of its velocities, J.
    double wind_work(const ForcePlace& place) {
        if (!set_wind_at(scene_, place.air, work_)) return 0.0;
        work_.forces.resize(scene_.model.vertex_count());
        add_wind(scene_.model, work_.wind, place.velocities, dt_, work_.forces, nullptr);
        return sum_terms(0, scene_.model.vertex_count(),
                         [&](int i) { return work_.forces.at(i).dot(end_.positions.at(i) - start_.positions.at(i)); });
    }

    /// sum w . r with the residual r of the last stage, J.
    double residual_work() const {
        return sum_terms(0, scene_.model.vertex_count(), [&](int i) {
            const Vec3 mean = (end_.positions.at(i) - start_.positions.at(i)) / dt_;
            return mean.dot(work_.newton.current.residual.at(i));
        });
    }

private:
    void take_losses(double weight, const ForcePlace& place) {
        const SpringLoss springs = spring_loss(scene_.model.springs, {.start = start_.positions,
                                                                      .end = end_.positions,
                                                                      .positions = place.positions,
                                                                      .velocities = place.velocities,
                                                                      .form = scene_.plan.damping,
                                                                      .dt = dt_,
                                                                      .rest_length = place.rest_length});
        const double shapes = shape_loss(scene_.compute, scene_.model,
                                         {start_.positions, end_.positions, place.positions, place.rest_length}, work_.elastic);
        flows_.dissipated_material += weight * springs.material;
        flows_.dissipated_integrator += weight * (springs.integrator + shapes);
    }

    const StepScene& scene_;
    const ClothState &start_, &end_;
    double dt_;
    Workspace& work_;
    StepEnergy& flows_;
};

/// Where an implicit scheme evaluates the forces of its stages, in the order of stage_weights, except for rest lengths. The air
/// of a stage is that of its beginning.
std::array<ForcePlace, 3> stage_places(const SubstepStates& states, const StagePoint& last) {
    const ClothState& start = states.start.cloth;
    const ClothState& middle = states.middle ? *states.middle : start;
    return {{{start.positions, start.velocities, start.positions, {}},
             {middle.positions, middle.velocities, start.positions, {}},
             {last.positions, last.velocities, middle.positions, {}}}};
}

/// Work of pins: in backward Euler by the momentum that the forces do not give, which is exact for its forces; in schemes of
/// second order by the mean of the forces at both ends, as the impulse of one stage would be of first order.
double pin_work(const Substep& substep, const SubstepStates& states, const Balance& balance, Workspace& work) {
    if (!substep.scene.plan.pin_work) return 0.0;
    if (facts_of(substep.scene.plan.scheme).order == 1) return balance.prescribed;
    return script_work(substep.scene, states.start.cloth, states.end.cloth, substep.length(), work).pins;
}

/// Energy dissipated by contact: by its own law where there is only one stage, else all the work of its forces.
void account_contact(const Substep& substep, const SubstepStates& states, const Balance& balance, const SubstepAccount& account,
                     Workspace& work, StepEnergy& flows) {
    const StagePoint& last = work.newton.current;
    if (substep.scene.plan.scheme == Scheme::backward_euler) {
        const ContactLoss loss = work.newton.stage.law(substep.scene.settings.contact_response)
                                     .loss({.constraints = last.constraints,
                                            .terms = last.contact,
                                            .constraint_forces = last.constraint_forces,
                                            .start = states.start.cloth.positions,
                                            .end = last.positions,
                                            .dt = substep.length(),
                                            .obstacle_rate = 1.0 / substep.scene.settings.time_step},
                                           states.start.contact_energy);
        flows.dissipated_friction += loss.friction;
        flows.dissipated_contact += loss.contact;
        flows.dissipated_integrator += loss.integrator;
        flows.residual_work += balance.free;
    } else {
        const double residual = account.residual_work();
        flows.residual_work += residual;
        flows.dissipated_contact +=
            states.start.contact_energy - states.end.contact_energy - (balance.free - residual) + states.obstacle_work;
    }
}

}  // namespace

void account_implicit(const Substep& substep, const SubstepStates& states, Workspace& work, StepEnergy& flows) {
    const StepScene& scene = substep.scene;
    const StepPlan& plan = scene.plan;
    const StagePoint& last = work.newton.current;
    states.end.contact_energy = plan.contacts ? last.contact.energy + stick_energy(last.contact.friction_contacts) +
                                                    stick_energy(last.contact.cloth_friction_contacts)
                                              : 0.0;
    flows.work += seam_work(substep, states.start, states.end.cloth) + states.obstacle_work;

    SubstepAccount account(substep, states, work, flows);
    const bool weighs = plan.ledger || plan.pin_work;
    // The forces of the last stage are known, but not without contact where that has another weight.
    const Vec3Arrays* known = facts_of(plan.scheme).stages == 2 ? nullptr : &last.forces.total;
    std::array<ForcePlace, 3> places = stage_places(states, last);
    const std::array<StageWeight, 3> weights = stage_weights(plan.scheme);
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (weights[k].weight == 0.0) continue;
        places[k].rest_length = rest_lengths_at(substep, weights[k].place, states.start, work.rest_length);
        if (plan.measures) flows.work += weights[k].weight * account.wind_work(places[k]);
        if (weighs) account.take(weights[k].weight, places[k], k == 2 ? known : nullptr);
    }
    if (!weighs) return;
    const Balance balance = account.balance();
    const double pins = pin_work(substep, states, balance, work);
    flows.work += pins;
    if (!plan.ledger) return;
    flows.dissipated_integrator += balance.kinetic - balance.prescribed + pins;
    if (plan.contacts) {
        account_contact(substep, states, balance, account, work, flows);
    } else if (plan.scheme == Scheme::bdf2) {
        const double residual = account.residual_work();
        flows.residual_work += residual;
        flows.dissipated_integrator -= balance.free - residual;
    } else {
        flows.residual_work += balance.free;
    }
}

void account_explicit(const Substep& substep, const SubstepStates& states, Workspace& work, StepEnergy& flows) {
    const StepScene& scene = substep.scene;
    const ClothState &start = states.start.cloth, &end = states.end.cloth;
    SubstepAccount account(substep, states, work, flows);
    ClothState& stage = work.ledger_stage;
    stage.positions = start.positions;
    stage.velocities = start.velocities;
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        if (!scene.is_free(i)) stage.velocities.set(i, end.velocities.at(i));
    }
    const std::span<const double> rest_length = rest_lengths_at(substep, 0.5, states.start, work.rest_length);
    const Tableau tableau = tableau_of(scene.plan.scheme);
    for (std::size_t s = 0; s < tableau.weights.size(); ++s) {
        const ForcePlace place{stage.positions, stage.velocities, stage.positions, rest_length};
        account.take(tableau.weights[s], place);
        flows.dissipated_integrator -= tableau.weights[s] * account.wind_work(place);
        if (s == tableau.ahead.size()) break;
        for (int i = 0; i < scene.model.vertex_count(); ++i) {
            const double ahead = tableau.ahead[s] * substep.length();
            stage.positions.set(i, start.positions.at(i) + ahead * stage.velocities.at(i));
            if (!scene.is_free(i)) continue;
            const Vec3 acceleration = work.explicit_space.forces.total.at(i) / scene.model.mass[i];
            stage.velocities.set(i, start.velocities.at(i) + ahead * acceleration);
        }
    }
    const Balance balance = account.balance();
    flows.dissipated_integrator += balance.kinetic - balance.prescribed;
}

}  // namespace percale
