#include "tests/support/collision/random_scenes.h"

#include <cstdio>

#include "tests/support/catch.h"

namespace percale::test::random_scenes_test {
namespace {

TEST_CASE("Nothing crosses in 200 random scenes, by the exact certificate after every step") {
    int touched = 0, blocked = 0, blocked_free = 0, blocked_yielding = 0;
    long steps = 0;
    for (int index = 0; index < 200; ++index) {
        RandomScene scene = make_random_scene(1, index);
        const RandomOutcome outcome = run_random_scene(scene);
        CAPTURE(index, scene.description, outcome.result.reason);
        CHECK(outcome.crossings == 0);
        CHECK(outcome.deepest == 0.0);
        CHECK(outcome.not_finite == 0);
        CHECK(outcome.last != StepStatus::not_finite);
        touched += outcome.result.totals.contacts_most > 0 ? 1 : 0;
        blocked += outcome.blocked() ? 1 : 0;
        const bool can_yield = scene.built.scene.step.contact_response == ContactResponse::penalty && scene.motion != "closing";
        blocked_free += outcome.blocked() && !scene.pinned && can_yield ? 1 : 0;
        blocked_yielding += outcome.blocked() && can_yield ? 1 : 0;
        steps += outcome.result.totals.steps;
    }
    std::printf("200 random scenes: %ld steps, %d with contact, %d blocked (%d by penalty and one body)\n", steps, touched,
                blocked, blocked_yielding);
    CHECK(touched > 100);
    // Where an obstacle runs over a pin, or two close on cloth, nothing can be done; cloth that nothing holds gets away, but for
    // two of 2,000 that blades turning at 20 times a second fold around themselves, with velocities projected.
    CHECK(blocked_free == 0);
    CHECK(blocked_yielding < 25);
    CHECK(blocked < 40);
}

}  // namespace
}  // namespace percale::test::random_scenes_test
