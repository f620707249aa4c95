#include "body_force.h"

namespace percale {

void set_gravity_forces(std::span<const double> mass, const Vec3& gravity, Vectors& forces) {
    for (std::size_t i = 0; i < mass.size(); ++i) forces.set(static_cast<int>(i), mass[i] * gravity);
}

double gravity_energy(std::span<const double> mass, const Vec3& gravity, const Vectors& positions) {
    double energy = 0.0;
    for (std::size_t i = 0; i < mass.size(); ++i) {
        energy -= mass[i] * (gravity.x() * positions.x[i] + gravity.y() * positions.y[i] + gravity.z() * positions.z[i]);
    }
    return energy;
}

}  // namespace percale
