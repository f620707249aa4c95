#include "measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "forces/gravity.h"
#include "ledger.h"
#include "shape_loss.h"
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
    const ClothState& state = world.state;
    StepEnergy energy;
    energy.kinetic = 0.5 * sum_terms(0, world.model.vertex_count(),
                                     [&](int i) { return world.model.mass[i] * square_at(state.velocities, i); });
    if (with_gravity) energy.gravity = gravity_energy(world.model.mass, world.settings.gravity, state.positions);
    energy.elastic = shape_energy(world.model, state.positions);
    energy.contact = world.contact_energy;
    return energy;
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void leave_out_ledger(StepEnergy& energy) {
    for (const auto entry : ledger_entries) energy.*entry = unknown;
}

void leave_out(StepReport& report) {
    report.energy = {.kinetic = unknown, .gravity = unknown, .elastic = unknown, .contact = unknown, .work = unknown};
    leave_out_ledger(report.energy);
    report.largest_strain = report.largest_speed = unknown;
}

}  // namespace

StepEnergy current_energy(const World& world) { return energy_of(world, true); }

void measure_kept(World& world) {
    StepReport& report = world.report;
    report.smallest_distance = std::numeric_limits<double>::infinity();
    if (!world.plan.measures) return leave_out(report);
    report.energy = energy_of(world, world.plan.gravity_energy);
    if (!world.plan.ledger) leave_out_ledger(report.energy);
    report.largest_strain = largest_strain(world.model.springs, world.state.positions);
    report.largest_speed = largest_speed(world);
}

namespace {

/// State measures, and the flows that the solve has counted.
void measure_state(World& world) {
    const StepEnergy flows = world.report.energy;
    const ContactTerms& contact = world.newton.current.forces.contact;
    world.contact_energy = world.plan.contacts ? contact.energy + grip_energy(contact.touches) : 0.0;
    measure_kept(world);
    if (world.plan.measures) world.report.energy.work = flows.work;
    if (!world.plan.ledger) return;
    for (const auto entry : ledger_entries) world.report.energy.*entry = flows.*entry;
    close_ledger(world);
}

}  // namespace

void measure(World& world) {
    StageTimer timer(world.report.stages.measure);
    StepReport& report = world.report;
    measure_state(world);
    if (!world.plan.contacts) return;
    const ContactRows& rows = world.newton.current.forces.rows;
    const std::vector<ContactBlock>& blocks = world.newton.current.forces.contact.blocks;
    report.contacts =
        static_cast<int>(std::count_if(blocks.begin(), blocks.end(), [](const ContactBlock& block) { return block.row >= 0; }));
    report.contact_hash = hash_of(rows);
    report.smallest_distance = world.detector->smallest_distance();
}

}  // namespace percale
