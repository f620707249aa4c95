#include "engine/model/step_plan.h"

#include "tests/support/catch.h"

namespace percale::test {

TEST_CASE("Contacts are planned only where there is cloth and an obstacle") {
    for (const int vertices : {0, 9}) {
        for (const int obstacles : {0, 1, 3}) {
            const StepPlan plan = make_step_plan({}, {.cloth_vertices = vertices, .obstacles = obstacles});
            CHECK(plan.contacts == (vertices > 0 && obstacles > 0));
        }
    }
}

TEST_CASE("The plan passes on what moves in the coming step") {
    const SceneFacts facts{.cloth_vertices = 4, .obstacles = 1, .obstacles_move = true, .pins_move = false};
    CHECK(make_step_plan({}, facts).obstacles_move);
    CHECK_FALSE(make_step_plan({}, facts).pins_move);
    const SceneFacts pins{.cloth_vertices = 4, .obstacles = 1, .obstacles_move = false, .pins_move = true};
    CHECK_FALSE(make_step_plan({}, pins).obstacles_move);
    CHECK(make_step_plan({}, pins).pins_move);
}

TEST_CASE("Explicit schemes damp by velocity whatever the setting") {
    for (const DampingForm form : {DampingForm::length_rate, DampingForm::velocity}) {
        for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4, Scheme::backward_euler}) {
            const StepPlan plan = make_step_plan({.scheme = scheme, .damping_form = form}, {.cloth_vertices = 4});
            CHECK(plan.implicit == (scheme == Scheme::backward_euler));
            CHECK(plan.damping == (plan.implicit ? form : DampingForm::velocity));
        }
    }
}

}  // namespace percale::test
