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

/// One vertex in contact with the plane y = 0; its step matrix is `inertia` kg.
struct OneConstraint {
    static constexpr double dt = 0.01, inertia = 2.0, mu = 0.4;
    ContactConstraints constraints;
    DiagonalBlocks diagonal;
    Vec3Arrays velocities, total;
    ContactTerms terms;
    std::vector<ConstraintForce> forces;
    double potential = 0.0;
    ProjectedContact projection;
    ContactWarmStart warm_start;

    explicit OneConstraint(double distance, const Vec3& velocity = Vec3::Zero()) {
        diagonal.resize(16);
        for (const int entry : {0, 3, 5}) diagonal.data[16 * entry] = inertia;
        velocities.resize(1);
        velocities.set(0, velocity);
        constraints.vertex = {{0, -1, -1, -1}};
        constraints.weight = {{1.0, 0.0, 0.0, 0.0}};
        constraints.direction = {Vec3(0.0, 1.0, 0.0)};
        constraints.obstacle_point = constraints.obstacle_displacement = {Vec3::Zero()};
        constraints.distance = {distance};
        constraints.thickness = {projection_activation_ratio * h};
        constraints.friction = {mu};
        constraints.mollifier = {1.0};
        constraints.obstacle = constraints.feature = {0};
        projection.end({}, {}, {}, warm_start);  // min_distance is the thickness
        projection.begin(warm_start);
    }

