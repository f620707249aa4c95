#include "engine/contact/projection.h"

#include <cmath>
#include <numbers>

#include "engine/solve/newton.h"
#include "engine/tolerances.h"
#include "tests/support/laws.h"
#include "tests/support/plane_scenes.h"

namespace percale::test::projection_test {
namespace {

constexpr double h = 0.005;  // the sheet's thickness

StepSettings projected(double time_step = 1.0 / 60.0) {
    return {.time_step = time_step, .contact_response = ContactResponse::projection};
}

double energy(const SolverScene& scene) {
    double sum = elastic_energy(scene.model.springs, scene.state.positions);
    for (int i = 0; i < scene.model.vertex_count(); ++i) {
        sum += scene.model.mass[i] * (0.5 * scene.state.velocities.at(i).squaredNorm() + 9.81 * scene.state.positions.y[i]);
    }
    return sum;
}

/// One vertex in contact with the plane y = 0, whose step matrix is `inertia` kg.
struct OneRow {
    static constexpr double dt = 0.01, inertia = 2.0, mu = 0.4;
    ContactRows rows;
    DiagonalBlocks diagonal;
    Vectors velocities, total;
    ContactTerms terms;
    std::vector<RowForce> forces;
    double potential = 0.0;
    ProjectedContact projection;
    ContactMemory memory;

    explicit OneRow(double distance, const Vec3& velocity = Vec3::Zero()) {
        diagonal.resize(16);
        for (const int entry : {0, 3, 5}) diagonal.data[16 * entry] = inertia;
        velocities.resize(1);
        velocities.set(0, velocity);
        rows.vertex = {{0, -1, -1, -1}};
        rows.weight = {{1.0, 0.0, 0.0, 0.0}};
        rows.direction = {Vec3(0.0, 1.0, 0.0)};
        rows.obstacle_point = rows.obstacle_displacement = {Vec3::Zero()};
        rows.distance = {distance};
        rows.thickness = {projection_zone * h};
        rows.friction = {mu};
        rows.share = {1.0};
        rows.obstacle = rows.feature = {0};
        projection.end({}, {}, {}, memory);  // nothing was nearer than the thickness before
        projection.begin(memory);
    }

