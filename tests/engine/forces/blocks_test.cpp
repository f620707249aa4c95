#include "engine/forces/blocks.h"

#include <array>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::blocks_test {

TEST_CASE("Outer blocks keep their order, begin with gradients of zero, and are gone once cleared") {
    OuterBlocks blocks;
    CHECK(blocks.size() == 0);
    for (const int round : {0, 1}) {
        for (int size = 1; size <= 5; ++size) {
            const OuterBlocks::NewBlock block = blocks.add(size);
            REQUIRE(static_cast<int>(block.vertex.size()) == size);
            for (int k = 0; k < size; ++k) {
                CHECK(block.gradient[k] == Vec3::Zero());
                block.vertex[k] = 10 * size + k;
                block.gradient[k] = Vec3(size, k, round);
            }
        }
        REQUIRE(blocks.size() == 5);
        for (int size = 1; size <= 5; ++size) {
            const OuterBlocks::Block block = blocks[size - 1];
            REQUIRE(static_cast<int>(block.vertex.size()) == size);
            CHECK(block.vertex.back() == 11 * size - 1);
            CHECK(block.gradient.back() == Vec3(size, size - 1, round));
        }
        blocks.clear();
        CHECK(blocks.size() == 0);
    }
}

TEST_CASE("The blocks of forces and of contact are one list, in this order") {
    const std::vector<CoupledBlock> forces(3, {.vertex = {1, -1, -1, -1}, .weight = {1.0}, .k = {}}),
        contact(2, {.vertex = {2, -1, -1, -1}, .weight = {1.0}, .k = {}});
    const CoupledBlocks both(forces, contact);
    REQUIRE(both.size() == 5);
    for (std::size_t k = 0; k < 5; ++k) CHECK(both[k].vertex[0] == (k < 3 ? 1 : 2));
    CHECK(CoupledBlocks({}, contact)[1].vertex[0] == 2);
    CHECK(CoupledBlocks().size() == 0);
}

}  // namespace percale::test::blocks_test
