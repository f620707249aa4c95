#include <fstream>
#include <sstream>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

// Strips that bend under their own weight against the heavy elastica (data/reference/elastica.csv).

namespace percale::test::elastica_test {
namespace {

constexpr double length = 0.2, weight = 0.2 * 9.81;  // m; N/m^2

struct Reference {
    std::string shape;
    double gamma = 0.0, depth = 0.0, width = 0.0, rise = 0.0;
};

std::vector<Reference> references(const std::string& shape) {
    std::ifstream file(std::string(PERCALE_DATA_DIR) + "/reference/elastica.csv");
    std::vector<Reference> result;
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(shape)) continue;
        std::replace(line.begin(), line.end(), ',', ' ');
        Reference row;
        std::istringstream(line) >> row.shape >> row.gamma >> row.depth >> row.width >> row.rise;
        result.push_back(row);
    }
    REQUIRE(result.size() >= 2);
    return result;
}

/// Drop of the tip of a heavy cantilever over its length: B theta'' = -w (L - s) cos theta, theta(0) = 0, theta'(L) = 0, shot
/// from the tip by Runge-Kutta.
double cantilever_drop(double gamma) {
    constexpr int steps = 2000;
    const auto shoot = [&](double tip_angle, double& drop) {
        double angle = tip_angle, rate = 0.0;
        drop = 0.0;
        const double h = 1.0 / steps;
        for (int k = 0; k < steps; ++k) {
            const double t = k * h;  // from the tip
            const auto bend = [&](double s, double a) { return -gamma * s * std::cos(a); };
            const double k1 = bend(t, angle), a2 = angle + 0.5 * h * rate, r2 = rate + 0.5 * h * k1;
            const double k2 = bend(t + 0.5 * h, a2), a3 = angle + 0.5 * h * r2, r3 = rate + 0.5 * h * k2;
            const double k3 = bend(t + 0.5 * h, a3), a4 = angle + h * r3, r4 = rate + h * k3;
            drop += h / 6.0 * (std::sin(angle) + 2.0 * std::sin(a2) + 2.0 * std::sin(a3) + std::sin(a4));
            angle += h / 6.0 * (rate + 2.0 * r2 + 2.0 * r3 + r4);
            rate += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + bend(t + h, a4));
        }
        return angle;
    };
    double low = 0.0, high = 1.6, drop = 0.0;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (shoot(middle, drop) < 0.0 ? low : high) = middle;
    }
    return drop;
}

/// A strip of some segments between clamped ones at its start or at both ends.
struct Strip {
    int segments;
    bool along_z = false;
    Simulation simulation{{.time_step = 1.0,
                           .newton_tolerance = 1e-7,
                           .newton_iterations = 200,
                           .linear_solver = LinearSolver::direct,
                           .measure = StepMeasures::all}};
    ClothId cloth = {};
    int columns = 0;

    Strip(int segments_, const Fabric& fabric, int clamped, bool along_z_ = false) : segments(segments_), along_z(along_z_) {
        const double h = length / segments, whole = length + clamped * h;
        columns = segments + clamped + 1;
        cloth = simulation.add_cloth(along_z ? make_grid(h, whole, 2, columns) : make_grid(whole, h, columns, 2), fabric);
    }

    int vertex(int column, int row) const { return along_z ? 2 * column + row : row * columns + column; }

    void settle() {
        for (int k = 0; k < 40; ++k) {
            const StepReport report = simulation.step();
            REQUIRE(report.ok());
            if (report.largest_speed < 1e-8) return;
        }
        FAIL("the strip does not come to rest");
    }
};

Fabric strip_fabric(double gamma) {
    // Inextensible against the tension B/L^2 that bends a loop.
    const double structural = 2e4 + 4e5 / gamma;
    Fabric fabric{.area_density = 0.2,
                  .thickness = 1e-3,
                  .springs = {.structural = structural, .shear = 0.25 * structural},
                  .spring_damping = 0.0};
    fabric.bend_stiffness = weight * length * length * length / gamma;
    return fabric;
}

double drop_of(int segments, const Fabric& fabric, bool along_z = false) {
    Strip strip(segments, fabric, 1, along_z);
    for (int row = 0; row < 2; ++row) {
        for (int column = 0; column < 2; ++column) strip.simulation.pin(strip.cloth, strip.vertex(column, row));
    }
    strip.settle();
    return -strip.simulation.positions(strip.cloth)[strip.vertex(segments + 1, 0)].y() / length;
}

