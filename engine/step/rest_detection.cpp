#include "rest_detection.h"

#include <algorithm>

#include "world.h"

namespace percale {
namespace {

constexpr double still_time = 0.5;     // s
constexpr double still_share = 0.002;  // of the thickness
constexpr double weight_share = 0.02;  // of a vertex's weight

bool is_still(const World& world, const ClothRange& cloth, double bound) {
    for (int i = cloth.first; i < cloth.first + cloth.count; ++i) {
        if ((world.state.positions.at(i) - world.rest.anchor.at(i)).squaredNorm() > bound * bound) return false;
    }
    return true;
}

bool is_balanced(const World& world, const ClothRange& cloth, double bound) {
    // A force m a moves a vertex by a t^2/2.
    const double least = 2.0 * bound / (still_time * still_time);
    const double acceleration = std::max(weight_share * world.settings.gravity.norm(), least);
    const Vectors& forces = world.newton.current.forces.total;
    for (int i = cloth.first; i < cloth.first + cloth.count; ++i) {
        if (world.script.free[i] > 0.0 && forces.at(i).norm() > acceleration * world.model.mass[i]) return false;
    }
    return true;
}

void update_cloth(World& world, const ClothRange& cloth, ClothRest& rest) {
    const double bound = still_share * world.model.thickness[cloth.first];
    if (is_still(world, cloth, bound)) {
        rest.still_time += world.settings.time_step;
    } else {
        rest.still_time = 0.0;
        for (int i = cloth.first; i < cloth.first + cloth.count; ++i) world.rest.anchor.set(i, world.state.positions.at(i));
    }
    rest.asleep = rest.still_time >= still_time && is_balanced(world, cloth, bound);
}

void fall_asleep(World& world) {
    RestState& rest = world.rest;
    rest.asleep = true;
    world.state.velocities.resize(world.model.vertex_count());
    // Zero, or still NaN where it is not measured.
    world.report.largest_speed *= 0.0;
    world.report.energy.dissipated_integrator += world.report.energy.kinetic;
    world.report.energy.kinetic *= 0.0;
    const StepReport& last = world.report;
    rest.figures = {};
    rest.figures.slept = true;
    rest.figures.dt = rest.figures.smallest_dt = rest.figures.largest_dt = last.dt;
    rest.figures.sleeping_cloths = last.sleeping_cloths;
    rest.figures.contacts = last.contacts;
    rest.figures.contact_hash = last.contact_hash;
    rest.figures.smallest_distance = last.smallest_distance;
    rest.figures.contact_stiffness = last.contact_stiffness;
    rest.figures.largest_strain = last.largest_strain;
    rest.figures.largest_speed = last.largest_speed;
    rest.figures.energy = last.energy;
    rest.figures.energy.work *= 0.0;
    for (const auto entry : ledger_entries) rest.figures.energy.*entry *= 0.0;
}

}  // namespace

void update_rest(World& world) {
    RestState& rest = world.rest;
    if (!world.plan.rest) return;
    if (world.plan.pins_move || world.plan.obstacles_move || world.report.status != StepStatus::ok) return wake(rest);
    if (rest.cloths.size() != world.model.cloths.size()) {
        rest.cloths.assign(world.model.cloths.size(), {});
        rest.anchor = world.state.positions;
        return;
    }
    for (std::size_t c = 0; c < rest.cloths.size(); ++c) {
        update_cloth(world, world.model.cloths[c], rest.cloths[c]);
        world.report.sleeping_cloths += rest.cloths[c].asleep;
    }
    if (world.report.sleeping_cloths == static_cast<int>(rest.cloths.size())) fall_asleep(world);
}

void wake(RestState& rest) {
    rest.cloths.clear();
    rest.asleep = false;
}

StepReport sleep_through(World& world) {
    world.report = world.rest.figures;
    world.report.time = world.time;
    return world.report;
}

}  // namespace percale
