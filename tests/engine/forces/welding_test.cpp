#include "engine/forces/welding.h"

#include "tests/support/catch.h"

namespace percale::test {

TEST_CASE("a weld pulls its two sides together with what it holds, and that is minus the gradient of its energy") {
    ClothModel model;
    model.welds = {{{0, 2, 2, 0.0}, 100.0, {1.0, -2.0, 0.5}}, {{1, 2, 3, 0.25}, 50.0, {0.0, 3.0, 0.0}}};
    Vectors x;
    x.resize(4);
    for (int v = 0; v < 4; ++v) x.set(v, Vec3(0.1 * v, 0.02 * v * v, -0.3 * v));
    const ForceInput input{.model = &model, .positions = &x};
    REQUIRE(welding_term().acts(input));
    Forces forces;
    forces.total.resize(4);
    const double potential = welding_term().add(input, forces);
    CHECK(potential == Approx(welding_term().energy({model, x})));
    Vec3 sum = Vec3::Zero();
    for (int v = 0; v < 4; ++v) {
        sum += forces.total.at(v);
        for (int axis = 0; axis < 3; ++axis) {
            Vectors moved = x;
            Vec3 by = Vec3::Zero();
            by[axis] = 1.0;  // the energy is linear
            moved.set(v, x.at(v) + by);
            const double slope = welding_term().energy({model, moved}) - potential;
            CHECK(forces.total.at(v)[axis] == Approx(-slope).margin(1e-12));
        }
    }
    CHECK(sum.norm() < 1e-14);
    const ClothModel none;
    CHECK_FALSE(welding_term().acts({.model = &none}));
}

TEST_CASE("saved states of other welds are others, whatever those hold with") {
    ClothModel model;
    model.welds = {{{0, 2, 2, 0.0}, 100.0, {1.0, -2.0, 0.5}}};
    const auto hash_of = [](const ClothModel& of) {
        ListHash hash;
        welding_term().identify(of, hash);
        return hash.value();
    };
    ClothModel same = model, other = model;
    same.welds[0].hold = Vec3::Zero();
    other.welds[0].stiffness = 101.0;
    CHECK(hash_of(same) == hash_of(model));
    CHECK(hash_of(other) != hash_of(model));
}

}  // namespace percale::test