    ContactPoint point() const {
        return {.constraints = constraints,
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
    void keep() { projection.end(constraints, {}, forces, warm_start); }
};

}  // namespace

TEST_CASE("A projected constraint's normal force is minus the derivative of its energy, and its matrix that of its force") {
    const double taken = GENERATE(1.0, 0.3);  // ContactConstraints::mollifier
    for (const double mollifier : {0.2, 0.45, 0.55, 0.9, 1.02, 1.15}) {
        CAPTURE(mollifier, taken);
        const double step = 1e-7 * h;
        OneConstraint low(mollifier * h - step), middle(mollifier * h), high(mollifier * h + step);
        for (OneConstraint* constraint : {&low, &middle, &high}) {
            const double distance = constraint->constraints.distance[0];
            constraint->constraints.mollifier = {taken};
            constraint->constraints.distance[0] = 0.93 * h;  // a multiplier from elsewhere
            constraint->add();
            constraint->advance();
            constraint->constraints.distance[0] = distance;
            constraint->add();
        }
        const double push = middle.forces[0].normal;
        CHECK(middle.total.at(0).y() == Approx(push));
        const double activation_ratio = 2.0 * step * std::max(push, 1.0);
        CHECK(low.terms.energy - high.terms.energy == Approx(2.0 * step * push).margin(1e-4 * activation_ratio));
        const double slope = (low.forces[0].normal - high.forces[0].normal) / (2.0 * step);
        const double entry = push > 0.0 ? middle.terms.blocks.at(0).k[3] / (OneConstraint::dt * OneConstraint::dt) : 0.0;
        CHECK(slope == Approx(entry).epsilon(1e-4));
    }
}

TEST_CASE("A projected constraint sticks inside Coulomb's cone and slides on it against the slip") {
    for (const double speed : {1e-4, 1e-2, 10.0}) {
        OneConstraint constraint(0.9 * h, Vec3(0.6 * speed, 0.0, 0.8 * speed));
        constraint.add();
        const double stiffness = constraint.forces[0].stiffness, limit = OneConstraint::mu * constraint.forces[0].normal;
        const double damped = stiffness * OneConstraint::dt * speed;
        CAPTURE(speed, limit, damped);
        CHECK((constraint.forces[0].friction + std::min(damped, limit) * Vec3(0.6, 0.0, 0.8)).norm() < 1e-9 * limit);
    }
}

TEST_CASE("A projected constraint that is subtracted has the opposite force and no matrix") {
    for (const double speed : {0.0, 1e-4, 10.0}) {
        OneConstraint counted(0.9 * h, Vec3(0.6 * speed, 0.0, 0.8 * speed)), subtracted = counted;
        subtracted.constraints.mollifier = {-1.0};
        counted.add();
        subtracted.add();
        REQUIRE(counted.forces[0].normal > 0.0);
        CHECK(subtracted.forces[0].normal == -counted.forces[0].normal);
        CHECK(subtracted.forces[0].friction == -counted.forces[0].friction);
        CHECK((subtracted.total.at(0) + counted.total.at(0)).norm() == 0.0);
        CHECK(subtracted.terms.blocks.empty());
    }
}

TEST_CASE("The force of a constraint that is gone acts on in another of its cloth feature, and is back where it comes back") {
    OneConstraint constraint(0.95 * h);
    constraint.add();
    constraint.advance();
    const double push = constraint.forces[0].normal;
    constraint.constraints.feature = {1};
    constraint.add();
    CHECK(constraint.forces[0].normal == Approx(push));
    constraint.constraints.feature = {0};
    constraint.add();
    CHECK(constraint.forces[0].normal == Approx(push));
}

TEST_CASE("A force that moved on to another constraint of its cloth feature lasts there") {
    OneConstraint constraint(0.95 * h);
    constraint.add();
    const double push = constraint.forces[0].normal;
    for (int part = 0; part < 2; ++part) constraint.keep();
    constraint.constraints.feature = {1};
    constraint.constraints.distance = {h};
    for (int part = 0; part < 2; ++part) {
        constraint.projection.begin(constraint.warm_start);
        constraint.projection.set_constraints(constraint.constraints);
        constraint.add();
        CHECK(constraint.forces[0].normal == Approx(push));
        constraint.keep();
    }
}

TEST_CASE("Constraints that push one vertex as the step begins share its stiffness, others do not count") {
    const auto stiffness = [](double second_distance, double second_share) {
        OneConstraint constraint(0.95 * h);
        ContactConstraints& constraints = constraint.constraints;
        for (auto* numbers : {&constraints.thickness, &constraints.friction, &constraints.mollifier, &constraints.distance})
            numbers->push_back(numbers->front());
        for (auto* vectors : {&constraints.direction, &constraints.obstacle_point, &constraints.obstacle_displacement})
            vectors->push_back(vectors->front());
        constraints.vertex.push_back(constraints.vertex[0]);
        constraints.weight.push_back(constraints.weight[0]);
        constraints.obstacle = {0, 0};
        constraints.feature = {0, 1};
        constraints.distance[1] = second_distance;
        constraints.mollifier[1] = second_share;
        constraint.projection.set_constraints(constraints);
        constraint.add();
        return constraint.forces[0].stiffness;
    };
    CHECK(stiffness(0.95 * h, 1.0) == Approx(0.5 * stiffness(1.05 * h, 1.0)));
    CHECK(stiffness(0.95 * h, 0.5) == Approx(stiffness(1.05 * h, 1.0) / 1.5));
    OneConstraint alone(0.95 * h);
    alone.add();
    CHECK(stiffness(1.05 * h, 1.0) == Approx(alone.forces[0].stiffness));
}

TEST_CASE("Multipliers match where constraints are at the thickness without slip") {
    OneConstraint constraint(0.95 * h);
    constraint.add();
    const double push = constraint.forces[0].normal;
    CHECK(constraint.projection.mismatch(constraint.constraints, constraint.forces) == Approx(0.05 * h));
    constraint.advance();
    CHECK(constraint.forces[0].normal == Approx(2.0 * push));
    CHECK(constraint.total.at(0).y() == Approx(2.0 * push));
    constraint.constraints.distance = {h};
    constraint.add();
    CHECK(constraint.forces[0].normal == Approx(push));
    CHECK(constraint.projection.mismatch(constraint.constraints, constraint.forces) < 1e-12);
}

TEST_CASE("A step begins with contact forces that lasted for two substeps") {
    OneConstraint constraint(0.95 * h);
    constraint.add();
    const double push = constraint.forces[0].normal;
    constraint.keep();
    constraint.constraints.distance = {h};
    constraint.projection.begin(constraint.warm_start);
    constraint.add();
    CHECK(constraint.forces[0].normal == 0.0);
    constraint.forces[0].normal = 3.0 * push;
    constraint.keep();
    constraint.projection.begin(constraint.warm_start);
    constraint.add();
    CHECK(constraint.forces[0].normal == Approx(push));
    constraint.warm_start.forget();
    constraint.projection.begin(constraint.warm_start);
    constraint.add();
    CHECK(constraint.forces[0].normal == 0.0);
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
        CHECK((after - before).norm() < 1e-4);  // until the friction forces are found
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
