#include "step_control.h"

#include <algorithm>
#include <cmath>

#include "plan/scene.h"
#include "tolerances.h"

namespace percale {
namespace {

/// s. The first step is short, as a start may release something stiff.
constexpr double first_adaptive_step = 5e-5;

/// Fraction of the allowance that the next step aims at. Towards 1: more rejected steps. Smaller: more steps.
constexpr double wanted_error_ratio = 0.5;

/// The smallest ratio of error to allowance that counts, so that the length stays bounded after a step without error.
constexpr double min_error_ratio = 1e-6;

/// s of allowance: the maximum that can be left over, and the minimum of a step in contact. Larger: errors exceed the tolerance
/// for as long. 0 in contact: impacts, whose error goes with dt, force the shortest step.
constexpr double max_left_allowance = 0.02, min_contact_allowance = 0.005;

/// Exponents of the PI controller (Soderlind 2002), over the order. Larger: lengths swing to and fro.
constexpr double control_proportional = 0.4, control_integral = 0.7;

/// Factors from one length to the next: the minimum and the maximum; the maximum after a rejected step, and a factor of safety.
constexpr double min_length_factor = 0.2, max_length_factor = 2.0, max_rejected_factor = 0.5, rejected_safety = 0.9;

/// Fraction of a count of steps. The remaining time is divided into one step less if the steps are longer by only this. 0:
/// rounding adds a step of no length.
constexpr double step_count_rounding = 1e-9;

}  // namespace

double next_length(const StepControl& control, double remaining) {
    const double length = control.length > 0.0 ? control.length : first_adaptive_step;
    return remaining / std::max(1.0, std::ceil(remaining / length * (1.0 - step_count_rounding)));
}

bool accept_attempt(const StepAttempt& attempt, double tolerance, StepControl& control) {
    const double allowance = tolerance * std::max(attempt.length, attempt.contact ? min_contact_allowance : 0.0);
    const double ratio = std::max(attempt.error / allowance, min_error_ratio), order = attempt.order;
    const bool good = attempt.error <= allowance + control.left;
    if (!good && attempt.length > shortest_step) {
        const double factor =
            std::isfinite(ratio) ? rejected_safety * std::pow(wanted_error_ratio / ratio, 1.0 / order) : min_length_factor;
        control.length = std::max(shortest_step, attempt.length * std::clamp(factor, min_length_factor, max_rejected_factor));
        control.just_rejected = true;
        return false;
    }
    control.left = std::clamp(control.left + tolerance * attempt.length - attempt.error, 0.0, max_left_allowance * tolerance);
    double factor = std::pow(wanted_error_ratio / ratio, control_integral / order);
    if (control.error_ratio_before > 0.0)
        factor *= std::pow(control.error_ratio_before / wanted_error_ratio, control_proportional / order);
    const double longest = control.just_rejected ? 1.0 : max_length_factor;
    control.length = std::max(shortest_step, attempt.length * std::clamp(factor, min_length_factor, longest));
    control.error_ratio_before = ratio;
    control.just_rejected = false;
    control.missed = !good;
    return true;
}

double mean_size(const StepScene& scene, const Vec3Arrays& error) {
    double largest = 0.0;
    for (const ClothRange& cloth : scene.model.cloths) {
        const double sum = sum_terms(cloth.first, cloth.count,
                                     [&](int i) { return scene.script.free[i] * scene.model.mass[i] * square_at(error, i); });
        largest = std::max(largest, sum / cloth.mass);
    }
    return std::sqrt(largest);
}

}  // namespace percale
