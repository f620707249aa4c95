#include "engine/linear/energy_error_estimate.h"

#include <vector>

#include "tests/support/catch.h"

namespace percale::test::energy_error_estimate_test {
namespace {

/// The number of these gains after which a solve stops; 0: never.
int stop_after(int window, const SolveTarget& target, const std::vector<double>& gains) {
    EnergyErrorEstimate record(window);
    for (std::size_t k = 0; k < gains.size(); ++k) {
        record.add(gains[k]);
        if (record.small_enough(target)) return static_cast<int>(k) + 1;
    }
    return 0;
}

std::vector<double> falling(double ratio, int count) {
    std::vector<double> gains = {1.0};
    while (static_cast<int>(gains.size()) < count) gains.push_back(ratio * gains.back());
    return gains;
}

}  // namespace

TEST_CASE("Gains that fall fast end a solve when the last is small against all") {
    // 1 + 0.1 + 0.01 + 0.001: the fourth is below 0.05^2 of the sum.
    CHECK(stop_after(1, {.relative_gain = 0.05}, falling(0.1, 9)) == 4);
    CHECK(stop_after(1, {.absolute_gain = 0.02}, falling(0.1, 9)) == 3);
    CHECK(stop_after(1, {}, falling(0.1, 40)) == 0);
}

TEST_CASE("The error that is left when gains stop a solve is within the target, however slowly they fall") {
    for (const int window : {1, 10}) {
        for (const double ratio : {0.3, 0.7, 0.9, 0.97}) {
            const std::vector<double> gains = falling(ratio, 2000);
            const int stop = stop_after(window, {.relative_gain = 0.05}, gains);
            CAPTURE(window, ratio, stop);
            REQUIRE(stop > 0);
            double sum = 0.0, left = 0.0;
            for (std::size_t k = 0; k < gains.size(); ++k) (static_cast<int>(k) < stop ? sum : left) += gains[k];
            CHECK(left <= 1.6 * 0.05 * 0.05 * sum);
        }
    }
}

TEST_CASE("One small gain among others that fall slowly ends nothing") {
    const std::vector<double> bursts = {100.0, 2.0, 1.7, 1.5, 1.4, 0.01, 1.3, 1.2};
    CHECK(stop_after(1, {.relative_gain = 0.05}, bursts) == 0);
    std::vector<double> and_then = bursts;
    for (const double gain : falling(0.1, 8)) and_then.push_back(gain);
    CHECK(stop_after(1, {.relative_gain = 0.05}, and_then) > static_cast<int>(bursts.size()) + 2);
}

TEST_CASE("Net limits bound the sum of the residuals over their vertices") {
    const std::vector<double> x = {3.0, -3.0, 4.0, 0.0}, y = {0.0, 0.0, 1.5, 1.5}, z = {1.0, -1.0, 0.0, 0.0};
    const auto small = [&](std::vector<NetLimit> limits, double unit) {
        return net_is_small<double>(limits, {x.data(), y.data(), z.data()}, unit);
    };
    CHECK(small({}, 1.0));
    CHECK(small({{0, 2, 0.0}}, 1.0));
    CHECK(small({{2, 2, 5.0}}, 1.0));
    CHECK_FALSE(small({{2, 2, 4.99}}, 1.0));
    CHECK_FALSE(small({{2, 2, 5.0}}, 1.01));
    CHECK_FALSE(small({{0, 2, 1.0}, {2, 2, 4.0}}, 1.0));
}

TEST_CASE("With fewer gains than a window there is no estimate") {
    CHECK(stop_after(10, {.absolute_gain = 1e9}, falling(0.5, 30)) == 10);
}

}  // namespace percale::test::energy_error_estimate_test
