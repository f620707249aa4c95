#include "engine/linear/low_rank_update.h"

#include "engine/linear/direct_solver.h"
#include "tests/support/catch.h"
#include "tests/support/dense_system.h"

namespace percale::test::low_rank_update_test {

TEST_CASE("The update of an exact inverse is the exact inverse with the wide outer blocks") {
    for (const int wide : {0, 1, 3}) {
        RandomSystem system(400u + static_cast<unsigned>(wide), 40);
        system.add_outer(3, 1.0);
        for (int k = 0; k < wide; ++k) system.add_outer(40 - 5 * k, 30.0);
        system.fill();
        REQUIRE(static_cast<int>(system.matrix.wide_outer.size()) == wide);
        DirectSolver direct;
        REQUIRE(direct.factorise(system.matrix));
        LowRankUpdate update;
        update.fill(system.matrix, [&](const Vec3Arrays& r, Vec3Arrays& z) { direct.apply(system.matrix, r, z); });
        const Eigen::VectorXd b = system.random_vector(), expected = system.solve_dense(b, Eigen::VectorXd::Zero(120));
        Vec3Arrays z;
        update.apply(from_dense(b), z);
        CHECK((to_dense(z, 40) - expected).norm() <= 1e-9 * expected.norm());
    }
}

}  // namespace percale::test::low_rank_update_test
