#include "scenes/common/glb.h"

#include "percale/error.h"
#include "scenes/common/bytes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::glb_test {

TEST_CASE("a GLB file begins with its header and the JSON chunk, padded to four bytes") {
    const std::string start = glb_start("{\"a\":1}", 8);
    REQUIRE(start.size() == 12 + 8 + 8 + 8);
    CHECK(start.substr(0, 4) == "glTF");
    CHECK(little_at<std::uint32_t>(start.data() + 4) == 2);
    CHECK(little_at<std::uint32_t>(start.data() + 8) == start.size() + 8);
    CHECK(little_at<std::uint32_t>(start.data() + 12) == 8);
    CHECK(start.substr(16, 12) == "JSON{\"a\":1} ");
    CHECK(little_at<std::uint32_t>(start.data() + 28) == 8);
    CHECK(start.substr(32) == std::string("BIN\0", 4));
}

TEST_CASE("what a header of 32 bits cannot state is refused") {
    CHECK_NOTHROW(glb_start("{}", max_glb_bytes - 35));
    CHECK_THROWS_AS(glb_start("{}", max_glb_bytes - 27), SceneError);
}

}  // namespace percale::scenes::test::glb_test
