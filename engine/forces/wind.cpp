#include "wind.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace percale {
namespace {

/// Multiple of the displacement by which derivatives are checked (settings.check_derivatives): how near the kinks of the drag, as
/// a distance in dt, a vertex is left out. Smaller: right forces are found wrong. Larger: wrong ones pass.
constexpr double wind_kink_reaches = 1e3;

/// The parts of a triangle's area that its corners carry. Grids: a cell gives each of its corners a quarter, so the corner off
/// the diagonal has half of its triangle.
std::array<double, 3> corner_shares(const ClothRange& cloth, const Triangle& t) {
    if (!cloth.grid) return {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
    const auto column = [&](int k) { return (t[k] - cloth.first) % cloth.columns; };
    const auto row = [&](int k) { return (t[k] - cloth.first) / cloth.columns; };
    std::array<double, 3> weights = {0.25, 0.25, 0.25};
    for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        if (column(a) != column(b) && row(a) != row(b)) weights[k] = 0.5;
    }
    return weights;
}

/// Drag on a corner: force, minus its derivative by the velocity, and the potential of which it is minus the derivative.
struct CornerDrag {
    Vec3 force;
    SymmetricBlock damping = {};  // N s/m
    double potential;             // W
};

/// `normal_factor` and `tangential_factor`: 1/2 rho A C, kg/m.
CornerDrag corner_drag(const Vec3& n, const Vec3& u, double normal_factor, double tangential_factor) {
    const double across = n.dot(u);
    const Vec3 along = u - across * n;
    const double speed = along.norm();
    const double normal_damping = normal_factor * std::abs(across), tangential_damping = tangential_factor * speed;
    CornerDrag drag{.force = -normal_damping * across * n - tangential_damping * along,
                    .potential = (normal_damping * across * across + tangential_damping * speed * speed) / 3.0};
    add_normal_block(drag.damping, 2.0 * normal_damping, n);
    if (speed > 0.0) {
        add_tangent_block(drag.damping, tangential_damping, n, Vec3::Zero());
        add_normal_block(drag.damping, tangential_damping, along / speed);
    }
    return drag;
}

/// Adds the drag of one cloth.
class ClothDrag {
public:
    ClothDrag(const ClothRange& cloth, const StepWind& wind, const Vec3Arrays& velocities, double dt)
        : cloth_(cloth), wind_(wind), velocities_(velocities), dt_(dt) {}

    /// `blocks`: of each vertex of the model; empty: not wanted.
    void add(const Triangle& t, const WindTriangle& placed, Vec3Arrays& forces, std::span<CoupledBlock> blocks,
             WindPower& sum) const {
        const std::array<double, 3> weights = corner_shares(cloth_, t);
        for (int k = 0; k < 3; ++k) {
            const double factor = 0.5 * wind_.density * placed.area * weights[k];
            const Vec3 v = velocities_.at(t[k]);
            const CornerDrag drag = corner_drag(placed.normal, v - wind_.velocity, factor * cloth_.fabric.drag_normal,
                                                factor * cloth_.fabric.drag_tangential);
            forces.add(t[k], drag.force);
            sum.power += drag.force.dot(v);
            sum.potential += dt_ * drag.potential;
            for (int entry = 0; entry < 6 && !blocks.empty(); ++entry) blocks[t[k]].k[entry] += dt_ * drag.damping[entry];
        }
    }

private:
    const ClothRange& cloth_;
    const StepWind& wind_;
    const Vec3Arrays& velocities_;
    double dt_;
};

class Wind final : public ForceTerm {
public:
    std::string_view name() const override { return "wind"; }
    bool acts(const ForceInput& input) const override { return input.wind && input.wind->blows; }
    double add(const ForceInput& input, Forces& forces) const override {
        const WindPower sum = add_wind(*input.model, *input.wind, *input.velocities, input.dt, forces.total,
                                       input.with_matrix ? &forces.blocks.coupled : nullptr);
        forces.wind_power = sum.power;
        return sum.potential;
    }
    bool is_internal() const override { return false; }
    bool may_be_below() const override { return true; }

    /// The drag has a kink where the air does not move along a triangle, or not across it.
    void mark_inexact(const ForceInput& input, const Forces&, double reach, std::vector<bool>& exact) const override {
        const double slow = wind_kink_reaches * reach / input.dt;
        for (std::size_t k = 0; k < input.model->triangles.size(); ++k) {
            const Vec3& n = input.wind->triangles[k].normal;
            for (const int vertex : input.model->triangles[k]) {
                const Vec3 u = input.velocities->at(vertex) - input.wind->velocity;
                const double across = n.dot(u);
                if (std::abs(across) < slow || (u - across * n).norm() < slow) exact[vertex] = false;
            }
        }
    }

    void add_skips(const ForceFacts& facts, std::vector<Skip>& skipped) const override {
        if (!facts.wind) skipped.push_back({"drag of the air", "no wind was ever set"});
    }
};

}  // namespace

const ForceTerm& wind_term() {
    static const Wind term;
    return term;
}

void set_step_wind(const ClothModel& model, const Vec3& velocity, double density, const Vec3Arrays& positions, StepWind& wind) {
    wind.blows = true;
    wind.velocity = velocity;
    wind.density = density;
    wind.triangles.resize(model.triangles.size());
    for (std::size_t k = 0; k < model.triangles.size(); ++k) {
        const auto& [a, b, c] = model.triangles[k];
        const Vec3 cross = (positions.at(b) - positions.at(a)).cross(positions.at(c) - positions.at(a));
        const double size = cross.norm();
        wind.triangles[k] = {size > 0.0 ? Vec3(cross / size) : Vec3(Vec3::Zero()), 0.5 * size};
    }
}

WindPower add_wind(const ClothModel& model, const StepWind& wind, const Vec3Arrays& velocities, double dt, Vec3Arrays& forces,
                   std::vector<CoupledBlock>* blocks) {
    std::span<CoupledBlock> own;
    if (blocks) {
        for (int i = 0; i < model.vertex_count(); ++i)
            blocks->push_back({.vertex = {i, -1, -1, -1}, .weight = {1.0, 0.0, 0.0, 0.0}, .k = {}});
        own = std::span(*blocks).last(model.mass.size());
    }
    WindPower sum;
    std::size_t k = 0;
    for (const ClothRange& cloth : model.cloths) {
        const ClothDrag drag(cloth, wind, velocities, dt);
        for (; k < model.triangles.size() && model.triangles[k][0] < cloth.first + cloth.count; ++k) {
            drag.add(model.triangles[k], wind.triangles[k], forces, own, sum);
        }
    }
    return sum;
}

}  // namespace percale
