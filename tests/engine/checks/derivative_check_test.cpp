#include "engine/checks/derivative_check.h"

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::derivative_check_test {
namespace {

constexpr double dt = 0.01;

/// A chain of quadratic springs f = -k (x_i - x_i+1), linear, so that all of it is known exactly.
struct Chain {
    int count = 40;
    double stiffness = 30.0;
    double wrong_force = 0.0;   // N, added to vertex 7
    double wrong_matrix = 0.0;  // relative, of the pair 11, 12

    CheckedTerm term() const {
        const Chain chain = *this;
        return {.name = "chain",
                .add_forces = [chain](const Vec3Arrays& x, Vec3Arrays& forces) { chain.add_forces(x, forces); },
                .energy = [chain](const Vec3Arrays& x) { return chain.energy(x); },
                .multiply = [chain](const Vec3Arrays& d, Vec3Arrays& product) { chain.multiply(d, product); },
                .exact = {}};
    }

    void add_forces(const Vec3Arrays& x, Vec3Arrays& forces) const {
        for (int i = 0; i + 1 < count; ++i) {
            const Vec3 force = -stiffness * (x.at(i) - x.at(i + 1));
            forces.add(i, force);
            forces.add(i + 1, -force);
        }
        forces.add(7, Vec3(wrong_force, 0.0, 0.0));
    }

    double energy(const Vec3Arrays& x) const {
        double sum = 0.0;
        for (int i = 0; i + 1 < count; ++i) sum += 0.5 * stiffness * (x.at(i) - x.at(i + 1)).squaredNorm();
        return sum;
    }

    void multiply(const Vec3Arrays& d, Vec3Arrays& product) const {
        for (int i = 0; i + 1 < count; ++i) {
            const double factor = i == 11 ? 1.0 + wrong_matrix : 1.0;
            const Vec3 part = factor * dt * dt * stiffness * (d.at(i) - d.at(i + 1));
            product.add(i, part);
            product.add(i + 1, -part);
        }
    }
};

std::optional<WrongDerivative> checked(const std::vector<CheckedTerm>& terms) {
    Random random(4);
    const Vec3Arrays positions = to_vec3_arrays(random_points(random, 40, 0.5));
    return find_wrong_derivative(terms, {.positions = positions, .count = 40, .difference_step = 1e-6, .dt = dt});
}

}  // namespace

TEST_CASE("A force that fits its energy and its matrix passes") { CHECK_FALSE(checked({Chain{}.term()}).has_value()); }

TEST_CASE("Internal forces that do not cancel are named by their term, with the sum") {
    const auto wrong = checked({Chain{}.term(), Chain{.wrong_force = 0.01}.term()});
    REQUIRE(wrong.has_value());
    CHECK(wrong->term == "chain");
    CHECK(wrong->vertex == -1);
    CHECK(mentions(wrong->what, {"add up", "0.01"}));
}

TEST_CASE("A force that is not the slope of its energy is named by its vertex") {
    CheckedTerm term = Chain{.wrong_force = 0.3}.term();
    term.internal = false;
    const auto wrong = checked({term});
    REQUIRE(wrong.has_value());
    CHECK(wrong->vertex == 7);
    CHECK(mentions(wrong->what, {"energy", " N"}));
}

TEST_CASE("A matrix that is not the derivative is named by the two vertices, unless it is an upper bound that says so") {
    for (const double error : {0.01, -0.01}) {
        CheckedTerm term = Chain{.wrong_matrix = error}.term();
        const auto wrong = checked({term});
        REQUIRE(wrong.has_value());
        CHECK(wrong->vertex == 11);
        CHECK((wrong->by_vertex == 11 || wrong->by_vertex == 12));
        CHECK(mentions(wrong->what, {"differences", "matrix", "kg"}));
        term.exact = [](int vertex) { return vertex != 11 && vertex != 12; };
        CHECK(checked({term}).has_value() == (error < 0.0));
    }
}

TEST_CASE("At a kink, where a term declares it, differences of the energy are not compared with the force, elsewhere they are") {
    Random random(4);
    const Vec3Arrays places = to_vec3_arrays(random_points(random, 40, 0.5));
    // E = k/2 max(0, x - c)^2 of each vertex; vertex 3 lies less than a reach beyond its c, vertex 5 has a wrong force.
    const auto depth = [=](const Vec3Arrays& x, int i) { return std::max(0.0, x.x[i] - places.x[i] + (i == 3 ? 2e-7 : 1e-4)); };
    const auto term_with = [=](double wrong, int kink) {
        return CheckedTerm{.name = "kinked",
                           .add_forces =
                               [=](const Vec3Arrays& x, Vec3Arrays& forces) {
                                   for (int i = 0; i < 40; ++i) forces.add(i, Vec3(-30.0 * depth(x, i), 0.0, 0.0));
                                   forces.add(5, Vec3(wrong, 0.0, 0.0));
                               },
                           .energy =
                               [=](const Vec3Arrays& x) {
                                   double sum = 0.0;
                                   for (int i = 0; i < 40; ++i) sum += 15.0 * depth(x, i) * depth(x, i);
                                   return sum;
                               },
                           .multiply = {},
                           .exact = [=](int i) { return i != kink; },
                           .kinks = true,
                           .internal = false};
    };
    const auto found = [&](double wrong, int kink) {
        return find_wrong_derivative({term_with(wrong, kink)},
                                     {.positions = places, .count = 40, .difference_step = 1e-6, .dt = dt});
    };
    CHECK_FALSE(found(0.0, 3).has_value());
    CHECK(found(0.0, -1).has_value());
    REQUIRE(found(0.1, 3).has_value());
    CHECK(found(0.1, 3)->vertex == 5);
}

TEST_CASE("Energies and matrices that a term does not have are not checked") {
    CheckedTerm term = Chain{.wrong_force = 0.3, .wrong_matrix = 1.0}.term();
    term.internal = false;
    term.energy = {};
    term.multiply = {};
    CHECK_FALSE(checked({term}).has_value());
}

}  // namespace percale::test::derivative_check_test
