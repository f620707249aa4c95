#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <vector>

#include "engine/schemes/schemes.h"
#include "engine/step/step.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

// Two rows of three particles with structural, shear and bend springs. Everything is written here a second time, with one vector
// q of 18 positions and one vector v of 18 velocities:
//   M dv/dt = f(q, v),   f_i = -sum over springs (k (l - l0) + c (v_i - v_j) . d) d,   d = (x_i - x_j)/l,   plus m_i g.
//
//   3 - 4 - 5      structural: along rows and columns, shear: both diagonals of both cells, bend: from end to end of a row
//   | X | X |
//   0 - 1 - 2

namespace percale::test::six_particles_test {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr double apart = 0.1, k_structural = 50.0, k_shear = 20.0, k_bend = 5.0;
const Vec3 gravity(0.3, -9.81, 0.2);

struct Spring {
    int i, j;
    double stiffness, rest;
};

const std::vector<Spring>& springs() {
    static const double diagonal = apart * std::sqrt(2.0);
    static const std::vector<Spring> list = {
        {0, 1, k_structural, apart}, {1, 2, k_structural, apart}, {3, 4, k_structural, apart}, {4, 5, k_structural, apart},
        {0, 3, k_structural, apart}, {1, 4, k_structural, apart}, {2, 5, k_structural, apart}, {0, 4, k_shear, diagonal},
        {1, 3, k_shear, diagonal},   {1, 5, k_shear, diagonal},   {2, 4, k_shear, diagonal},   {0, 2, k_bend, 2.0 * apart},
        {3, 5, k_bend, 2.0 * apart}};
    return list;
}

/// The system of a step written by hand.
struct Lecture {
    Vector mass;  // 18, that of a particle three times
    double damping;

    Vector forces(const Vector& q, const Vector& v) const {
        Vector f = Vector::Zero(18);
        for (int i = 0; i < 6; ++i) f.segment<3>(3 * i) = mass[3 * i] * gravity;
        for (const auto& [i, j, k, rest] : springs()) {
            const Vec3 x = q.segment<3>(3 * i) - q.segment<3>(3 * j), u = v.segment<3>(3 * i) - v.segment<3>(3 * j);
            const Vec3 d = x.normalized(), pull = (k * (x.norm() - rest) + damping * u.dot(d)) * d;
            f.segment<3>(3 * i) -= pull;
            f.segment<3>(3 * j) += pull;
        }
        return f;
    }
    Vector acceleration(const Vector& q, const Vector& v) const { return forces(q, v).cwiseQuotient(mass); }

