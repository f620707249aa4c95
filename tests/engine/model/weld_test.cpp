#include "engine/model/weld.h"

#include "tests/support/catch.h"

namespace percale::test::weld_test {

TEST_CASE("welds take up a fraction of k times the gap, at most k times the widest, and return the growth of their energy") {
    Vec3Arrays x;
    x.resize(4);
    x.set(0, {0.003, 0, 0});
    x.set(1, {0, 0.1, 0});
    x.set(2, {0, 0, 0});
    x.set(3, {0, 0, 0.02});
    std::vector<Weld> welds = {{{0, 2, 2, 0.0}, 100.0}, {{1, 2, 3, 0.25}, 50.0, {0.0, 0.2, 0.0}}};
    const double before = weld_energy(welds, x);
    CHECK(before == Approx(0.2 * 0.1));
    const double work = tighten(welds, x, 0.5, 0.01);
    CHECK((welds[0].hold - Vec3(0.15, 0, 0)).norm() < 1e-15);
    CHECK(welds[1].hold.norm() == Approx(0.5));
    CHECK(work == Approx(weld_energy(welds, x) - before));
}

}  // namespace percale::test::weld_test
