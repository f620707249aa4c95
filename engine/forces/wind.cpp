#include "wind.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace percale {
namespace {

/// The parts of a triangle's area that its corners carry. Grids: a cell gives each of its corners a quarter, so the corner off
/// the diagonal has half of its triangle.
std::array<double, 3> corner_shares(const ClothRange& cloth, const Triangle& t) {
    if (!cloth.grid) return {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
    const auto column = [&](int k) { return (t[k] - cloth.first) % cloth.columns; };
    const auto row = [&](int k) { return (t[k] - cloth.first) / cloth.columns; };
    std::array<double, 3> shares = {0.25, 0.25, 0.25};
    for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        if (column(a) != column(b) && row(a) != row(b)) shares[k] = 0.5;
    }
    return shares;
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
    ClothDrag(const ClothRange& cloth, const StepWind& wind, const Vectors& velocities, double dt)
        : cloth_(cloth), wind_(wind), velocities_(velocities), dt_(dt) {}

    void add(const Triangle& t, const WindTriangle& placed, Vectors& forces, WindTerms& terms) const {
        const std::array<double, 3> shares = corner_shares(cloth_, t);
        for (int k = 0; k < 3; ++k) {
            const double factor = 0.5 * wind_.density * placed.area * shares[k];
            const Vec3 v = velocities_.at(t[k]);
            const CornerDrag drag = corner_drag(placed.normal, v - wind_.velocity, factor * cloth_.fabric.drag_normal,
                                                factor * cloth_.fabric.drag_tangential);
            forces.add(t[k], drag.force);
            terms.power += drag.force.dot(v);
            terms.potential += dt_ * drag.potential;
            for (int entry = 0; entry < 6; ++entry) terms.blocks[t[k]][entry] += dt_ * drag.damping[entry];
        }
    }

private:
    const ClothRange& cloth_;
    const StepWind& wind_;
    const Vectors& velocities_;
    double dt_;
};

}  // namespace

void set_step_wind(const ClothModel& model, const Vec3& velocity, double density, const Vectors& positions, StepWind& wind) {
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

void add_wind(const ClothModel& model, const StepWind& wind, const Vectors& velocities, double dt, Vectors& forces,
              WindTerms& terms) {
    terms.power = terms.potential = 0.0;
    terms.blocks.assign(model.mass.size(), SymmetricBlock{});
    std::size_t k = 0;
    for (const ClothRange& cloth : model.cloths) {
        const ClothDrag drag(cloth, wind, velocities, dt);
        for (; k < model.triangles.size() && model.triangles[k][0] < cloth.first + cloth.count; ++k) {
            drag.add(model.triangles[k], wind.triangles[k], forces, terms);
        }
    }
}

void set_wind_blocks(const WindTerms& terms, ContactTerms& contact) {
    contact.others = terms.blocks.size();
    contact.blocks.resize(contact.others);
    for (std::size_t i = 0; i < contact.others; ++i) {
        contact.blocks[i] = {
            .vertex = {static_cast<int>(i), -1, -1, -1}, .weight = {1.0, 0.0, 0.0, 0.0}, .k = terms.blocks[i], .row = -1};
    }
}

}  // namespace percale
