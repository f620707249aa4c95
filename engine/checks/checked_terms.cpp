#include "checked_terms.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "contact/contact_stiffness.h"
#include "forces/springs.h"
#include "forces/total_force.h"
#include "linear/block_matrix.h"

namespace percale {
namespace {

/// Fraction of the shortest spring: the displacement of vertices by which derivatives are compared with differences, for
/// settings.check_derivatives. Smaller: right forces are found wrong. Larger: wrong ones pass.
constexpr double difference_step_ratio = 1e-5;

/// A single term of the list, as a function of the positions at the end of the step, with the velocities that lead there.
struct LoneTerm {
    StepEnd step;
    const ForceTerm& term;
    StepSprings springs = {};  // without damping by velocity, which has no potential
    BlockMatrix matrix = {};
    Forces forces = {};  // with a matrix, at the state
    std::vector<bool> exact = {};

    /// Sets result.total to its forces; returns its potential.
    double evaluate(const Vec3Arrays& positions, bool with_matrix, Forces& result) const {
        Vec3Arrays velocities = step.end.cloth.velocities;
        add_scaled(velocities, 1.0 / step.dt, positions);
        add_scaled(velocities, -1.0 / step.dt, step.end.cloth.positions);
        const ForceInput input = input_at(positions, velocities, with_matrix);
        result.total.resize(step.scene.model.vertex_count());
        result.blocks.clear();
        term.stand_alone(input, result);
        return term.add(input, result);
    }

    void fill(double difference_step) {
        const ClothModel& model = step.scene.model;
        evaluate(step.end.cloth.positions, true, forces);
        exact.assign(model.vertex_count(), true);
        term.mark_inexact(input_at(step.end.cloth.positions, step.end.cloth.velocities, true), forces, difference_step, exact);
        set_pattern(step.scene.compute, model.adjacency, std::vector<double>(model.vertex_count(), 0.0), matrix);
        if (forces.spring_terms.values.empty()) forces.spring_terms.values.assign(model.adjacency.value_count(), 0.0f);
        matrix.springs = &forces.spring_terms;
        set_blocks({}, forces.blocks, matrix);
    }

    /// Sets product to its part of the matrix times a direction.
    void multiply(const Vec3Arrays& direction, Vec3Arrays& product) const {
        AlignedVector<double> points;
        percale::multiply(matrix, direction, points, product);
    }

private:
    ForceInput input_at(const Vec3Arrays& positions, const Vec3Arrays& velocities, bool with_matrix) const {
        return {.compute = &step.scene.compute,
                .model = &step.scene.model,
                .springs = &springs,
                .positions = &positions,
                .velocities = &velocities,
                .gravity = step.scene.settings.gravity,
                .wind = step.scene.plan.wind ? &step.work.wind : nullptr,
                .dt = step.dt,
                .with_matrix = with_matrix};
    }
};

CheckedTerm checked_term(const std::string& name, const std::shared_ptr<LoneTerm>& check) {
    const ForceTerm& term = check->term;
    CheckedTerm checked{.name = name,
                        .add_forces =
                            [=](const Vec3Arrays& positions, Vec3Arrays& sum) {
                                Forces forces;
                                check->evaluate(positions, false, forces);
                                add_scaled(sum, 1.0, forces.total);
                            },
                        .energy =
                            [=](const Vec3Arrays& positions) {
                                Forces forces;
                                return check->evaluate(positions, false, forces);
                            },
                        .multiply = {},
                        .exact = [=](int vertex) { return static_cast<bool>(check->exact[vertex]); },
                        .kinks = term.may_be_below(),
                        .internal = term.is_internal()};
    if (check->step.scene.plan.implicit && term.is_in_matrix()) {
        checked.multiply = [=](const Vec3Arrays& direction, Vec3Arrays& product) { check->multiply(direction, product); };
    }
    return checked;
}

/// The springs without damping.
StepSprings undamped_springs(const StepEnd& step) {
    const StepScene& scene = step.scene;
    StepSprings springs;
    set_step_springs(scene.compute,
                     {scene.model.adjacency, step.start.positions, DampingForm::velocity, step.dt, step.end.cloth.rest_length,
                      &scene.model.springs},
                     springs);
    springs.velocity_damping = false;
    return springs;
}

void add_checked_terms(const StepEnd& step, double difference_step, std::vector<CheckedTerm>& terms) {
    const auto add = [&](const ForceTerm& term, const std::string& name, StepSprings springs) {
        const auto check = std::make_shared<LoneTerm>(LoneTerm{step, term, std::move(springs)});
        check->fill(difference_step);
        terms.push_back(checked_term(name, check));
    };
    for (const ForceTerm* term : force_terms()) {
        if (!term->acts({.model = &step.scene.model, .wind = step.scene.plan.wind ? &step.work.wind : nullptr})) continue;
        add(*term, std::string(term->name()), undamped_springs(step));
        if (term != &spring_term() || !step.scene.plan.implicit || step.scene.plan.damping != DampingForm::length_rate) continue;
        // These are the springs of the last substep, whose start determines them.
        add(*term, "damped springs", step.work.newton.stage.springs);
    }
}

/// The constraints of the last evaluation as planes, without friction, which has no potential.
struct ContactCheck {
    StepEnd step;
    ContactConstraints constraints;
    ContactTerms terms;
    std::vector<bool> exact;

