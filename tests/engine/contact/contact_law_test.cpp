#include "engine/contact/contact_law.h"

#include <cmath>

#include "engine/contact/penalty.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::contact_law_test {
namespace {

constexpr double h = 0.005, dt = 1.0 / 120.0, rate = 60.0;

/// Vertices that end a move in contact with a moving obstacle or with each other.
struct Touching {
    static constexpr int count = 8;
    std::vector<double> mass = std::vector<double>(count, 0.01);
    DiagonalBlocks diagonal;
    ContactRows rows;
    Vectors start, end, forces;
    std::vector<ObstacleFlow> flows;
    std::vector<Grip> grips;
    ContactMultipliers held;
    ContactTerms terms;
    std::vector<RowForce> row_forces;

    explicit Touching(unsigned seed) {
        Random random(seed);
        diagonal.resize(count);
        for (const int entry : {0, 3, 5}) std::fill_n(diagonal.data.begin() + entry * diagonal.padded, count, 0.02);
        start = to_vectors(random_points(random, count, 2e-4));
        end = to_vectors(random_points(random, count, 2e-4));
        forces.resize(count);
        flows = {{.shift = random.point(2e-4)}};
        for (int i = 0; i < count; i += 2) grips.push_back({i, 0, random.point(3e-5)});
        for (int i = 0; i < count; ++i) add_row(random, {i, (i + 3) % count, -1, -1}, {0.3, 0.7, 0.0, 0.0}, 0);
        held.clear(4);
        for (int i = 0; i < 4; ++i) {
            add_row(random, {i, i + 4, -1, -1}, {1.0, -1.0, 0.0, 0.0}, -1);
            if (i % 2 == 0) held.add(row_key(rows, rows.size() - 1), {.normal = 2.0, .friction = random.point(0.7)});
        }
    }

    void add_row(Random& random, const std::array<int, 4>& vertex, const std::array<double, 4>& weight, int obstacle) {
        rows.vertex.push_back(vertex);
        rows.weight.push_back(weight);
        rows.direction.push_back(random.unit());
        rows.obstacle_point.push_back(Vec3::Zero());
        rows.obstacle_displacement.push_back(obstacle < 0 ? Vec3(Vec3::Zero()) : flows[0].shift);
        rows.distance.push_back(random.number(0.2, 0.95) * h);
        rows.thickness.push_back(h);
        rows.friction.push_back(0.4);
        rows.share.push_back(1.0);
        rows.obstacle.push_back(obstacle);
        rows.feature.push_back(0);
    }

    ContactMove move() const {
        return {
            .rows = rows, .terms = terms, .row_forces = row_forces, .start = start, .end = end, .dt = dt, .obstacle_rate = rate};
    }

    ContactLoss loss() {
        const FrictionStart friction{.positions = &start, .fraction = 0.5, .grips = grips, .flows = flows, .held = &held};
        add_contact(rows,
                    {.dt = dt,
                     .obstacle_rate = rate,
                     .fraction = 0.5 + dt * rate,
                     .gravity = Vec3(0, -9.81, 0),
                     .mass = &mass,
                     .diagonal = &diagonal,
                     .friction = &friction},
                    end, forces, terms, row_forces);
        return PenaltyContact().loss(move(), 0.0);
    }
};

}  // namespace

TEST_CASE("What contact takes from a move is its energy, its losses and the work of obstacles") {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        Touching touching(seed);
        const ContactLoss loss = touching.loss();
        double given = 0.0;
        for (int i = 0; i < Touching::count; ++i) {
            given += touching.forces.at(i).dot(touching.end.at(i) - touching.start.at(i));
        }
        const double springs = grip_energy(touching.terms.touches) + grip_energy(touching.terms.rubs);
        const double energy = touching.terms.energy + springs;
        const double work = dt * touching.terms.obstacle_power;
        CAPTURE(seed, given, energy, work);
        CHECK(work - given == Approx(energy + loss.contact + loss.friction + loss.integrator).epsilon(1e-10));
        CHECK(loss.friction > 0.0);
        CHECK(loss.integrator > 0.0);
        CHECK(loss.contact <= 0.0);  // what the rows of the end would have stored at the start
    }
}

TEST_CASE("A touch that slides steadily loses the friction force times its path") {
    const double press = 2.0, reach = 5e-5, path = 3e-4;
    Touching touching(1);
    touching.rows.clear();
    touching.start.set(0, Vec3::Zero());
    touching.end.set(0, Vec3(path, 0, 0));
    Touch touch;
    touch.vertex = touch.obstacle = 0;
    touch.press = Vec3(0, press, 0);
    touch.reach = reach;
    touch.slip = Vec3(reach + path, 0, 0);
    touching.terms.touches.all = {touch};
    const ContactLoss loss = PenaltyContact().loss(touching.move(), 0.0);
    CHECK(loss.friction == Approx(press * path).epsilon(1e-12));
    CHECK(std::abs(loss.integrator) < 1e-15);
    CHECK(-loss.contact == Approx(0.5 * press * reach).epsilon(1e-12));
    CHECK(grip_energy(touching.terms.touches) == Approx(0.5 * press * reach).epsilon(1e-12));
}

TEST_CASE("A row is followed back by how much farther the cloth moved than the obstacle") {
    Touching touching(2);
    const Vec3 here = relative_move(touching.move(), 0);
    const auto [i, j, unused_a, unused_b] = touching.rows.vertex[0];
    const Vec3 cloth = 0.3 * (touching.end.at(i) - touching.start.at(i)) + 0.7 * (touching.end.at(j) - touching.start.at(j));
    CHECK((here - (cloth - dt * rate * touching.flows[0].shift)).norm() < 1e-18);
}

}  // namespace percale::test::contact_law_test
