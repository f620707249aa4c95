#include "contact_stiffness.h"

#include "tolerances.h"

namespace percale {
namespace {

/// Weights of a vertex that would press it to d = 0 if the potential went on as it begins. Smaller: stacks are squashed. Larger:
/// Newton takes longer where layers meet.
constexpr double pressing_weights = 1500.0;

/// Quartic stiffness of contact over the modulus of the cloth times the length of edges over the thickness: what taut cloth
/// presses with grows with that length. Smaller: taut cloth and its layers come close to the body and to each other. Larger:
/// Newton takes longer.
constexpr double stiffness_over_modulus = 4.0;

double in_series(double first, double second) { return first + second > 0.0 ? first * second / (first + second) : 0.0; }

}  // namespace

double contact_gravity(const Vec3& gravity) {
    const double size = gravity.norm();
    return size > 0.0 ? size : standard_gravity;
}

ContactStiffness contact_stiffness(const ContactScale& vertex, double thickness) {
    return {.quadratic = pressing_weights * vertex.weight / thickness,
            .quartic = stiffness_over_modulus * vertex.modulus * vertex.length / thickness};
}

ContactStiffness in_series(const ContactStiffness& first, const ContactStiffness& second) {
    return {in_series(first.quadratic, second.quadratic), in_series(first.quartic, second.quartic)};
}

}  // namespace percale
