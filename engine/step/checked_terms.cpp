#include "checked_terms.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "forces/gravity.h"
#include "forces/hinge_bending.h"
#include "forces/membrane_springs.h"
#include "forces/wind.h"

namespace percale {
namespace {

constexpr double share_of_length = 1e-5;  // of the shortest spring, by which vertices are moved

Vec3 block_times(const SymmetricBlock& k, const Vec3& u) {
    const auto& [xx, xy, xz, yy, yz, zz] = k;
    return {xx * u.x() + xy * u.y() + xz * u.z(), xy * u.x() + yy * u.y() + yz * u.z(), xz * u.x() + yz * u.y() + zz * u.z()};
}

/// What the terms of springs and triangles share: the model's adjacency at the end of a step from world.before.
struct SpringCheck {
    const World& world;
    StepSprings springs;
    SpringTerms terms;  // at the state
    std::vector<bool> exact;
    Vectors still;  // velocities

    explicit SpringCheck(const World& of) : world(of), exact(of.model.vertex_count(), true) {
        still.resize(of.model.vertex_count());
    }

    const Adjacency& adjacency() const { return world.model.adjacency; }
    double dt() const { return world.report.smallest_dt; }
    SpringMotion motion(const Vectors& positions) const { return {positions, still, dt()}; }

    /// product = terms times a direction.
    void multiply(const Vectors& direction, Vectors& product) const {
        const std::vector<double> massless(world.model.vertex_count(), 0.0);
        BlockMatrix matrix;
        set_pattern(world.compute, adjacency(), massless, matrix);
        matrix.springs = &terms;
        AlignedVector<double> points;
        percale::multiply(matrix, direction, points, product);
    }

    void set_inexact(int spring) { exact[world.model.springs.first[spring]] = exact[world.model.springs.second[spring]] = false; }
};

double evaluate(const SpringCheck& check, const Vectors& positions, bool with_matrix, Vectors& forces, SpringTerms& terms) {
    return evaluate_springs(check.world.compute, check.springs, check.motion(positions), with_matrix, forces, terms);
}

/// Triangles alone: the springs of their edges are nothing.
double evaluate_triangles(const SpringCheck& check, const Vectors& positions, bool with_matrix, Vectors& forces,
                          SpringTerms& terms) {
    pack_points(check.world.compute, check.adjacency(), positions, terms.points);
    if (with_matrix) terms.values.assign(check.adjacency().value_count(), 0.0f);
    return evaluate_membrane(check.world.compute, check.adjacency(), check.motion(positions), with_matrix, forces, terms);
}

template <class Evaluate>
CheckedTerm term_of(const std::string& name, const std::shared_ptr<SpringCheck>& check, Evaluate evaluate_at) {
    Vectors forces = check->still;
    evaluate_at(*check, check->world.state.positions, true, forces, check->terms);
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
    if (!check->world.plan.implicit) term.multiply = {};
    return term;
}

/// Springs in one damping form, without damping by velocity, which has no potential. Compressed ones are clamped in the matrix.
CheckedTerm spring_term(const World& world, const std::string& name, DampingForm form) {
    auto check = std::make_shared<SpringCheck>(world);
    const Vectors& start = world.plan.implicit ? world.newton.start_positions : world.before.positions;
    set_step_springs(world.compute, {check->adjacency(), start, form, check->dt()}, check->springs);
    check->springs.rate_damping = false;
    CheckedTerm term = term_of(name, check, evaluate);
    const SpringNetwork& network = world.model.springs;
    for (int k = 0; k < network.size(); ++k) {
        const int place = check->adjacency().place[k];
        const double length = (world.state.positions.at(network.first[k]) - world.state.positions.at(network.second[k])).norm();
        const bool pulls = length > check->springs.entries.rest_length[place];
        if (!pulls && check->springs.entries.stiffness[place] > 0.0) check->set_inexact(k);
    }
    return term;
}

/// Edges that push are clamped in the matrix.
CheckedTerm membrane_term(const World& world) {
    auto check = std::make_shared<SpringCheck>(world);
    CheckedTerm term = term_of("membrane", check, evaluate_triangles);
    for (int k = 0; k < world.model.springs.size(); ++k) {
        const SpringBlock block = spring_block(check->adjacency(), check->terms, k);
        if (block.a == 0.0 && block.w != Vec3::Zero()) check->set_inexact(k);
    }
    return term;
}

/// What rest angles change; the matrix keeps that of flat hinges, which claims nothing here.
CheckedTerm curved_hinge_term(const World& world) {
    return {.name = "curved hinges",
            .add_forces = [&world](const Vectors& positions,
                                   Vectors& forces) { add_curved_hinges(world.model.hinges, positions, forces); },
            .energy =
                [&world](const Vectors& positions) {
                    Vectors unused = positions;
                    return add_curved_hinges(world.model.hinges, positions, unused);
                },
            .multiply = {},
            .exact = {}};
}

/// Drag as a function of the positions at the end of the step, with the velocities that lead there.
struct WindCheck {
    const World& world;
    WindTerms terms;
    std::vector<bool> exact;

