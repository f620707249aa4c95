#include "engine/solve/body_states.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/contact_rows.h"

namespace percale::test::body_states_test {
namespace {

/// Three cloths of two masses each; a seam joins the last two.
ClothModel two_bodies() {
    ClothModel model = linked_masses(std::vector<double>(6, 0.1), {{0, 1, 1.0, 10.0, 0.0}, {3, 4, 1.0, 10.0, 0.0}});
    model.springs.kind[1] = SpringKind::seam;
    model.cloths.clear();
    for (const int first : {0, 2, 4}) model.cloths.push_back({.name = "pair", .first = first, .count = 2, .mass = 0.2});
    finish_model(model);
    return model;
}

ContactConstraints constraint_between(int first, int second, int obstacle) {
    ContactConstraints constraints;
    add_constraint({first, second, -1, -1}, {1, -1, 0, 0}, obstacle, constraints);
    return constraints;
}

}  // namespace

TEST_CASE("A body is settled once a small change of it was made, and is not checked again") {
    const ClothModel model = two_bodies();
    REQUIRE(model.bodies.size() == 2);
    BodyStates states;
    CHECK_FALSE(states.settled(0));
    states.start(model);
    int asked = 0;
    const auto first_is_small = [&](const Body& body) { return ++asked, body.first == 0; };
    CHECK_FALSE(states.mark(model, first_is_small));
    CHECK(asked == 2);
    CHECK_FALSE(states.settled(0));
    states.settle_small();
    CHECK(states.settled(0));
    CHECK_FALSE(states.settled(1));
    CHECK_FALSE(states.mark(model, first_is_small));
    CHECK(asked == 3);
    CHECK(states.mark(model, [](const Body&) { return true; }));
    states.start(model);
    CHECK_FALSE(states.settled(0));
}

TEST_CASE("Bodies that a constraint joins are released, others are not") {
    const ClothModel model = two_bodies();
    const auto settled_after = [&](const ContactConstraints& constraints) {
        BodyStates states;
        states.start(model);
        states.mark(model, [](const Body&) { return true; });
        states.settle_small();
        states.release_joined(model, constraints);
        return std::array{states.settled(0), states.settled(1)};
    };
    CHECK(settled_after({}) == std::array{true, true});
    CHECK(settled_after(constraint_between(0, 1, -1)) == std::array{true, true});
    CHECK(settled_after(constraint_between(2, 5, -1)) == std::array{true, true});
    CHECK(settled_after(constraint_between(1, 4, 0)) == std::array{true, true});
    CHECK(settled_after(constraint_between(1, 4, -1)) == std::array{false, false});
}

}  // namespace percale::test::body_states_test
