#include "engine/forces/gravity.h"

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::gravity_test {

TEST_CASE("Gravity is mass times acceleration and replaces earlier values") {
    Random random(1);
    const std::vector<double> mass = random_masses(random, 11);
    const Vec3 gravity(0.5, -9.81, 2.0);
    Vec3Arrays forces = to_vec3_arrays(random_points(random, 11, 1.0));
    set_gravity_forces(compute, mass, gravity, forces);
    for (int i = 0; i < 11; ++i) CHECK((forces.at(i) - mass[i] * gravity).norm() == 0.0);
}

TEST_CASE("Gravity's force is minus the gradient of its energy") {
    Random random(2);
    const std::vector<double> mass = random_masses(random, 5);
    const Vec3 gravity(0.5, -9.81, 2.0);
    const Vec3Arrays x = to_vec3_arrays(random_points(random, 5, 1.0));
    Vec3Arrays forces = x;
    set_gravity_forces(compute, mass, gravity, forces);
    for (int i = 0; i < 5; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            Vec3Arrays ahead = x, behind = x;
            ahead.add(i, 0.5 * Vec3::Unit(axis));
            behind.add(i, -0.5 * Vec3::Unit(axis));
            const double slope = gravity_energy(compute, mass, gravity, ahead) - gravity_energy(compute, mass, gravity, behind);
            CHECK(slope == Approx(-forces.at(i)[axis]).margin(1e-14));
        }
    }
}

TEST_CASE("Gravity's energy is zero at the origin and m g h above it") {
    const std::vector<double> mass = {2.0, 3.0};
    CHECK(gravity_energy(compute, mass, Vec3(0, -9.81, 0), to_vec3_arrays({Vec3::Zero(), Vec3::Zero()})) == 0.0);
    CHECK(gravity_energy(compute, mass, Vec3(0, -9.81, 0), to_vec3_arrays({Vec3(5, 1, 0), Vec3(0, 2, 7)})) ==
          Approx(9.81 * 8.0).epsilon(1e-15));
}

}  // namespace percale::test::gravity_test
