#include "spring_loss.h"

#include "springs.h"

namespace percale {
namespace {

/// m. Shorter springs have no direction and no force; the kernels hold the square (kernels/spring_kernel.inl). If the two
/// differ, the ledger counts forces that did not act.
constexpr double min_spring_length = 1e-18;

Vec3 between(const SpringNetwork& network, const Vec3Arrays& x, int spring) {
    return x.at(network.first[spring]) - x.at(network.second[spring]);
}

Vec3 direction(const Vec3& x) {
    const double length = x.norm();
    return length < min_spring_length ? Vec3(Vec3::Zero()) : Vec3(x / length);
}

}  // namespace

SpringLoss spring_loss(const SpringNetwork& network, const SpringMove& move) {
    SpringLoss loss;
    const std::span<const double> rest = rest_lengths(network, move.rest_length);
    for (int k = 0; k < network.size(); ++k) {
        const Vec3 start = between(network, move.start, k), end = between(network, move.end, k);
        const Vec3 x = between(network, move.positions, k), d = direction(x);
        const double l_start = start.norm(), l_end = end.norm(), l0 = rest[k], apart = d.dot(end - start);
        const double rate =
            move.form == DampingForm::length_rate ? (l_end - l_start) / move.dt : d.dot(between(network, move.velocities, k));
        loss.material += move.dt * network.damping[k] * rate * rate;
        // U(q_end) - U(q_start) = ks (l_end - l_start) ((l_end + l_start)/2 - l0)
        loss.integrator += network.damping[k] * rate * (apart - move.dt * rate);
        loss.integrator += network.stiffness[k] * ((x.norm() - l0) * apart - (l_end - l_start) * (0.5 * (l_end + l_start) - l0));
    }
    return loss;
}

}  // namespace percale
