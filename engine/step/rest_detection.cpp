#include "rest_detection.h"

#include <algorithm>

namespace percale {
namespace {

/// s for which cloth has to be still to sleep, and fraction of h that it may move meanwhile. Shorter, larger: slow cloth
/// freezes. Longer, smaller: cloth at rest is solved for ever.
constexpr double rest_time = 0.5, rest_displacement_ratio = 0.002;

/// Fraction of a vertex's weight that forces on it may leave in cloth at rest. Larger: a swing sleeps where it turns.
constexpr double rest_force_ratio = 0.02;

/// One cloth, and how far it may move, m.
struct RestCheck {
    const StepScene& scene;
    const ClothRange& cloth;
    double bound;
};

bool is_still(const RestCheck& check, const Vec3Arrays& positions, const Vec3Arrays& anchor) {
    const auto& [scene, cloth, bound] = check;
    for (int i = cloth.first; i < cloth.first + cloth.count; ++i) {
        if ((positions.at(i) - anchor.at(i)).squaredNorm() > bound * bound) return false;
    }
    return true;
}

/// Judges the balance by the velocity changes of the step: forces at its end include the solver's residual, which on a stiff
/// contact is many times a vertex's weight where it moves nothing.
bool is_balanced(const RestCheck& check, const Vec3Arrays& from, const Vec3Arrays& to) {
    const auto& [scene, cloth, bound] = check;
    // A force m a moves a vertex by a t^2/2.
    const double min = 2.0 * bound / (rest_time * rest_time);
    const double acceleration = std::max(rest_force_ratio * scene.settings.gravity.norm(), min);
    const double change = acceleration * scene.settings.time_step;
    for (int i = cloth.first; i < cloth.first + cloth.count; ++i) {
        if (scene.is_free(i) && (to.at(i) - from.at(i)).squaredNorm() > change * change) return false;
    }
    return true;
}

void update_cloth(const RestCheck& check, const Vec3Arrays& velocities, const ClothState& state, Vec3Arrays& anchor,
                  ClothRest& rest) {
    const auto& [scene, cloth, bound] = check;
    const Vec3Arrays& positions = state.positions;
    if (is_still(check, positions, anchor)) {
        rest.still_time += scene.settings.time_step;
    } else {
        rest.still_time = 0.0;
        for (int i = cloth.first; i < cloth.first + cloth.count; ++i) anchor.set(i, positions.at(i));
    }
    rest.asleep = rest.still_time >= rest_time && is_balanced(check, velocities, state.velocities);
}

void fall_asleep(ClothState& cloth, RestState& rest, StepReport& last) {
    rest.asleep = true;
    for (auto* axis : {&cloth.velocities.x, &cloth.velocities.y, &cloth.velocities.z}) axis->assign(axis->size(), 0.0);
    // The speed is zero, or stays NaN where it is not measured.
    last.largest_speed *= 0.0;
    last.energy.dissipated_integrator += last.energy.kinetic;
    last.energy.kinetic *= 0.0;
    rest.figures = {};
    rest.figures.slept = true;
    rest.figures.dt = rest.figures.smallest_dt = rest.figures.largest_dt = last.dt;
    rest.figures.sleeping_cloths = last.sleeping_cloths;
    rest.figures.contacts = last.contacts;
    rest.figures.contact_hash = last.contact_hash;
    rest.figures.smallest_distance = last.smallest_distance;
    rest.figures.contact_stiffness = last.contact_stiffness;
    rest.figures.pinched = last.pinched;
    rest.figures.yielded = last.yielded;
    rest.figures.largest_strain = last.largest_strain;
    rest.figures.largest_speed = last.largest_speed;
    rest.figures.energy = last.energy;
    rest.figures.energy.work *= 0.0;
    for (const auto entry : ledger_entries) rest.figures.energy.*entry *= 0.0;
}

}  // namespace

void update_rest(const StepScene& scene, const Vec3Arrays& velocities, ClothState& cloth, RestState& rest, StepReport& report) {
    if (!scene.plan.rest) return;
    if (scene.plan.something_moves() || report.status != StepStatus::ok) return wake(rest);
    if (rest.cloths.size() != scene.model.cloths.size()) {
        rest.cloths.assign(scene.model.cloths.size(), {});
        rest.anchor = cloth.positions;
        return;
    }
    for (std::size_t c = 0; c < rest.cloths.size(); ++c) {
        const ClothRange& range = scene.model.cloths[c];
        const std::optional<double>& speed = scene.settings.rest_speed;
        const double bound = speed ? *speed * rest_time : rest_displacement_ratio * scene.model.thickness[range.first];
        const RestCheck check{scene, range, bound};
        update_cloth(check, velocities, cloth, rest.anchor, rest.cloths[c]);
        report.sleeping_cloths += rest.cloths[c].asleep;
    }
    if (report.sleeping_cloths == static_cast<int>(rest.cloths.size())) fall_asleep(cloth, rest, report);
}

void wake(RestState& rest) {
    rest.cloths.clear();
    rest.anchor.resize(0);
    rest.potential.reset();
    rest.asleep = false;
}

StepReport sleep_through(const RestState& rest, double time) {
    StepReport report = rest.figures;
    report.time = time;
    return report;
}

}  // namespace percale
