// There is no hidden absolute constant: a scene in other units of length, turned or renumbered moves the same, contact included.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "percale/detectors.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

namespace percale::test::scaling_test {
namespace {

/// The variations; the scene itself is always a free mesh or grid over a ball, or hung from two vertices.
struct Variant {
    StepSettings settings = {};
    bool ball = true;
    bool self_contact = false;
    bool bends = false;  // bend_stiffness and moduli instead of springs
    double unit = 1.0;   // 1/m: lengths are given in this unit
    Rotation turn = {};
    bool shuffled = false;
};

std::vector<int> numbering(int count, bool shuffled) {
    std::vector<int> number(count);
    std::iota(number.begin(), number.end(), 0);
    std::mt19937 engine(4);
    if (shuffled) std::shuffle(number.begin(), number.end(), engine);
    return number;
}

TriangleMesh renumbered(const TriangleMesh& mesh, const std::vector<int>& number) {
    TriangleMesh result = mesh;
    for (std::size_t i = 0; i < number.size(); ++i) result.vertices[number[i]] = mesh.vertices[i];
    for (Triangle& t : result.triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
    return result;
}

/// The same cloth with lengths s times as large, masses s^2, times unchanged: area densities stay, forces are s^3 times as
/// large, spring constants s^2.
Fabric fabric_in(const Variant& variant) {
    const double s = variant.unit, square = s * s;
    Fabric fabric = free_fabric();
    fabric.thickness *= s;
    fabric.self_contact = variant.self_contact;
    fabric.springs = {.structural = 400.0 * square, .shear = 0.0, .bend = 10.0 * square};
    fabric.spring_damping *= square;
    if (!variant.bends) return fabric;
    fabric.springs = {.structural = 0.0};
    fabric.stretch_stiffness = {{400.0 * square, 400.0 * square}};
    fabric.bend_stiffness = 1e-3 * square * square;
    return fabric;
}

TriangleMesh sheet_in(const Variant& variant) {
    TriangleMesh mesh = make_grid(0.4 * variant.unit, 0.4 * variant.unit, 9, 9);
    mesh.grid_columns = mesh.grid_rows = 0;
    // Without symmetry and flat parts: otherwise rounding decides between two equally near features, and which way a sheet
    // buckles.
    Random random(8);
    for (Vec3& x : mesh.vertices) x += variant.unit * (Vec3(0.0, 0.11, 0.0) + random.point(4e-3));
    return mesh;
}

TriangleMesh ball_in(const Variant& variant) {
    TriangleMesh ball = make_sphere(0.09 * variant.unit, 3);
    ball.vertices = transform(Pose{.translation = Vec3::Zero(), .rotation = Random(3).rotation()}, ball.vertices);
    return ball;
}

StepSettings settings_in(const Variant& variant) {
    StepSettings settings = variant.settings;
    const Pose turn{.translation = Vec3::Zero(), .rotation = variant.turn};
    settings.gravity = transform(turn, Vec3(0.3, -9.81, 0.2)) * variant.unit;
    settings.tolerance *= variant.unit;
    return settings;
}

/// Positions after some steps, in m and in the numbers and axes of the plain scene.
std::vector<Vec3> run(const Variant& variant, int steps) {
    Simulation simulation(settings_in(variant), variant.ball || variant.self_contact ? make_brute_force_detector() : nullptr);
    const Pose turn{.translation = Vec3::Zero(), .rotation = variant.turn};
    const TriangleMesh mesh = sheet_in(variant);
    const std::vector<int> number = numbering(static_cast<int>(mesh.vertices.size()), variant.shuffled);
    const ClothId cloth = simulation.add_cloth(renumbered(mesh, number), fabric_in(variant), turn);
    if (variant.ball) simulation.add_obstacle(ball_in(variant), turn);
    if (!variant.ball) {
        for (const int corner : {0, 8}) simulation.pin(cloth, number[corner]);
    }
    for (int n = 0; n < steps; ++n) {
        const StepReport report = simulation.step();
        CAPTURE(n, report.explanation());
        REQUIRE(report.ok());
    }
    const Rotation& q = variant.turn;
    const Pose back{.translation = Vec3::Zero(), .rotation = {q.w, -q.x, -q.y, -q.z}};
    const std::vector<Vec3> moved = transform(back, simulation.positions(cloth));
    std::vector<Vec3> points(moved.size());
    for (std::size_t i = 0; i < moved.size(); ++i) points[i] = moved[number[i]] / variant.unit;
    return points;
}

struct Way {
    const char* name;
    Variant variant;
    int steps;
};

/// With the default settings: rules that stop early, lists, multigrid.
std::vector<Way> default_ways() {
    return {{"hanging, backward Euler", {.settings = {}, .ball = false}, 60},
            {"hanging, multigrid", {.settings = {.linear_solver = LinearSolver::multigrid}, .ball = false}, 30},
            {"hanging, direct", {.settings = {.linear_solver = LinearSolver::direct}, .ball = false}, 30},
            {"hanging, TR-BDF2", {.settings = {.scheme = Scheme::tr_bdf2}, .ball = false}, 30},
            {"hanging, adaptive", {.settings = {.adaptive = true, .scheme = Scheme::tr_bdf2}, .ball = false}, 10},
            {"hanging, RK4", {.settings = {.time_step = 1e-4, .scheme = Scheme::rk4}, .ball = false}, 300},
            {"woven, hanging", {.settings = {}, .ball = false, .bends = true}, 60},
            {"on a ball, penalty", {}, 60},
            {"on a ball, projection", {.settings = {.contact_response = ContactResponse::projection}}, 40},
            {"on a ball, TR-BDF2", {.settings = {.scheme = Scheme::tr_bdf2}}, 40},
            {"with self contact", {.settings = {}, .self_contact = true}, 60},
            {"woven, on a ball", {.settings = {}, .self_contact = true, .bends = true}, 60}};
}

/// Solved as exactly as doubles allow. Multigrid coarsens in the memory order of a free mesh, which follows the axes. Another
/// path of Newton finds other contacts, which then stay until the step ends: that is no rounding.
StepSettings tight(Scheme scheme, ContactResponse response = ContactResponse::penalty) {
    return {.scheme = scheme,
            .newton_tolerance = 1e-11,
            .newton_iterations = 500,
            .linear_solver = LinearSolver::cg,
            .contact_response = response};
}

struct TightWay : Way {
    double limit = 1e-9;  // relative to the size of the sheet
};

/// In contact rounding grows tenfold in 0.1 s. Rounds of projected contact end when the multipliers are known to 2e-4 of the
/// thickness; rounding decides which round that is.
std::vector<TightWay> tight_ways() {
    return {{{"hanging, backward Euler", {.settings = tight(Scheme::backward_euler), .ball = false}, 30}},
            {{"hanging, TR-BDF2", {.settings = tight(Scheme::tr_bdf2), .ball = false}, 30}},
            {{"on a ball, penalty", {.settings = tight(Scheme::backward_euler)}, 20}, 1e-8},
            {{"on a ball, projection", {.settings = tight(Scheme::backward_euler, ContactResponse::projection)}, 20}, 1e-6},
            {{"on a ball, TR-BDF2", {.settings = tight(Scheme::tr_bdf2)}, 10}, 1e-8}};
}

constexpr double size = 0.4;  // m, of the sheet, to which differences are relative

}  // namespace

TEST_CASE("Lengths in other units, times a power of two, give the same bits", "[law]") {
    for (const Way& way : default_ways()) {
        CAPTURE(way.name);
        const std::vector<Vec3> plain = run(way.variant, way.steps);
        for (const double unit : {1.0 / 128.0, 16.0}) {
            Variant other = way.variant;
            other.unit = unit;
            check_law("lengths times " + figure(unit, 4) + ", " + way.name + ": relative difference",
                      largest_difference(plain, run(other, way.steps)) / size, 0.0);
        }
    }
}

TEST_CASE("A scene in millimetres, turned or renumbered moves the same: to 1e-9 for 0.5 s, in contact to 1e-8 for 0.3 s",
          "[law]") {
    for (const TightWay& way : tight_ways()) {
        CAPTURE(way.name);
        const std::vector<Vec3> plain = run(way.variant, way.steps);
        Variant small = way.variant, turned = way.variant, mixed = way.variant;
        small.unit = 1e-3;
        turned.turn = Random(21).rotation();
        mixed.shuffled = true;
        const auto difference = [&](const Variant& variant) { return largest_difference(plain, run(variant, way.steps)) / size; };
        const std::string name = std::string(", ") + way.name + ": relative difference";
        check_law("lengths in mm" + name, difference(small), way.limit);
        check_law("scene turned" + name, difference(turned), way.limit);
        check_law("scene renumbered" + name, difference(mixed), way.limit);
    }
}

}  // namespace percale::test::scaling_test
