#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/pattern/panel_curve.h"
#include "scenes/pattern/pattern_toml.h"
#include "tests/support/random.h"

namespace percale::scenes::test {

using percale::test::Random;

/// A skirt of two panels, the waist of the back gathered; sides, cm.
inline constexpr const char* skirt_text = R"(
unit = "cm"
[[panel]]
name = "front"
points = [[-20, 0], [20, 0], [15, 40], [-15, 40]]
curves = [{ edge = 2, bulge = -2.0 }]
at = [0, 60, 15]
[[panel]]
name = "back"
points = [[-20, 0], [20, 0], [15, 40], [-15, 40]]
at = [0, 60, -15]
turn = [0, 180, 0]
[[seam]]
name = "left"
sides = [["front.1"], ["back.3"]]
[[seam]]
name = "right"
sides = [["front.3"], ["back.1"]]
)";

inline double area_of(const std::vector<Point2>& outline) {
    double twice = 0.0;
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const Point2 &a = outline[k], &b = outline[(k + 1) % outline.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * twice;
}

/// A round outline with bumps, counter-clockwise, its points about `edge_length` apart: r = size (1 + bumps cos(n a)).
inline std::vector<Point2> bumpy_outline(Random& random, double size, double edge_length) {
    const double bump = random.number(0.0, 0.25), stretch = random.number(0.5, 2.0);
    const int bumps = 2 + random.index(3);
    const auto at = [&](double a) {
        const double r = size * (1.0 + bump * std::cos(bumps * a));
        return Point2(r * std::cos(a), stretch * r * std::sin(a));
    };
    constexpr int fine = 20000;
    std::vector<double> length = {0.0};
    for (int k = 1; k <= fine; ++k) {
        const double step = 2.0 * std::numbers::pi / fine;
        length.push_back(length.back() + (at(k * step) - at((k - 1) * step)).norm());
    }
    const int count = static_cast<int>(std::lround(length.back() / edge_length));
    std::vector<Point2> outline;
    for (int k = 0, at_fine = 0; k < count; ++k) {
        while (length[at_fine] < length.back() * k / count) ++at_fine;
        outline.push_back(at(2.0 * std::numbers::pi * at_fine / fine));
    }
    return outline;
}

/// A straight-sided outline whose sides are divided into pieces of about that length.
inline std::vector<Point2> divided(const std::vector<Point2>& corners, double edge_length) {
    std::vector<Point2> outline;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Point2 &a = corners[k], &b = corners[(k + 1) % corners.size()];
        const int count = std::max(1, static_cast<int>(std::lround((b - a).norm() / edge_length)));
        for (int n = 0; n < count; ++n) outline.push_back(a + static_cast<double>(n) / count * (b - a));
    }
    return outline;
}

}  // namespace percale::scenes::test
