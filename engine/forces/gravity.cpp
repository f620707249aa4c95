#include "gravity.h"

namespace percale {
namespace {

class Gravity final : public ForceTerm {
public:
    std::string_view name() const override { return "gravity"; }
    bool acts(const ForceInput&) const override { return true; }
    double add(const ForceInput& input, Forces& forces) const override {
        set_gravity_forces(*input.compute, input.model->mass, input.gravity, forces.total);
        return gravity_energy(*input.compute, input.model->mass, input.gravity, *input.positions);
    }
    double StepEnergy::*entry() const override { return &StepEnergy::gravity; }
    double energy(const StoredInput& input) const override {
        return input.gravity == Vec3::Zero() ? 0.0 : gravity_energy(Compute{}, input.model.mass, input.gravity, input.positions);
    }
    bool is_internal() const override { return false; }
    bool is_in_matrix() const override { return false; }
};

}  // namespace

void set_gravity_forces(const Compute& compute, std::span<const double> mass, const Vec3& gravity, Vec3Arrays& forces) {
    for_chunks(compute, forces.slices(), [&](Slices range) {
        const double gx = gravity.x(), gy = gravity.y(), gz = gravity.z();
        double *fx = forces.x.data(), *fy = forces.y.data(), *fz = forces.z.data();
        const std::size_t last = std::min(static_cast<std::size_t>(range.last) * slice_lanes, mass.size());
        for (std::size_t i = static_cast<std::size_t>(range.first) * slice_lanes; i < last; ++i) {
            fx[i] = mass[i] * gx;
            fy[i] = mass[i] * gy;
            fz[i] = mass[i] * gz;
        }
    });
}

double gravity_energy(const Compute& compute, std::span<const double> mass, const Vec3& gravity, const Vec3Arrays& positions) {
    const double gx = gravity.x(), gy = gravity.y(), gz = gravity.z();
    const double *m = mass.data(), *x = positions.x.data(), *y = positions.y.data(), *z = positions.z.data();
    return -sum_terms(compute, 0, static_cast<int>(mass.size()),
                      [=](int i) { return m[i] * (gx * x[i] + gy * y[i] + gz * z[i]); });
}

const ForceTerm& gravity_term() {
    static const Gravity term;
    return term;
}

}  // namespace percale
