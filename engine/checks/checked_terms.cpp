#include "checked_terms.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "forces/gravity.h"
#include "forces/hinge_bending.h"
#include "forces/membrane_springs.h"
#include "forces/wind.h"
#include "tolerances.h"

namespace percale {
namespace {

Vec3 symmetric_product(const SymmetricBlock& k, const Vec3& u) {
    const auto& [xx, xy, xz, yy, yz, zz] = k;
    return {xx * u.x() + xy * u.y() + xz * u.z(), xy * u.x() + yy * u.y() + yz * u.z(), xz * u.x() + yz * u.y() + zz * u.z()};
}

/// What the terms of springs and triangles share: the model's adjacency at the end of a step.
struct SpringCheck {
    StepEnd step;
    StepSprings springs;
    SpringTerms terms;  // at the state
    std::vector<bool> exact;
    Vectors still;  // velocities

    explicit SpringCheck(const StepEnd& of) : step(of), exact(of.scene.model.vertex_count(), true) {
        still.resize(of.scene.model.vertex_count());
    }

    const Adjacency& adjacency() const { return step.scene.model.adjacency; }
    double dt() const { return step.dt; }
    SpringMotion motion(const Vectors& positions) const { return {positions, still, dt()}; }

    /// product = terms times a direction.
    void multiply(const Vectors& direction, Vectors& product) const {
        const std::vector<double> massless(step.scene.model.vertex_count(), 0.0);
        BlockMatrix matrix;
        set_pattern(step.scene.compute, adjacency(), massless, matrix);
        matrix.springs = &terms;
        AlignedVector<double> points;
        percale::multiply(matrix, direction, points, product);
    }

    void set_inexact(int spring) {
        exact[step.scene.model.springs.first[spring]] = exact[step.scene.model.springs.second[spring]] = false;
    }
};

double evaluate_network(const SpringCheck& check, const Vectors& positions, bool with_matrix, Vectors& forces,
                        SpringTerms& terms) {
    return evaluate_springs(check.step.scene.compute, check.springs, check.motion(positions), with_matrix, forces, terms);
}

/// Triangles alone: the springs of their edges are nothing.
double evaluate_triangles(const SpringCheck& check, const Vectors& positions, bool with_matrix, Vectors& forces,
                          SpringTerms& terms) {
    pack_points(check.step.scene.compute, check.adjacency(), positions, terms.points);
    if (with_matrix) terms.values.assign(check.adjacency().value_count(), 0.0f);
    return evaluate_membrane(check.step.scene.compute, check.adjacency(), check.motion(positions), with_matrix, forces, terms);
}

template <class Evaluate>
CheckedTerm term_of(const std::string& name, const std::shared_ptr<SpringCheck>& check, Evaluate evaluate_at) {
    Vectors forces = check->still;
    evaluate_at(*check, check->step.end.cloth.positions, true, forces, check->terms);
    CheckedTerm term{.name = name,
                     .add_forces =
                         [=](const Vectors& positions, Vectors& sum) {
                             SpringTerms terms;
                             evaluate_at(*check, positions, false, sum, terms);
                         },
                     .energy =
                         [=](const Vectors& positions) {
                             SpringTerms terms;
                             Vectors unused = check->still;
                             return evaluate_at(*check, positions, false, unused, terms);
                         },
                     .multiply = [=](const Vectors& direction, Vectors& product) { check->multiply(direction, product); },
                     .exact = [=](int vertex) { return static_cast<bool>(check->exact[vertex]); }};
    if (!check->step.scene.plan.implicit) term.multiply = {};
    return term;
}

/// Springs in one damping form, without damping by velocity, which has no potential. Compressed ones are clamped in the matrix.
CheckedTerm spring_term(const StepEnd& step, const std::string& name, DampingForm form) {
    auto check = std::make_shared<SpringCheck>(step);
    if (form == DampingForm::length_rate) {
        check->springs = step.work.newton.springs;  // those of the last span, whose start made them what they are
    } else {
        set_step_springs(
            step.scene.compute,
            {check->adjacency(), step.start.positions, form, check->dt(), step.end.cloth.rest_length, &step.scene.model.springs},
            check->springs);
    }
    check->springs.velocity_damping = false;
    CheckedTerm term = term_of(name, check, evaluate_network);
    const SpringNetwork& network = step.scene.model.springs;
    for (int k = 0; k < network.size(); ++k) {
        const int place = check->adjacency().place[k];
        const double length =
            (step.end.cloth.positions.at(network.first[k]) - step.end.cloth.positions.at(network.second[k])).norm();
        const bool pulls = length > check->springs.entries.rest_length[place];
        if (!pulls && check->springs.entries.stiffness[place] > 0.0) check->set_inexact(k);
    }
    return term;
}

/// Edges that push are clamped in the matrix.
CheckedTerm membrane_term(const StepEnd& step) {
    auto check = std::make_shared<SpringCheck>(step);
    CheckedTerm term = term_of("membrane", check, evaluate_triangles);
    for (int k = 0; k < step.scene.model.springs.size(); ++k) {
        const SpringBlock block = spring_block(check->adjacency(), check->terms, k);
        if (block.a == 0.0 && block.w != Vec3::Zero()) check->set_inexact(k);
    }
    return term;
}

/// What rest angles change; the matrix keeps that of flat hinges, which claims nothing here.
CheckedTerm curved_hinge_term(const StepEnd& step) {
    return {.name = "curved hinges",
            .add_forces = [step](const Vectors& positions,
                                 Vectors& forces) { add_curved_hinges(step.scene.model.hinges, positions, forces); },
            .energy =
                [step](const Vectors& positions) {
                    Vectors unused = positions;
                    return add_curved_hinges(step.scene.model.hinges, positions, unused);
                },
            .multiply = {},
            .exact = {}};
}

/// Drag as a function of the positions at the end of the step, with the velocities that lead there.
struct WindCheck {
    StepEnd step;
    WindTerms terms;
    std::vector<bool> exact;