    explicit ContactCheck(const StepEnd& of)
        : step(of), constraints(of.work.newton.current.constraints), exact(of.scene.model.vertex_count(), true) {}

    double evaluate(const Vec3Arrays& positions, Vec3Arrays& forces, ContactTerms& result) const {
        ContactConstraints moved = constraints;
        for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
            double change = 0.0;
            for (std::size_t k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
                const int i = constraints.vertex[constraint][k];
                change += constraints.weight[constraint][k] *
                          constraints.direction[constraint].dot(positions.at(i) - step.end.cloth.positions.at(i));
            }
            moved.distance[constraint] += change;
        }
        const ContactStep contact{.dt = step.dt,
                                  .fraction = 1.0,
                                  .mass = &step.scene.model.mass,
                                  .gravity = contact_gravity(step.scene.settings.gravity),
                                  .modulus = &step.scene.model.modulus,
                                  .length = &step.scene.model.length};
        std::vector<ConstraintForce> constraint_forces;
        add_contact(moved, contact, positions, forces, result, constraint_forces);
        return result.energy;
    }

    void multiply(const Vec3Arrays& direction, Vec3Arrays& product) const {
        for (const CoupledBlock& block : terms.blocks) {
            Vec3 u = Vec3::Zero();
            for (std::size_t k = 0; k < 4 && block.vertex[k] >= 0; ++k) u += block.weight[k] * direction.at(block.vertex[k]);
            const Vec3 f = block_times(block.k, u);
            for (std::size_t k = 0; k < 4 && block.vertex[k] >= 0; ++k) product.add(block.vertex[k], block.weight[k] * f);
        }
    }

    /// The matrix has nothing of what is subtracted.
    void set_exact() {
        for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
            if (constraints.mollifier[constraint] > 0.0) continue;
            for (std::size_t k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k)
                exact[constraints.vertex[constraint][k]] = false;
        }
    }
};

CheckedTerm contact_term(const StepEnd& step) {
    auto check = std::make_shared<ContactCheck>(step);
    Vec3Arrays forces;
    forces.resize(step.scene.model.vertex_count());
    check->evaluate(step.end.cloth.positions, forces, check->terms);
    check->set_exact();
    return {.name = "contact",
            .add_forces =
                [=](const Vec3Arrays& positions, Vec3Arrays& sum) {
                    ContactTerms terms;
                    check->evaluate(positions, sum, terms);
                },
            .energy =
                [=](const Vec3Arrays& positions) {
                    ContactTerms terms;
                    Vec3Arrays unused = positions;
                    return check->evaluate(positions, unused, terms);
                },
            .multiply = [=](const Vec3Arrays& direction, Vec3Arrays& product) { check->multiply(direction, product); },
            .exact = [=](int vertex) { return static_cast<bool>(check->exact[vertex]); },
            .kinks = true,
            .internal = false};
}

double reach_of(const StepEnd& step) {
    const SpringNetwork& springs = step.scene.model.springs;
    double shortest = 1.0;  // m
    for (int k = 0; k < springs.size(); ++k) {
        if (springs.rest_length[k] > 0.0) shortest = std::min(shortest, springs.rest_length[k]);
    }
    return difference_step_ratio * shortest;
}

/// "vertex 3 of cloth sheet"
std::string vertex_text(const StepEnd& step, int index) {
    for (const ClothRange& cloth : step.scene.model.cloths) {
        if (index < cloth.first || index >= cloth.first + cloth.count) continue;
        return "vertex " + std::to_string(cloth.user_vertex(index)) + " of cloth " + cloth.name;
    }
    return "vertex " + std::to_string(index);
}

std::string text_of(const StepEnd& step, const WrongDerivative& wrong) {
    std::string text = "check_derivatives: " + wrong.term + ": ";
    if (wrong.vertex >= 0)
        text += "force on " + vertex_text(step, wrong.vertex) + " as " + vertex_text(step, wrong.by_vertex) + " moves: ";
    return text + wrong.what;
}

}  // namespace

std::vector<CheckedTerm> checked_terms(const StepEnd& step) {
    std::vector<CheckedTerm> terms;
    add_checked_terms(step, reach_of(step), terms);
    const bool penalty = step.scene.settings.contact_response == ContactResponse::penalty;
    if (step.scene.plan.contacts && penalty && step.work.newton.current.constraints.size() > 0) {
        terms.push_back(contact_term(step));
    }
    return terms;
}

void check_derivatives(const StepEnd& step, StepReport& report) {
    const CheckedState state{.positions = step.end.cloth.positions,
                             .count = step.scene.model.vertex_count(),
                             .difference_step = reach_of(step),
                             .dt = step.dt};
    const std::optional<WrongDerivative> wrong = find_wrong_derivative(checked_terms(step), state);
    if (!wrong) return;
    report.status = StepStatus::wrong_derivative;
    report.wrong_derivative = text_of(step, *wrong);
}

}  // namespace percale