    /// The drag has a kink where the air does not move along a triangle, or not across it.
    void set_exact(double slow) {
        for (std::size_t k = 0; k < world.model.triangles.size(); ++k) {
            const Vec3& n = world.wind.triangles[k].normal;
            for (const int vertex : world.model.triangles[k]) {
                const Vec3 u = world.state.velocities.at(vertex) - world.wind.velocity;
                const double across = n.dot(u);
                if (std::abs(across) < slow || (u - across * n).norm() < slow) exact[vertex] = false;
            }
        }
    }

    double evaluate(const Vectors& positions, Vectors& forces, WindTerms& result) const {
        const double dt = world.report.smallest_dt;
        Vectors velocities = world.state.velocities;
        add_scaled(velocities, 1.0 / dt, positions);
        add_scaled(velocities, -1.0 / dt, world.state.positions);
        add_wind(world.model, world.wind, velocities, dt, forces, result);
        return result.potential;
    }
};

CheckedTerm wind_term(const World& world, double reach) {
    auto check = std::make_shared<WindCheck>(WindCheck{world, {}, std::vector<bool>(world.model.vertex_count(), true)});
    check->set_exact(1e3 * reach / world.report.smallest_dt);
    Vectors forces = world.state.positions;
    check->evaluate(world.state.positions, forces, check->terms);
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
                        product.add(vertex, block_times(check->terms.blocks[i], direction.at(vertex)));
                    }
                },
            .exact = [=](int vertex) { return static_cast<bool>(check->exact[vertex]); },
            .kinks = true,
            .internal = false};
}

CheckedTerm gravity_term(const World& world) {
    CheckedTerm term{.name = "gravity", .add_forces = {}, .energy = {}, .multiply = {}, .exact = {}, .internal = false};
    term.add_forces = [&world](const Vectors&, Vectors& forces) {
        Vectors own = forces;
        set_gravity_forces(world.model.mass, world.settings.gravity, own);
        add_scaled(forces, 1.0, own);
    };
    term.energy = [&world](const Vectors& positions) {
        return gravity_energy(world.model.mass, world.settings.gravity, positions);
    };
    return term;
}

/// The rows of the last evaluation as planes, without friction, which has no potential.
struct ContactCheck {
    const World& world;
    ContactRows rows;
    ContactTerms terms;
    std::vector<bool> exact;

    explicit ContactCheck(const World& of)
        : world(of), rows(of.newton.current.forces.rows), exact(of.model.vertex_count(), true) {}

    double evaluate(const Vectors& positions, Vectors& forces, ContactTerms& result) const {
        ContactRows moved = rows;
        for (std::size_t row = 0; row < rows.size(); ++row) {
            double change = 0.0;
            for (std::size_t k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
                const int i = rows.vertex[row][k];
                change += rows.weight[row][k] * rows.direction[row].dot(positions.at(i) - world.state.positions.at(i));
            }
            moved.distance[row] += change;
        }
        const ContactStep step{.dt = world.report.smallest_dt,
                               .stiffness_dt = world.contact_dt,
                               .fraction = 1.0,
                               .gravity = world.settings.gravity,
                               .mass = &world.model.mass,
                               .diagonal = &world.newton.frozen_diagonal,
                               .load = &world.newton.frozen_load};
        add_contact(moved, step, positions, forces, result);
        return result.energy;
    }