    /// The drag has a kink where the air does not move along a triangle, or not across it.
    void set_exact(double slow) {
        for (std::size_t k = 0; k < step.scene.model.triangles.size(); ++k) {
            const Vec3& n = step.work.wind.triangles[k].normal;
            for (const int vertex : step.scene.model.triangles[k]) {
                const Vec3 u = step.end.cloth.velocities.at(vertex) - step.work.wind.velocity;
                const double across = n.dot(u);
                if (std::abs(across) < slow || (u - across * n).norm() < slow) exact[vertex] = false;
            }
        }
    }

    double evaluate(const Vectors& positions, Vectors& forces, WindTerms& result) const {
        const double dt = step.dt;
        Vectors velocities = step.end.cloth.velocities;
        add_scaled(velocities, 1.0 / dt, positions);
        add_scaled(velocities, -1.0 / dt, step.end.cloth.positions);
        add_wind(step.scene.model, step.work.wind, velocities, dt, forces, result);
        return result.potential;
    }
};

CheckedTerm wind_term(const StepEnd& step, double reach) {
    auto check = std::make_shared<WindCheck>(WindCheck{step, {}, std::vector<bool>(step.scene.model.vertex_count(), true)});
    check->set_exact(wind_kink_reaches * reach / step.dt);
    Vectors forces = step.end.cloth.positions;
    check->evaluate(step.end.cloth.positions, forces, check->terms);
    return {.name = "wind",
            .add_forces =
                [=](const Vectors& positions, Vectors& sum) {
                    WindTerms terms;
                    check->evaluate(positions, sum, terms);
                },
            .energy =
                [=](const Vectors& positions) {
                    WindTerms terms;
                    Vectors unused = positions;
                    return check->evaluate(positions, unused, terms);
                },
            .multiply =
                [=](const Vectors& direction, Vectors& product) {
                    for (std::size_t i = 0; i < check->terms.blocks.size(); ++i) {
                        const int vertex = static_cast<int>(i);
                        product.add(vertex, symmetric_product(check->terms.blocks[i], direction.at(vertex)));
                    }
                },
            .exact = [=](int vertex) { return static_cast<bool>(check->exact[vertex]); },
            .kinks = true,
            .internal = false};
}

CheckedTerm gravity_term(const StepEnd& step) {
    CheckedTerm term{.name = "gravity", .add_forces = {}, .energy = {}, .multiply = {}, .exact = {}, .internal = false};
    term.add_forces = [step](const Vectors&, Vectors& forces) {
        Vectors own = forces;
        set_gravity_forces(step.scene.model.mass, step.scene.settings.gravity, own);
        add_scaled(forces, 1.0, own);
    };
    term.energy = [step](const Vectors& positions) {
        return gravity_energy(step.scene.model.mass, step.scene.settings.gravity, positions);
    };
    return term;
}

/// The rows of the last evaluation as planes, without friction, which has no potential.
struct ContactCheck {
    StepEnd step;
    ContactRows rows;
    ContactTerms terms;
    std::vector<bool> exact;

