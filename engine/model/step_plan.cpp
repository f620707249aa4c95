#include "step_plan.h"

#include "schemes.h"

namespace percale {

StepPlan make_step_plan(const StepSettings& settings, const SceneFacts& facts) {
    const bool implicit = facts_of(settings.scheme).implicit;
    return {.implicit = implicit,
            .contacts = facts.cloth_vertices > 0 && facts.obstacles > 0,
            .obstacles_move = facts.obstacles_move,
            .pins_move = facts.pins_move,
            .damping = implicit ? settings.damping_form : DampingForm::velocity};
}

}  // namespace percale
