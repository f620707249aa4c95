#include "measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "forces/body_force.h"
#include "forces/hinge_force.h"
#include "forces/membrane_force.h"
#include "support/hash.h"
#include "support/stage_timer.h"

namespace percale {
namespace {

std::uint64_t hash_of(const ContactRows& rows) {
    Hash hash;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        for (const int vertex : rows.vertex[row]) hash.add(vertex);
        hash.add(rows.obstacle[row]);
        hash.add(rows.feature[row]);
        hash.add(rows.distance[row]);
    }
    return hash.value();
}

double largest_speed(const World& world) {
    return std::sqrt(largest_term(0, world.model.vertex_count(), [&](int i) { return square_at(world.state.velocities, i); }));
}

}  // namespace

namespace {

StepEnergy energy_of(const World& world, bool with_gravity) {
    StepEnergy energy;
    energy.kinetic = 0.5 * sum_terms(0, world.model.vertex_count(),
                                     [&](int i) { return world.model.mass[i] * square_at(world.state.velocities, i); });
    if (with_gravity) energy.gravity = gravity_energy(world.model.mass, world.settings.gravity, world.state.positions);
    energy.elastic = elastic_energy(world.model.springs, world.state.positions);
    if (!world.model.hinges.all.empty()) energy.elastic += hinge_energy(world.model.hinges, world.state.positions);
    if (!world.model.membrane.empty()) energy.elastic += membrane_energy(world.model.membrane, world.state.positions);
    energy.contact = world.contact_energy;
    return energy;
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void leave_out(StepReport& report) {
    report.energy = {.kinetic = unknown, .gravity = unknown, .elastic = unknown, .contact = unknown, .work = unknown};
    report.largest_strain = report.largest_speed = unknown;
}

}  // namespace

StepEnergy current_energy(const World& world) { return energy_of(world, true); }

void measure_kept(World& world) {
    StepReport& report = world.report;
    report.smallest_distance = std::numeric_limits<double>::infinity();
    if (!world.plan.measures) return leave_out(report);
    report.energy = energy_of(world, world.plan.gravity_energy);
    report.largest_strain = largest_strain(world.model.springs, world.state.positions);
    report.largest_speed = largest_speed(world);
}

void measure(World& world) {
    StageTimer timer(world.report.stages.measure);
    StepReport& report = world.report;
    const double work = report.energy.work;
    world.contact_energy = world.plan.contacts ? world.newton.current.forces.contact.energy : 0.0;
    measure_kept(world);
    if (world.plan.measures) report.energy.work = work;
    if (!world.plan.contacts) return;
    const ContactRows& rows = world.newton.current.forces.rows;
    const std::vector<ContactBlock>& blocks = world.newton.current.forces.contact.blocks;
    report.contacts =
        static_cast<int>(std::count_if(blocks.begin(), blocks.end(), [](const ContactBlock& block) { return block.row >= 0; }));
    report.contact_hash = hash_of(rows);
    report.smallest_distance = world.detector->smallest_distance();
}

}  // namespace percale
