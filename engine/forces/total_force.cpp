#include "total_force.h"

#include <array>

#include "gravity.h"
#include "hinge_bending.h"
#include "membrane_springs.h"
#include "pressure.h"
#include "sewing.h"
#include "springs.h"
#include "strain_limit.h"
#include "wind.h"

namespace percale {

std::span<const ForceTerm* const> force_terms() {
    static const std::array<const ForceTerm*, 9> terms = {&gravity_term(),      &spring_term(), &membrane_term(),
                                                          &strain_limit_term(), &hinge_term(),  &sewing_term(),
                                                          &welding_term(),      &wind_term(),   &pressure_term()};
    return terms;
}

void evaluate_forces(const ForceInput& input, Forces& forces) {
    if (forces.total.padded_size() != input.positions->padded_size()) forces.total.resize(input.model->vertex_count());
    forces.potential = 0.0;
    forces.blocks.clear();
    for (const ForceTerm* term : force_terms()) {
        if (term->acts(input)) forces.potential += term->add(input, forces);
    }
}

}  // namespace percale
