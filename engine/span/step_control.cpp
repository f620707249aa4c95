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
    const double allowance = tolerance * std::max(attempt.length, attempt.contact ? least_contact_allowance : 0.0);
    const double share = std::max(attempt.error / allowance, least_error_share), order = attempt.order;
    const bool good = attempt.error <= allowance + control.left;
    if (!good && attempt.length > shortest_step) {
        const double factor =
            std::isfinite(share) ? rejected_safety * std::pow(wanted_error_share / share, 1.0 / order) : least_length_factor;
        control.length = std::max(shortest_step, attempt.length * std::clamp(factor, least_length_factor, most_rejected_factor));
        control.just_rejected = true;
        return false;
    }
    control.left = std::clamp(control.left + tolerance * attempt.length - attempt.error, 0.0, most_left_allowance * tolerance);
    double factor = std::pow(wanted_error_share / share, control_integral / order);
    if (control.share_before > 0.0) factor *= std::pow(control.share_before / wanted_error_share, control_proportional / order);
    const double longest = control.just_rejected ? 1.0 : most_length_factor;
    control.length = std::max(shortest_step, attempt.length * std::clamp(factor, least_length_factor, longest));
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