    /// df/dq without damping: blocks -k ((1 - l0/l) (I - d d^T) + d d^T).
    Matrix jacobian(const Vector& q) const {
        Matrix sum = Matrix::Zero(18, 18);
        for (const auto& [i, j, k, rest] : springs()) {
            const Vec3 x = q.segment<3>(3 * i) - q.segment<3>(3 * j), d = x.normalized();
            const Eigen::Matrix3d along = d * d.transpose();
            const Eigen::Matrix3d block = k * ((1.0 - rest / x.norm()) * (Eigen::Matrix3d::Identity() - along) + along);
            for (const auto& [row, column, sign] : {std::tuple(i, i, -1.0), {j, j, -1.0}, {i, j, 1.0}, {j, i, 1.0}}) {
                sum.block<3, 3>(3 * row, 3 * column) += sign * block;
            }
        }
        return sum;
    }
};

struct State {
    Vector q, v;
};

/// q = a.q + h v, v = a.v + h M^-1 f(q), by Newton's method without a line search; no damping.
State solve_implicitly(const Lecture& lecture, const State& a, double h) {
    Vector v = a.v;
    for (int n = 0; n < 50; ++n) {
        const Vector q = a.q + h * v;
        const Vector residual = lecture.mass.cwiseProduct(v - a.v) - h * lecture.forces(q, Vector::Zero(18));
        const Matrix matrix = Matrix(lecture.mass.asDiagonal()) - h * h * lecture.jacobian(q);
        v -= matrix.partialPivLu().solve(residual);
    }
    return {a.q + h * v, v};
}

State trapezoid_by_hand(const Lecture& lecture, const State& s, double h) {
    const State a{s.q + 0.5 * h * s.v, s.v + 0.5 * h * lecture.acceleration(s.q, s.v)};
    return solve_implicitly(lecture, a, 0.5 * h);
}

/// Bank et al. (1985): the trapezoid over gamma h, then BDF2 over the rest.
State tr_bdf2_by_hand(const Lecture& lecture, const State& s, double h) {
    const double gamma = 2.0 - std::sqrt(2.0), of_middle = 1.0 / (gamma * (2.0 - gamma));
    const double of_start = (1.0 - gamma) * (1.0 - gamma) * of_middle;
    const State middle = trapezoid_by_hand(lecture, s, gamma * h);
    const State a{of_middle * middle.q - of_start * s.q, of_middle * middle.v - of_start * s.v};
    return solve_implicitly(lecture, a, (1.0 - gamma) / (2.0 - gamma) * h);
}

State rk4_by_hand(const Lecture& lecture, const State& s, double h) {
    const auto rate = [&](const State& at) { return State{at.v, lecture.acceleration(at.q, at.v)}; };
    const auto ahead = [&](double length, const State& k) { return State{s.q + length * k.q, s.v + length * k.v}; };
    const State k1 = rate(s), k2 = rate(ahead(0.5 * h, k1)), k3 = rate(ahead(0.5 * h, k2)), k4 = rate(ahead(h, k3));
    return {s.q + h / 6.0 * (k1.q + 2.0 * k2.q + 2.0 * k3.q + k4.q), s.v + h / 6.0 * (k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v)};
}

State step_by_hand(Scheme scheme, const Lecture& lecture, const State& s, double h) {
    const Vector a = lecture.acceleration(s.q, s.v);
    switch (scheme) {
        case Scheme::forward_euler:
            return {s.q + h * s.v, s.v + h * a};
        case Scheme::symplectic_euler:
            return {s.q + h * (s.v + h * a), s.v + h * a};
        case Scheme::midpoint: {
            const Vector q = s.q + 0.5 * h * s.v, v = s.v + 0.5 * h * a;
            return {s.q + h * v, s.v + h * lecture.acceleration(q, v)};
        }
        case Scheme::rk4:
            return rk4_by_hand(lecture, s, h);
        case Scheme::backward_euler:
            return solve_implicitly(lecture, s, h);
        case Scheme::implicit_midpoint: {
            const State middle = solve_implicitly(lecture, s, 0.5 * h);
            return {2.0 * middle.q - s.q, 2.0 * middle.v - s.v};
        }
        case Scheme::trapezoid:
            return trapezoid_by_hand(lecture, s, h);
        default:  // BDF2 begins with a step of TR-BDF2
            return tr_bdf2_by_hand(lecture, s, h);
    }
}

/// Bent, sheared and stretched by up to a third, and moving.
State start_state() {
    State s{Vector(18), Vector(18)};
    for (int i = 0; i < 6; ++i) {
        const double column = i % 3, row = i / 3;
        s.q.segment<3>(3 * i) =
            apart * Vec3(1.1 * column + 0.2 * row, 0.15 * column * column - 0.1 * row, 0.9 * row + 0.1 * column);
        s.v.segment<3>(3 * i) = Vec3(0.3 * std::sin(1.0 + 2.0 * i), 0.4 * std::cos(3.0 * i), 0.2 * std::sin(5.0 * i));
    }
    return s;
}

/// The engine's six particles, the particle i of the drawing being its `place[i]`; in another order the springs are, too.
World particles(Scheme scheme, double h, double damping, const std::vector<int>& place = {0, 1, 2, 3, 4, 5}) {
    const TriangleMesh grid = make_grid(2.0 * apart, apart, 3, 2);
    const Fabric fabric{.area_density = 0.2,
                        .springs = {.structural = k_structural, .shear = k_shear, .bend = k_bend},
                        .spring_damping = damping};
    const ClothModel sheet = cloth_model(grid, fabric);
    std::vector<double> mass(6);
    std::vector<Link> links;
    for (int i = 0; i < 6; ++i) mass[place[i]] = sheet.mass[i];
    for (int k = 0; k < sheet.springs.size(); ++k) {
        links.push_back({place[sheet.springs.first[k]], place[sheet.springs.second[k]], sheet.springs.rest_length[k],
                         sheet.springs.stiffness[k], sheet.springs.damping[k]});
    }
    if (place[0] != 0) std::ranges::reverse(links);
    const State start = start_state();
    std::vector<Vec3> positions(6);
    for (int i = 0; i < 6; ++i) positions[place[i]] = start.q.segment<3>(3 * i);
    World world = make_world(linked_masses(mass, links), positions,
                             {.time_step = h, .scheme = scheme, .newton_tolerance = 1e-13, .gravity = gravity});
    for (int i = 0; i < 6; ++i) world.state.cloth.velocities.set(place[i], start.v.segment<3>(3 * i));
    return world;
}

Lecture lecture_of(const World& world, double damping) {
    Lecture lecture{Vector(18), damping};
    for (int i = 0; i < 18; ++i) lecture.mass[i] = world.scene.model.mass[i / 3];
    return lecture;
}

double difference(const State& expected, const World& world, const std::vector<int>& place = {0, 1, 2, 3, 4, 5}) {
    double worst = 0.0;
    for (int i = 0; i < 6; ++i) {
        if (!world.state.cloth.positions.at(place[i]).allFinite() || !expected.q.allFinite()) return 1e300;
        worst = std::max(worst, (world.state.cloth.positions.at(place[i]) - expected.q.segment<3>(3 * i)).norm());
        worst = std::max(worst, 0.1 * (world.state.cloth.velocities.at(place[i]) - expected.v.segment<3>(3 * i)).norm());
    }
    return worst;
}

}  // namespace

