#include "hinge_bending.h"

#include <cmath>
#include <numbers>

namespace percale {
namespace {

/// Square of the sine between an edge and its neighbour at one vertex. A narrower triangle has no direction any more, and its
/// hinge no angle. 0: a division by 0.
constexpr double min_hinge_sine_square = 1e-28;

Vec3 bent(const Hinge& hinge, const Vec3Arrays& x) {
    Vec3 u = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
        if (hinge.vertex[k] >= 0) u += hinge.weight[k] * x.at(hinge.vertex[k]);
    }
    return u;
}

/// A hinge in space: e = x1 - x0, n1 = e x (x2 - x0), n2 = (x3 - x0) x e.
struct OpenHinge {
    Vec3 edge, first_arm, second_arm, first_normal, second_normal;

    OpenHinge(const Hinge& hinge, const Vec3Arrays& x)
        : edge(x.at(hinge.vertex[1]) - x.at(hinge.vertex[0])),
          first_arm(x.at(hinge.vertex[2]) - x.at(hinge.vertex[0])),
          second_arm(x.at(hinge.vertex[3]) - x.at(hinge.vertex[0])),
          first_normal(edge.cross(first_arm)),
          second_normal(second_arm.cross(edge)) {}

    bool has_angle() const {
        const double min = min_hinge_sine_square * edge.squaredNorm();
        return first_normal.squaredNorm() > min * first_arm.squaredNorm() &&
               second_normal.squaredNorm() > min * second_arm.squaredNorm();
    }

    /// theta - rest angle, along the shorter arc; 0 where a triangle has no area.
    double opened(double rest_angle) const {
        if (!has_angle()) return 0.0;
        const double sine = first_normal.cross(second_normal).dot(edge.normalized());
        return std::remainder(std::atan2(sine, first_normal.dot(second_normal)) - rest_angle, 2.0 * std::numbers::pi);
    }

    /// Gradients of theta by the four vertices: -n/h at an opposite vertex (n unit, h its height over the edge), distributed to
    /// the ends of the edge as the foot of the height divides it.
    std::array<Vec3, 4> gradient() const {
        if (!has_angle()) return {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        const double length = edge.norm();
        const Vec3 first = length / first_normal.squaredNorm() * first_normal;
        const Vec3 second = length / second_normal.squaredNorm() * second_normal;
        const double first_foot = edge.dot(first_arm) / edge.squaredNorm(),
                     second_foot = edge.dot(second_arm) / edge.squaredNorm();
        return {(1.0 - first_foot) * first + (1.0 - second_foot) * second, first_foot * first + second_foot * second, -first,
                -second};
    }
};

double energy_of(const Hinge& hinge, const Vec3Arrays& x) {
    const double opened = OpenHinge(hinge, x).opened(hinge.rest_angle);
    return 0.5 * hinge.clamp * hinge.stiffness * opened * opened;
}

double flat_energy(const Hinge& hinge, const Vec3Arrays& x) {
    return 0.5 * hinge.clamp * hinge.stiffness * bent(hinge, x).squaredNorm();
}

class HingeBending final : public ForceTerm {
public:
    std::string_view name() const override { return "hinges"; }
    bool acts(const ForceInput& input) const override { return !input.model->hinges.all.empty(); }
    double add(const ForceInput& input, Forces& forces) const override {
        return add_curved_hinges(input.model->hinges, *input.positions, forces.total);
    }
    double StepEnergy::*entry() const override { return &StepEnergy::elastic; }
    double energy(const StoredInput& input) const override { return hinge_energy(input.model.hinges, input.positions); }
    bool is_in_matrix() const override { return false; }  // the matrix of flat ones is the springs'

    void identify(const ClothModel& model, ListHash& hash) const override {
        for (const Hinge& hinge : model.hinges.all) {
            hash.add(hinge.vertex);
            hash.add(hinge.weight);
            for (const double number : {hinge.stiffness, hinge.rest_angle}) hash.add(number);
        }
    }

    void add_skips(const ForceFacts& facts, std::vector<Skip>& skipped) const override {
        for (const ClothFacts& cloth : facts.cloths) {
            if (cloth.fabric.bend_stiffness.value_or(0.0) == 0.0)
                skipped.push_back({"hinges of " + cloth.name, "bend_stiffness is not set or 0 N m"});
        }
    }
};

}  // namespace

const ForceTerm& hinge_term() {
    static const HingeBending term;
    return term;
}

double hinge_energy(const Hinges& hinges, const Vec3Arrays& positions) {
    return sum_terms(0, static_cast<int>(hinges.all.size()), [&](int k) {
        const Hinge& hinge = hinges.all[k];
        return hinge.rest_angle == 0.0 ? flat_energy(hinge, positions) : energy_of(hinge, positions);
    });
}

double add_curved_hinges(const Hinges& hinges, const Vec3Arrays& positions, Vec3Arrays& forces) {
    double change = 0.0;
    for (const int index : hinges.curved) {
        const Hinge& hinge = hinges.all[index];
        const OpenHinge open(hinge, positions);
        const double stiffness = hinge.clamp * hinge.stiffness, opened = open.opened(hinge.rest_angle);
        const Vec3 u = bent(hinge, positions);
        const std::array<Vec3, 4> gradient = open.gradient();
        for (int k = 0; k < 4; ++k) {
            forces.add(hinge.vertex[k], stiffness * (hinge.weight[k] * u - opened * gradient[k]));
        }
        change += 0.5 * stiffness * (opened * opened - u.squaredNorm());
    }
    return change;
}

}  // namespace percale