    void multiply(const Vectors& direction, Vectors& product) const {
        for (const ContactBlock& block : terms.blocks) {
            Vec3 u = Vec3::Zero();
            for (std::size_t k = 0; k < 4 && block.vertex[k] >= 0; ++k) u += block.weight[k] * direction.at(block.vertex[k]);
            const Vec3 f = block_times(block.k, u);
            for (std::size_t k = 0; k < 4 && block.vertex[k] >= 0; ++k) product.add(block.vertex[k], block.weight[k] * f);
        }
    }

    /// Where a row is about to end or to begin the second derivative jumps.
    void set_exact(double reach) {
        for (std::size_t row = 0; row < rows.size(); ++row) {
            if (std::abs(rows.distance[row] - rows.thickness[row]) > 10.0 * reach) continue;
            for (std::size_t k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) exact[rows.vertex[row][k]] = false;
        }
    }
};

CheckedTerm contact_term(const World& world, double reach) {
    auto check = std::make_shared<ContactCheck>(world);
    Vectors forces;
    forces.resize(world.model.vertex_count());
    check->evaluate(world.state.positions, forces, check->terms);
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

double reach_of(const World& world) {
    const SpringNetwork& springs = world.model.springs;
    double shortest = 1.0;  // m
    for (int k = 0; k < springs.size(); ++k) {
        if (springs.rest_length[k] > 0.0) shortest = std::min(shortest, springs.rest_length[k]);
    }
    return share_of_length * shortest;
}

/// "vertex 3 of cloth sheet"
std::string vertex_text(const World& world, int index) {
    for (const ClothRange& cloth : world.model.cloths) {
        if (index < cloth.first || index >= cloth.first + cloth.count) continue;
        return "vertex " + std::to_string(cloth.user_vertex(index)) + " of cloth " + cloth.name;
    }
    return "vertex " + std::to_string(index);
}

std::string text_of(const World& world, const WrongDerivative& wrong) {
    std::string text = "check_derivatives: " + wrong.term + ": ";
    if (wrong.vertex >= 0)
        text += "force on " + vertex_text(world, wrong.vertex) + " as " + vertex_text(world, wrong.by_vertex) + " moves: ";
    return text + wrong.what;
}

}  // namespace

std::vector<CheckedTerm> checked_terms(const World& world) {
    std::vector<CheckedTerm> terms;
    terms.push_back(gravity_term(world));
    terms.push_back(spring_term(world, "springs", DampingForm::velocity));
    if (world.plan.implicit && world.plan.damping == DampingForm::length_rate) {
        terms.push_back(spring_term(world, "damped springs", DampingForm::length_rate));
    }
    if (!world.model.membrane.empty()) terms.push_back(membrane_term(world));
    if (!world.model.hinges.curved.empty()) terms.push_back(curved_hinge_term(world));
    if (world.plan.wind) terms.push_back(wind_term(world, reach_of(world)));
    const bool penalty = world.settings.contact_response == ContactResponse::penalty;
    if (world.plan.contacts && penalty && world.newton.current.forces.rows.size() > 0) {
        terms.push_back(contact_term(world, reach_of(world)));
    }
    return terms;
}

void check_derivatives(World& world) {
    const CheckedState state{.positions = world.state.positions,
                             .count = world.model.vertex_count(),
                             .reach = reach_of(world),
                             .dt = world.report.smallest_dt};
    const std::optional<WrongDerivative> wrong = find_wrong_derivative(checked_terms(world), state);
    if (!wrong) return;
    world.report.status = StepStatus::wrong_derivative;
    world.report.wrong_derivative = text_of(world, *wrong);
}

}  // namespace percale
