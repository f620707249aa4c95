#include "measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "forces/springs.h"
#include "forces/total_force.h"
#include "support/hash.h"
#include "support/stage_timer.h"

namespace percale {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::uint64_t hash_of(const ContactConstraints& constraints) {
    Hash hash;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        for (const int vertex : constraints.vertex[constraint]) hash.add(vertex);
        hash.add(constraints.obstacle[constraint]);
        hash.add(constraints.feature[constraint]);
        hash.add(constraints.distance[constraint]);
    }
    return hash.value();
}

void leave_out_ledger(StepEnergy& energy) {
    for (const auto entry : ledger_entries) energy.*entry = unknown;
}

void set_contacts(const StepScene& scene, const StagePoint& last, StepReport& report) {
    const std::vector<CoupledBlock>& blocks = last.contact.blocks;
    report.contacts = static_cast<int>(
        std::count_if(blocks.begin(), blocks.end(), [](const CoupledBlock& block) { return block.constraint >= 0; }));
    report.contact_hash = hash_of(last.constraints);
    report.smallest_distance = scene.detector->smallest_distance();
}

}  // namespace

StepEnergy energy_of(const StepScene& scene, const StepState& state) {
    const ClothState& cloth = state.cloth;
    const std::vector<double>& mass = scene.model.mass;
    StepEnergy energy;
    energy.kinetic = 0.5 * sum_terms(scene.compute, 0, scene.model.vertex_count(),
                                     [&](int i) { return mass[i] * square_at(cloth.velocities, i); });
    for (const ForceTerm* term : force_terms()) {
        if (!term->entry() || !term->acts({.model = &scene.model})) continue;
        energy.*term->entry() += term->energy({scene.model, cloth.positions, cloth.rest_length, scene.settings.gravity});
    }
    energy.contact = state.contact_energy;
    return energy;
}

double largest_speed(const Vec3Arrays& velocities, int count) {
    return std::sqrt(largest_term(0, count, [&](int i) { return square_at(velocities, i); }));
}

bool all_finite(const Compute& compute, const ClothState& cloth) {
    double sum = 0.0;
    for (const auto* vectors : {&cloth.positions, &cloth.velocities}) {
        for (const auto* axis : {&vectors->x, &vectors->y, &vectors->z}) {
            sum += sum_terms(compute, 0, static_cast<int>(axis->size()), [&](int i) { return 0.0 * (*axis)[i]; });
        }
    }
    return sum == 0.0;
}

StepMeasure::StepMeasure(const StepScene& scene, const StepState& state, double work) : scene_(scene) {
    if (scene.plan.ledger) start_energy_ = energy_of(scene, state).total() - work;
}

void StepMeasure::set_state(const StepState& state, StepReport& report) const {
    report.smallest_distance = std::numeric_limits<double>::infinity();
    if (!scene_.plan.ledger) leave_out_ledger(report.energy);
    if (!scene_.plan.measures) {
        set_stored_energy({.kinetic = unknown, .gravity = unknown, .elastic = unknown, .contact = unknown}, report.energy);
        report.energy.work = report.largest_strain = report.largest_speed = unknown;
        return;
    }
    set_stored_energy(energy_of(scene_, state), report.energy);
    report.largest_strain = largest_strain(scene_.model.springs, state.cloth.positions);
    report.largest_speed = largest_speed(state.cloth.velocities, scene_.model.vertex_count());
}

void StepMeasure::accepted(const StepState& state, Workspace& work, StepReport& report) const {
    StageTimer timer(work.times.measure);
    set_state(state, report);
    if (scene_.plan.contacts) set_contacts(scene_, work.newton.current, report);
    if (!scene_.plan.ledger) return;
    StepEnergy& energy = report.energy;
    energy.imbalance = energy.total() - start_energy_ + energy.dissipated() - energy.residual_work - energy.work;
}

void StepMeasure::kept(const StepState& state, StepReport& report) const {
    report.energy = {};
    set_state(state, report);
}

}  // namespace percale