    ContactPoint point() const {
        return {.rows = rows,
                .positions = velocities,
                .velocities = velocities,
                .step = {.dt = dt, .obstacle_rate = 1.0 / dt, .mass = nullptr, .diagonal = &diagonal}};
    }
    ContactForces result() { return {total, potential, terms, forces}; }
    void add() {
        total.resize(1);
        projection.evaluate(point(), result());
    }
    void advance() { projection.correct(point(), result(), 0.0); }
    void keep() { projection.end(rows, {}, forces, memory); }
};

}  // namespace

TEST_CASE("A projected row's push is minus the derivative of its energy and its matrix that of its push") {
    const double taken = GENERATE(1.0, 0.3);  // ContactRows::share
    for (const double share : {0.2, 0.45, 0.55, 0.9, 1.02, 1.15}) {
        CAPTURE(share, taken);
        const double step = 1e-7 * h;
        OneRow low(share * h - step), middle(share * h), high(share * h + step);
        for (OneRow* row : {&low, &middle, &high}) {
            const double distance = row->rows.distance[0];
            row->rows.share = {taken};
            row->rows.distance[0] = 0.93 * h;  // a multiplier from elsewhere
            row->add();
            row->advance();
            row->rows.distance[0] = distance;
            row->add();
        }
        const double push = middle.forces[0].normal;
        CHECK(middle.total.at(0).y() == Approx(push));
        const double zone = 2.0 * step * std::max(push, 1.0);
        CHECK(low.terms.energy - high.terms.energy == Approx(2.0 * step * push).margin(1e-4 * zone));
        const double slope = (low.forces[0].normal - high.forces[0].normal) / (2.0 * step);
        const double entry = push > 0.0 ? middle.terms.blocks.at(0).k[3] / (OneRow::dt * OneRow::dt) : 0.0;
        CHECK(slope == Approx(entry).epsilon(1e-4));
    }
}

TEST_CASE("A projected row sticks inside Coulomb's cone and slides on it against the slip") {
    for (const double speed : {1e-4, 1e-2, 10.0}) {
        OneRow row(0.9 * h, Vec3(0.6 * speed, 0.0, 0.8 * speed));
        row.add();
        const double stiffness = row.forces[0].stiffness, limit = OneRow::mu * row.forces[0].normal;
        const double damped = stiffness * OneRow::dt * speed;
        CAPTURE(speed, limit, damped);
        CHECK((row.forces[0].friction + std::min(damped, limit) * Vec3(0.6, 0.0, 0.8)).norm() < 1e-9 * limit);
    }
}

TEST_CASE("A force that went on to another row of its cloth feature lasts there") {
    OneRow row(0.95 * h);
    row.add();
    const double push = row.forces[0].normal;
    for (int part = 0; part < 2; ++part) row.keep();
    row.rows.feature = {1};
    row.rows.distance = {h};
    for (int part = 0; part < 2; ++part) {
        row.projection.begin(row.memory);
        row.projection.meet(row.rows);
        row.add();
        CHECK(row.forces[0].normal == Approx(push));
        row.keep();
    }
}

TEST_CASE("Rows that push one vertex as the step begins share its stiffness, others do not count") {
    const auto stiffness = [](double second_distance, double second_share) {
        OneRow row(0.95 * h);
        ContactRows& rows = row.rows;
        for (auto* numbers : {&rows.thickness, &rows.friction, &rows.share, &rows.distance}) numbers->push_back(numbers->front());
        for (auto* vectors : {&rows.direction, &rows.obstacle_point, &rows.obstacle_displacement})
            vectors->push_back(vectors->front());
        rows.vertex.push_back(rows.vertex[0]);
        rows.weight.push_back(rows.weight[0]);
        rows.obstacle = {0, 0};
        rows.feature = {0, 1};
        rows.distance[1] = second_distance;
        rows.share[1] = second_share;
        row.projection.meet(rows);
        row.add();
        return row.forces[0].stiffness;
    };
    CHECK(stiffness(0.95 * h, 1.0) == Approx(0.5 * stiffness(1.05 * h, 1.0)));
    CHECK(stiffness(0.95 * h, 0.5) == Approx(stiffness(1.05 * h, 1.0) / 1.5));
    OneRow alone(0.95 * h);
    alone.add();
    CHECK(stiffness(1.05 * h, 1.0) == Approx(alone.forces[0].stiffness));
}

TEST_CASE("Multipliers match where rows are at the thickness without slip") {
    OneRow row(0.95 * h);
    row.add();
    const double push = row.forces[0].normal;
    CHECK(row.projection.mismatch(row.rows, row.forces) == Approx(0.05 * h));
    row.advance();
    CHECK(row.forces[0].normal == Approx(2.0 * push));
    CHECK(row.total.at(0).y() == Approx(2.0 * push));
    row.rows.distance = {h};
    row.add();
    CHECK(row.forces[0].normal == Approx(push));
    CHECK(row.projection.mismatch(row.rows, row.forces) < 1e-12);
}

TEST_CASE("A step begins with contact forces that lasted for two spans") {
    OneRow row(0.95 * h);
    row.add();
    const double push = row.forces[0].normal;
    row.keep();
    row.rows.distance = {h};
    row.projection.begin(row.memory);
    row.add();
    CHECK(row.forces[0].normal == 0.0);
    row.forces[0].normal = 3.0 * push;
    row.keep();
    row.projection.begin(row.memory);
    row.add();
    CHECK(row.forces[0].normal == Approx(push));
    row.memory.forget();
    row.projection.begin(row.memory);
    row.add();
    CHECK(row.forces[0].normal == 0.0);
}

TEST_CASE("Projected cloth that fell on a plane rests at the thickness") {
    const auto solver = GENERATE(LinearSolver::automatic, LinearSolver::cg, LinearSolver::direct);
    for (const double dt : {1.0 / 60.0, 1.0 / 240.0}) {
        StepSettings settings = projected(dt);
        settings.linear_solver = solver;
        SolverScene scene = sheet_on_plane(0.0, 0.3, 0.05, settings);
        run(scene, static_cast<int>(std::round(2.0 / dt)));
        for (int i = 0; i < 16; ++i) {
            CAPTURE(dt, i, scene.state.positions.y[i] - h);
            CHECK(scene.state.positions.y[i] == Approx(h).margin(1e-6));
            CHECK(scene.state.velocities.at(i).norm() < 1e-6);
        }
    }
}

TEST_CASE("Projected cloth thrown at a plane never crosses it and gains no energy") {
    for (const double speed : {1.0, 10.0, 100.0}) {
        SolverScene scene = sheet_on_plane(0.0, 0.3, 0.05, projected());
        for (int i = 0; i < 16; ++i) scene.state.velocities.set(i, Vec3(0.3, -speed, 0.0));
        const double before = energy(scene);
        for (int n = 0; n < 60; ++n) {
            const NewtonReport report = scene.step_implicit();
            CAPTURE(speed, n, before, energy(scene), report.newton_iterations, report.residual);
            REQUIRE(report.end != NewtonEnd::not_finite);
            REQUIRE(report.end != NewtonEnd::blocked);
            REQUIRE(energy(scene) <= before);
            for (int i = 0; i < 16; ++i) REQUIRE(scene.state.positions.y[i] > 0.0);
        }
    }
}

TEST_CASE("However many rounds contact takes, Newton makes no more iterations than allowed, and says so") {
    for (const int limit : {2, 3, 5}) {
        int used_up = 0;
        SolverScene scene = sheet_on_plane(0.0, 0.3, 0.02, projected());
        scene.settings.newton_iterations = limit;
        for (int i = 0; i < 16; ++i) scene.state.velocities.set(i, Vec3(0.3, -10.0, 0.1 * i));
        for (int n = 0; n < 20; ++n) {
            const NewtonReport report = scene.step_implicit();
            CAPTURE(limit, n, report.newton_iterations);
            REQUIRE(report.newton_iterations <= limit);
            if (report.end == NewtonEnd::iterations_used) {
                REQUIRE(report.newton_iterations == limit);
                ++used_up;
            }
        }
        CHECK(used_up > 0);
    }
}

TEST_CASE("On an incline flatter than friction's angle projected cloth does not move at all") {
    const double angle = 20.0 * std::numbers::pi / 180.0;
    for (const double mu : {1.01 * std::tan(angle), 0.6, 1.0}) {
        SolverScene scene = sheet_on_plane(angle, mu, h, projected());
        const Vec3 before = scene.state.positions.at(5);
        run(scene, 120);
        const Vec3 after = scene.state.positions.at(5);
        run(scene, 60);
        CAPTURE(mu, (after - before).norm(), (scene.state.positions.at(5) - after).norm(), mean_velocity(scene).norm());
        CHECK(mean_velocity(scene).norm() < 1e-9);
        CHECK((scene.state.positions.at(5) - after).norm() < 1e-9);
        CHECK((after - before).norm() < 1e-4);  // until the friction is found
    }
}

TEST_CASE("On a steeper incline projected cloth slides with g (sin a - mu cos a)") {
    const double angle = 20.0 * std::numbers::pi / 180.0;
    for (const double mu : {0.0, 0.1, 0.2, 0.3}) {
        SolverScene scene = sheet_on_plane(angle, mu, h, projected());
        run(scene, 12);
        const Vec3 before = mean_velocity(scene);
        run(scene, 48);
        const Vec3 downhill(std::cos(angle), -std::sin(angle), 0.0);
        const double measured = (mean_velocity(scene) - before).dot(downhill) / 0.8;
        const double expected = 9.81 * (std::sin(angle) - mu * std::cos(angle));
        CAPTURE(mu, measured, expected);
        CHECK(measured == Approx(expected).epsilon(5e-4));
    }
}

TEST_CASE("A plane that moves carries projected cloth along and up") {
    SolverScene scene = sheet_on_plane(0.0, 0.5, h, projected());
    const Vec3 move(0.01, 0.002, 0.0);  // m a step
    const Vec3 start = scene.state.positions.at(5);
    scene.plan.obstacles_move = true;
    for (int n = 0; n < 120; ++n) {
        scene.detector->move_obstacle(0, {.translation = n * move}, {.translation = (n + 1) * move});
        run(scene, 1);
    }
    const Vec3 speed = 60.0 * move;
    CAPTURE(mean_velocity(scene).transpose());
    CHECK((mean_velocity(scene) - speed).norm() < 1e-6);
    CHECK(scene.state.positions.at(5).y() == Approx(start.y() + 120 * move.y()).margin(1e-6));
}

TEST_CASE("The threshold between sticking and sliding of projected cloth is the tangent of the angle", "[law]") {
    const double angle = std::atan(0.5);
    double sticks = 1.0, slides = 0.1;
    while (sticks - slides > 2e-4) {
        const double mu = 0.5 * (sticks + slides);
        SolverScene scene = sheet_on_plane(angle, mu, h, projected());
        run(scene, 120);
        (mean_velocity(scene).norm() < 1e-6 ? sticks : slides) = mu;
    }
    check_law("slope of 1 : 2, projection: error of the friction coefficient at which it sticks", std::abs(sticks - 0.5), 1e-3);
}

}  // namespace percale::test::projection_test