TEST_CASE("Six particles in two rows have seven structural springs, four for shear and two for bending") {
    const TriangleMesh grid = make_grid(2.0 * apart, apart, 3, 2);
    const ClothModel sheet = cloth_model(
        grid,
        {.area_density = 0.2, .springs = {.structural = k_structural, .shear = k_shear, .bend = k_bend}, .spring_damping = 0.0});
    std::set<std::tuple<int, int, double>> found, expected;
    for (int k = 0; k < sheet.springs.size(); ++k) {
        const auto [i, j] = std::minmax(sheet.springs.first[k], sheet.springs.second[k]);
        found.insert({i, j, sheet.springs.stiffness[k]});
    }
    for (const Spring& spring : springs()) {
        const auto [i, j] = std::minmax(spring.i, spring.j);
        expected.insert({i, j, spring.stiffness});
        CHECK((grid.vertices[i] - grid.vertices[j]).norm() == Approx(spring.rest).epsilon(1e-12));
    }
    CHECK(found == expected);
    CHECK(std::accumulate(sheet.mass.begin(), sheet.mass.end(), 0.0) == Approx(0.2 * 2.0 * apart * apart));
}

TEST_CASE("Six particles: a step of every scheme equals the one made by hand", "[law]") {
    const double h = 0.002;
    for (const SchemeFacts& facts : scheme_table()) {
        const double damping = facts.implicit ? 0.0 : 0.05;
        World world = particles(facts.scheme, h, damping);
        State by_hand = step_by_hand(facts.scheme, lecture_of(world, damping), start_state(), h);
        REQUIRE(step(world).ok());
        if (facts.scheme == Scheme::bdf2) {  // its second step is the first of its own
            const State start = start_state(), a{(4.0 * by_hand.q - start.q) / 3.0, (4.0 * by_hand.v - start.v) / 3.0};
            by_hand = solve_implicitly(lecture_of(world, damping), a, 2.0 / 3.0 * h);
            REQUIRE(step(world).ok());
        }
        check_law("six particles, " + std::string(facts.word) + ": distance from the step by hand, m", difference(by_hand, world),
                  1e-12);
    }
}

TEST_CASE("Six particles: neither the order of the particles nor that of the springs matters", "[law]") {
    const std::vector<int> place = {4, 0, 5, 2, 1, 3};
    for (const SchemeFacts& facts : scheme_table()) {
        World one = particles(facts.scheme, 5e-4, 0.05), other = particles(facts.scheme, 5e-4, 0.05, place);
        for (int n = 0; n < 40; ++n) REQUIRE((step(one).ok() && step(other).ok()));
        State end{Vector(18), Vector(18)};
        for (int i = 0; i < 6; ++i) {
            end.q.segment<3>(3 * i) = one.state.cloth.positions.at(i);
            end.v.segment<3>(3 * i) = one.state.cloth.velocities.at(i);
        }
        check_law("six particles, " + std::string(facts.word) + ": another order after 40 steps, m",
                  difference(end, other, place), 1e-10);
    }
}

}  // namespace percale::test::six_particles_test
