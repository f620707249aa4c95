#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

// The hanging sheet: 1 m x 1 m, 33 x 33 vertices, two neighbouring corners held.

namespace percale::test::reference_sheet_test {
namespace {

constexpr int side = 33;

std::vector<Vec3> percale_sheet(const StepSettings& settings, double time, double* largest_strain = nullptr) {
    Simulation simulation(settings);
    const ClothId cloth = simulation.add_cloth(make_grid(1.0, 1.0, side, side), sheet_fabric());
    simulation.pin(cloth, 0);
    simulation.pin(cloth, side - 1);
    const int steps = static_cast<int>(std::lround(time / settings.time_step));
    for (int n = 0; n < steps; ++n) {
        const StepReport report = simulation.step();
        REQUIRE(report.status == StepStatus::ok);
        if (largest_strain) *largest_strain = std::max(*largest_strain, report.largest_strain);
    }
    return copy(simulation.positions(cloth));
}

/// The same sheet without any of Percale's code: its own springs, its own arrays, classical Runge-Kutta.
class PlainSheet {
public:
    PlainSheet() : x_(side * side), v_(side * side, {0, 0, 0}) {
        for (int i = 0; i < side * side; ++i) x_[i] = {-0.5 + i % side / (side - 1.0), 0.0, -0.5 + i / side / (side - 1.0)};
        for (int i = 0; i < side * side; ++i) {
            for (int j = i + 1; j < side * side && j <= i + 2 * side; ++j) {
                const int across = std::abs(i % side - j % side), down = j / side - i / side;
                if (across + down == 1) springs_.push_back({i, j, 1000.0, 1.0 / (side - 1)});
                if (across == 1 && down == 1) springs_.push_back({i, j, 500.0, std::sqrt(2.0) / (side - 1)});
                if (across + down == 2 && across * down == 0) springs_.push_back({i, j, 10.0, 2.0 / (side - 1)});
            }
        }
    }

    void step(double dt) {
        const State x0 = x_, v0 = v_;
        State dx(x0.size(), {0, 0, 0}), dv = dx, x = x0, v = v0;
        for (const auto& [weight, ahead] : {std::pair(1.0, 0.5), {2.0, 0.5}, {2.0, 1.0}, {1.0, 0.0}}) {
            const State a = accelerations(x, v);
            for (std::size_t i = 0; i < x.size(); ++i) {
                for (int c = 0; c < 3; ++c) {
                    dx[i][c] += weight / 6.0 * v[i][c];
                    dv[i][c] += weight / 6.0 * a[i][c];
                    x[i][c] = x0[i][c] + ahead * dt * v[i][c];
                    v[i][c] = v0[i][c] + ahead * dt * a[i][c];
                }
            }
        }
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                x_[i][c] = x0[i][c] + dt * dx[i][c];
                v_[i][c] = v0[i][c] + dt * dv[i][c];
            }
        }
    }

    std::vector<Vec3> positions() const {
        std::vector<Vec3> points;
        for (const auto& x : x_) points.emplace_back(x[0], x[1], x[2]);
        return points;
    }

private:
    using State = std::vector<std::array<double, 3>>;
    struct Spring {
        int i, j;
        double stiffness, rest;
    };

    State accelerations(const State& x, const State& v) const {
        State a(x.size(), {0, 0, 0});
        for (const Spring& s : springs_) {
            double square = 0.0, approach = 0.0;
            for (int c = 0; c < 3; ++c) {
                square += (x[s.i][c] - x[s.j][c]) * (x[s.i][c] - x[s.j][c]);
                approach += (x[s.i][c] - x[s.j][c]) * (v[s.i][c] - v[s.j][c]);
            }
            const double length = std::sqrt(square);
            const double pull = (s.stiffness * (length - s.rest) + 0.1 * approach / length) / length;
            for (int c = 0; c < 3; ++c) {
                a[s.i][c] -= pull * (x[s.i][c] - x[s.j][c]);
                a[s.j][c] += pull * (x[s.i][c] - x[s.j][c]);
            }
        }
        for (int i = 0; i < side * side; ++i) {
            const int column = i % side, row = i / side;
            const bool held = row == 0 && (column == 0 || column == side - 1);
            const double share = (column % (side - 1) ? 1.0 : 0.5) * (row % (side - 1) ? 1.0 : 0.5);
            const double mass = 0.2 * share / ((side - 1.0) * (side - 1.0));
            for (int c = 0; c < 3; ++c) a[i][c] = held ? 0.0 : a[i][c] / mass - (c == 1 ? 9.81 : 0.0);
        }
        return a;
    }

    State x_, v_;
    std::vector<Spring> springs_;
};

double rms_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(a.size()));
}

/// The sheet at 0.1 s, by the plain code at a step far below its stability limit.
const std::vector<Vec3>& plain_sheet_at_a_tenth() {
    static const std::vector<Vec3> positions = [] {
        PlainSheet sheet;
        for (int n = 0; n < 1000; ++n) sheet.step(1e-4);
        return sheet.positions();
    }();
    return positions;
}

}  // namespace

TEST_CASE("The hanging sheet by RK4 is that of independent code to a nanometre", "[law]") {
    const double same_step =
        largest_difference(percale_sheet({.time_step = 1e-4, .scheme = Scheme::rk4}, 0.1), plain_sheet_at_a_tenth());
    const double half_step =
        largest_difference(percale_sheet({.time_step = 5e-5, .scheme = Scheme::rk4}, 0.1), plain_sheet_at_a_tenth());
    check_law("hanging sheet at 0.1 s, rk4 against independent code: largest distance, m", same_step, 1e-11);
    check_law("hanging sheet at 0.1 s, rk4 with half the step: largest distance, m", half_step, 1e-9);
}

TEST_CASE("The error of backward Euler on the hanging sheet halves with the step", "[law]") {
    std::vector<double> errors;
    for (const double steps_per_second : {240.0, 480.0, 960.0}) {
        const StepSettings settings{.time_step = 1.0 / steps_per_second, .newton_tolerance = 1e-6};
        errors.push_back(rms_difference(percale_sheet(settings, 0.1), plain_sheet_at_a_tenth()));
    }
    std::printf("hanging sheet, backward Euler at 0.1 s: %.3g, %.3g, %.3g m rms at 1/240, 1/480, 1/960 s\n", errors[0], errors[1],
                errors[2]);
    for (int i = 0; i < 2; ++i) {
        check_law_between("hanging sheet, backward Euler: error over that of half the step, " + std::to_string(i + 1),
                          errors[i] / errors[i + 1], 1.7, 2.3);
    }
}

TEST_CASE("The hanging sheet by backward Euler at 1/60 s keeps every strain below 12 % for two seconds") {
    double strain = 0.0;
    const std::vector<Vec3> positions = percale_sheet({.measure = StepMeasures::all}, 2.0, &strain);
    std::printf("hanging sheet, backward Euler at 1/60 s for 2 s: largest strain %.2f %%\n", 100.0 * strain);
    CHECK(strain < 0.12);
    CHECK(strain > 0.02);  // it does hang from two corners
    for (const Vec3& x : positions) CHECK(x.y() > -1.3);
}

}  // namespace percale::test::reference_sheet_test
