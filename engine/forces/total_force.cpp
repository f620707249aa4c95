#include "total_force.h"

#include "gravity.h"
#include "hinge_bending.h"
#include "membrane_springs.h"

namespace percale {

void evaluate_forces(const ForceInput& input, Forces& forces) {
    const ClothModel& model = *input.model;
    if (forces.total.padded_size() != input.positions->padded_size()) forces.total.resize(model.vertex_count());
    set_gravity_forces(model.mass, input.gravity, forces.total);
    forces.potential = gravity_energy(model.mass, input.gravity, *input.positions);
    const SpringMotion motion{*input.positions, *input.velocities, input.dt};
    forces.potential +=
        evaluate_springs(*input.compute, *input.springs, motion, input.with_matrix, forces.total, forces.spring_terms);
    if (!model.membrane.empty()) {
        forces.potential +=
            evaluate_membrane(*input.compute, model.adjacency, motion, input.with_matrix, forces.total, forces.spring_terms);
    }
    if (!model.hinges.curved.empty()) forces.potential += add_curved_hinges(model.hinges, *input.positions, forces.total);
    if (!input.wind || !input.wind->blows) return;
    add_wind(model, *input.wind, *input.velocities, input.dt, forces.total, forces.wind);
    forces.potential += forces.wind.potential;
    set_wind_blocks(forces.wind, forces.contact);
}

void add_contact_forces(const ForceInput& input, const ContactStep& contact_step, Forces& forces) {
    add_contact(forces.rows, contact_step, *input.positions, forces.total, forces.contact);
    forces.potential += forces.contact.energy;
}

}  // namespace percale
