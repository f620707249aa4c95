#include "percale/stability.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "schemes.h"

namespace percale {
namespace {

/// Shorter stable steps count as none. The second number is the factor from one trial to the next. Larger: a gap of the stable
/// region may be stepped over. Cost.
constexpr double min_stable_step = 1e-6, stable_step_march = 1.02;

/// Fraction of |R| that rounding adds to 1. 0: stable steps are found unstable.
constexpr double growth_rounding = 1e-12;

/// Where the search ends: no Taylor polynomial of degree 4 or less is stable there. The second number counts the halvings of the
/// interval in which stability is lost; 53 exhaust a double.
constexpr double beyond_stable_step = 4.0;
constexpr int stable_step_halvings = 60;

using Complex = std::complex<double>;

/// 1 + z + ... + z^degree/degree!
Complex taylor(int degree, Complex z) {
    Complex sum = 1.0, term = 1.0;
    for (int k = 1; k <= degree; ++k) {
        term *= z / static_cast<double>(k);
        sum += term;
    }
    return sum;
}

/// The eigenvalue of larger size.
Complex eigenvalue(const Oscillator& oscillator) {
    const Complex root = std::sqrt(Complex(oscillator.damping * oscillator.damping - 4.0 * oscillator.square));
    return 0.5 * (-oscillator.damping - root);
}

/// Where the ray along lambda leaves |R| <= 1 for the first time.
double taylor_limit(int degree, const Oscillator& oscillator) {
    const Complex lambda = eigenvalue(oscillator);
    const double size = std::abs(lambda);
    const auto stable = [&](double dt) { return std::abs(taylor(degree, lambda * dt)) <= 1.0 + growth_rounding; };
    double inside = min_stable_step / size, outside = inside;
    while (stable(outside) && outside * size < beyond_stable_step) {
        inside = outside;
        outside *= stable_step_march;
    }
    if (outside == inside) return 0.0;
    for (int k = 0; k < stable_step_halvings; ++k) {
        const double middle = 0.5 * (inside + outside);
        (stable(middle) ? inside : outside) = middle;
    }
    return inside;
}

}  // namespace

double longest_stable_step(Scheme scheme, const Oscillator& oscillator) {
    const auto& [square, damping] = oscillator;
    switch (scheme) {
        case Scheme::forward_euler:
            return damping * damping < 4.0 * square ? damping / square : 2.0 / std::abs(eigenvalue(oscillator));
        case Scheme::symplectic_euler:
            return (std::sqrt(damping * damping + 4.0 * square) - damping) / square;
        case Scheme::midpoint:
            return damping > 0.0 ? taylor_limit(2, oscillator) : 0.0;
        case Scheme::rk4:
            return taylor_limit(4, oscillator);
        default:
            return std::numeric_limits<double>::infinity();
    }
}

}  // namespace percale
