#include "step_control.h"

#include <algorithm>
#include <cmath>

#include "plan/scene.h"
#include "tolerances.h"

namespace percale {

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