    explicit ContactCheck(const StepEnd& of)
        : step(of), rows(of.work.newton.current.rows), exact(of.scene.model.vertex_count(), true) {}

    double evaluate(const Vectors& positions, Vectors& forces, ContactTerms& result) const {
        ContactRows moved = rows;
        for (std::size_t row = 0; row < rows.size(); ++row) {
            double change = 0.0;
            for (std::size_t k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
                const int i = rows.vertex[row][k];
                change += rows.weight[row][k] * rows.direction[row].dot(positions.at(i) - step.end.cloth.positions.at(i));
            }
            moved.distance[row] += change;
        }
        const ContactStep contact{.dt = step.dt,
                                  .stiffness_dt = step.end.contact_dt,
                                  .fraction = 1.0,
                                  .gravity = step.scene.settings.gravity,
                                  .mass = &step.scene.model.mass,
                                  .diagonal = &step.work.newton.frozen_diagonal,
                                  .load = &step.work.newton.frozen_load};
        add_contact(moved, contact, positions, forces, result);
        return result.energy;
    }

    void multiply(const Vectors& direction, Vectors& product) const {
        for (const CoupledBlock& block : terms.blocks) {
            Vec3 u = Vec3::Zero();
            for (std::size_t k = 0; k < 4 && block.vertex[k] >= 0; ++k) u += block.weight[k] * direction.at(block.vertex[k]);
            const Vec3 f = symmetric_product(block.k, u);
            for (std::size_t k = 0; k < 4 && block.vertex[k] >= 0; ++k) product.add(block.vertex[k], block.weight[k] * f);
        }
    }

    /// Where a row is about to end or to begin the second derivative jumps.
    void set_exact(double reach) {
        for (std::size_t row = 0; row < rows.size(); ++row) {
            if (std::abs(rows.distance[row] - rows.thickness[row]) > contact_kink_reaches * reach) continue;
            for (std::size_t k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) exact[rows.vertex[row][k]] = false;
        }
    }
};

CheckedTerm contact_term(const StepEnd& step, double reach) {
    auto check = std::make_shared<ContactCheck>(step);
    Vectors forces;
    forces.resize(step.scene.model.vertex_count());
    check->evaluate(step.end.cloth.positions, forces, check->terms);
    check->set_exact(reach);
    return {.name = "contact",
            .add_forces =
                [=](const Vectors& positions, Vectors& sum) {
                    ContactTerms terms;
                    check->evaluate(positions, sum, terms);
                },
            .energy =
                [=](const Vectors& positions) {
                    ContactTerms terms;
                    Vectors unused = positions;
                    return check->evaluate(positions, unused, terms);
                },
            .multiply = [=](const Vectors& direction, Vectors& product) { check->multiply(direction, product); },
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
    return derivative_reach_share * shortest;
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
    terms.push_back(gravity_term(step));
    terms.push_back(spring_term(step, "springs", DampingForm::velocity));
    if (step.scene.plan.implicit && step.scene.plan.damping == DampingForm::length_rate) {
        terms.push_back(spring_term(step, "damped springs", DampingForm::length_rate));
    }
    if (!step.scene.model.membrane.empty()) terms.push_back(membrane_term(step));
    if (!step.scene.model.hinges.curved.empty()) terms.push_back(curved_hinge_term(step));
    if (step.scene.plan.wind) terms.push_back(wind_term(step, reach_of(step)));
    const bool penalty = step.scene.settings.contact_response == ContactResponse::penalty;
    if (step.scene.plan.contacts && penalty && step.work.newton.current.rows.size() > 0) {
        terms.push_back(contact_term(step, reach_of(step)));
    }
    return terms;
}

void check_derivatives(const StepEnd& step, StepReport& report) {
    const CheckedState state{
        .positions = step.end.cloth.positions, .count = step.scene.model.vertex_count(), .reach = reach_of(step), .dt = step.dt};
    const std::optional<WrongDerivative> wrong = find_wrong_derivative(checked_terms(step), state);
    if (!wrong) return;
    report.status = StepStatus::wrong_derivative;
    report.wrong_derivative = text_of(step, *wrong);
}

}  // namespace percale