/// Both ends clamped at the origin, the first segment leaving along `start`, the last arriving along `end`; begins as a circle
/// that hangs from there.
Reference loop_of(int segments, double gamma, const Vec3& start, const Vec3& end) {
    Strip strip(segments, strip_fabric(gamma), 2);
    const double h = length / segments, radius = length / (2.0 * std::numbers::pi);
    std::vector<Vec3> points(2 * strip.columns);
    for (int column = 0; column < strip.columns; ++column) {
        const double angle = (column - 1) * h / radius;
        Vec3 x(radius * std::sin(angle), radius * (std::cos(angle) - 1.0), 0.0);
        if (column == 0) x = -h * start;
        if (column == strip.columns - 1) x = h * end;
        for (int row = 0; row < 2; ++row) points[strip.vertex(column, row)] = x + row * h * Vec3::UnitZ();
    }
    strip.simulation.set_positions(strip.cloth, points);
    for (int row = 0; row < 2; ++row) {
        for (const int column : {0, 1, segments + 1, segments + 2}) strip.simulation.pin(strip.cloth, strip.vertex(column, row));
    }
    strip.settle();
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    for (int column = 1; column <= segments + 1; ++column) {
        const Vec3 x = strip.simulation.positions(strip.cloth)[strip.vertex(column, 0)];
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    return {"", gamma, -low.y() / length, (high.x() - low.x()) / length, high.y() / length};
}

void check_loop(const std::string& shape, const Vec3& start, const Vec3& end, double tolerance) {
    for (const Reference& exact : references(shape)) {
        const Reference found = loop_of(64, exact.gamma, start, end);
        CAPTURE(shape, exact.gamma, found.depth - exact.depth, found.width - exact.width, found.rise - exact.rise);
        CHECK(std::abs(found.depth - exact.depth) < tolerance);
        CHECK(std::abs(found.width - exact.width) < tolerance);
        CHECK(std::abs(found.rise - exact.rise) < tolerance);
        std::printf("%s, Gamma %g: depth %.5f (exact %.5f), width %.5f (%.5f), rise %.5f (%.5f)\n", shape.c_str(), exact.gamma,
                    found.depth, exact.depth, found.width, exact.width, found.rise, exact.rise);
    }
}

void check_cantilever(const Reference& exact, bool along_z) {
    double before = 0.0, error = 0.0;
    for (const int segments : {8, 16, 32}) {
        error = drop_of(segments, strip_fabric(exact.gamma), along_z) - exact.depth;
        std::printf("cantilever, Gamma %g, %d segments along %s: H/L = %.6f, error %.1e\n", exact.gamma, segments,
                    along_z ? "z" : "x", exact.depth + error, error);
        if (before > 0.0) CHECK(std::log2(before / error) == Approx(2.0).margin(0.15));
        before = error;
    }
    CHECK(std::abs(error) < 8e-4);
}

}  // namespace

TEST_CASE("The reference of the cantilever solves its equation") {
    for (const Reference& exact : references("cantilever"))
        CHECK(cantilever_drop(exact.gamma) == Approx(exact.depth).epsilon(1e-8));
}

TEST_CASE("A cantilever's droop converges at second order to the heavy elastica, along both axes of a grid") {
    for (const Reference& exact : references("cantilever")) {
        if (exact.gamma > 10.0) continue;
        check_cantilever(exact, false);
        check_cantilever(exact, true);
    }
}

TEST_CASE("Bending springs do not converge to a stiffness: finer strips of the same springs droop further from the elastica") {
    Fabric fabric = strip_fabric(8.0);
    fabric.bend_stiffness.reset();
    double before = 0.0;
    for (const int segments : {8, 16}) {
        fabric.springs.bend = 10.0;
        const double drop = drop_of(segments, fabric);
        std::printf("cantilever of bending springs, %d segments: H/L = %.6f\n", segments, drop);
        CHECK(drop > before);
        CHECK(drop - 0.640631 > 0.1);
        before = drop;
    }
}

TEST_CASE("A hanging ring, a pear loop and a heart loop take the shapes of the heavy elastica") {
    check_loop("ring", Vec3::UnitX(), Vec3::UnitX(), 1e-3);
    check_loop("pear", -Vec3::UnitY(), Vec3::UnitY(), 1e-3);
    check_loop("heart", Vec3::UnitY(), -Vec3::UnitY(), 1e-3);
}

}  // namespace percale::test::elastica_test
