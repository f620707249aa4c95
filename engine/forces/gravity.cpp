#include "gravity.h"

namespace percale {

void set_gravity_forces(std::span<const double> mass, const Vec3& gravity, Vectors& forces) {
    const double gx = gravity.x(), gy = gravity.y(), gz = gravity.z();
    double *fx = forces.x.data(), *fy = forces.y.data(), *fz = forces.z.data();
    for (std::size_t i = 0; i < mass.size(); ++i) {
        fx[i] = mass[i] * gx;
        fy[i] = mass[i] * gy;
        fz[i] = mass[i] * gz;
    }
}

double gravity_energy(std::span<const double> mass, const Vec3& gravity, const Vectors& positions) {
    const double gx = gravity.x(), gy = gravity.y(), gz = gravity.z();
    const double *m = mass.data(), *x = positions.x.data(), *y = positions.y.data(), *z = positions.z.data();
    return -sum_terms(0, static_cast<int>(mass.size()), [=](int i) { return m[i] * (gx * x[i] + gy * y[i] + gz * z[i]); });
}

}  // namespace percale
