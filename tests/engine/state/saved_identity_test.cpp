#include "engine/state/saved_identity.h"

#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::saved_identity_test {

TEST_CASE("worlds of other cloth, layers or settings are distinguished, and worlds in other states are not") {
    const auto world = [](double mass) {
        World made;
        made.scene.model.mass = {mass, 1.0};
        return made;
    };
    const Identity one = identity_of(world(1.0));
    World moved = world(1.0);
    moved.state.time = 3.0;
    CHECK(identity_of(moved).cloth == one.cloth);
    CHECK(identity_of(moved).settings == one.settings);
    CHECK(identity_of(world(2.0)).cloth != one.cloth);
    World layered = world(1.0);
    layered.scene.script.pairs.set_layer(0, 2);
    CHECK(identity_of(layered).cloth != one.cloth);
    World other = world(1.0);
    other.scene.settings.newton_error_ratio = 0.5;
    CHECK(identity_of(other).settings != one.settings);
    other.scene.script.obstacles.push_back({});
    CHECK(identity_of(other).obstacles != one.obstacles);
}

}  // namespace percale::test::saved_identity_test
