#include "collision/geometry/disjoint_sets.h"

#include "tests/support/catch.h"
#include "tests/support/random.h"

namespace percale::test::disjoint_sets_test {

TEST_CASE("numbers are in one set where joins lead from one to the other, known by the lowest of them") {
    Random random(4);
    const int count = 60;
    DisjointSets sets(count);
    std::vector<int> lowest(count);  // by joining all members each time
    for (int i = 0; i < count; ++i) lowest[i] = i;
    for (int n = 0; n < 45; ++n) {
        const int a = static_cast<int>(random.number(0, count)), b = static_cast<int>(random.number(0, count));
        sets.join(a, b);
        const int low = std::min(lowest[a], lowest[b]), high = std::max(lowest[a], lowest[b]);
        for (int& member : lowest) member = member == high ? low : member;
        for (int i = 0; i < count; ++i) REQUIRE(sets.of(i) == lowest[i]);
    }
}

}  // namespace percale::test::disjoint_sets_test
