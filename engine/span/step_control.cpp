#include "step_control.h"

#include <algorithm>
#include <cmath>

#include "plan/scene.h"

namespace percale {
namespace {

constexpr double first_length = 5e-5;   // s, short: a start may let go of something stiff
constexpr double wanted_share = 0.5;    // of the allowance
constexpr double most_left = 0.02;      // s of allowance that can be left over
constexpr double contact_left = 0.005;  // s of allowance that a step in contact has at least
constexpr double proportional = 0.4, integral = 0.7;
constexpr double least_factor = 0.2, most_factor = 2.0;

}  // namespace

double next_length(const StepControl& control, double remaining) {
    const double length = control.length > 0.0 ? control.length : first_length;
    return remaining / std::max(1.0, std::ceil(remaining / length * (1.0 - 1e-9)));
}

bool accept_attempt(const StepAttempt& attempt, double tolerance, StepControl& control) {
    const double allowance = tolerance * std::max(attempt.length, attempt.contact ? contact_left : 0.0);
    const double share = std::max(attempt.error / allowance, 1e-6), order = attempt.order;
    const bool good = attempt.error <= allowance + control.left;
    if (!good && attempt.length > shortest_step) {
        const double factor = std::isfinite(share) ? 0.9 * std::pow(wanted_share / share, 1.0 / order) : least_factor;
        control.length = std::max(shortest_step, attempt.length * std::clamp(factor, least_factor, 0.5));
        control.just_rejected = true;
        return false;
    }
    control.left = std::clamp(control.left + tolerance * attempt.length - attempt.error, 0.0, most_left * tolerance);
    double factor = std::pow(wanted_share / share, integral / order);
    if (control.share_before > 0.0) factor *= std::pow(control.share_before / wanted_share, proportional / order);
    const double longest = control.just_rejected ? 1.0 : most_factor;
    control.length = std::max(shortest_step, attempt.length * std::clamp(factor, least_factor, longest));
    control.share_before = share;
    control.just_rejected = false;
    control.missed = !good;
    return true;
}

double mean_size(const StepScene& scene, const Vectors& error) {
    double largest = 0.0;
    for (const ClothRange& cloth : scene.model.cloths) {
        const double sum = sum_terms(cloth.first, cloth.count,
                                     [&](int i) { return scene.script.free[i] * scene.model.mass[i] * square_at(error, i); });
        largest = std::max(largest, sum / cloth.mass);
    }
    return std::sqrt(largest);
}

}  // namespace percale
