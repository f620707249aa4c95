#include "scenes/pattern/pattern_check.h"

#include "tests/scenes/pattern/garments.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::pattern_check_test {
namespace {

std::string fault(const Pattern& pattern) {
    return error_of([&] { check_pattern(pattern); });
}

std::string fault_of(const std::string& points, const std::string& more = "") {
    return fault(parse_pattern_toml("unit = \"cm\"\n[[panel]]\nname = \"a\"\npoints = " + points + "\n" + more, "t"));
}

}  // namespace

TEST_CASE("a good pattern passes, also with a gather") {
    CHECK_NOTHROW(check_pattern(parse_pattern_toml(skirt_text, "t")));
    const std::string ruffle = "[[panel]]\nname = \"b\"\npoints = [[0, 0], [90, 0], [90, 9]]\nat = [0, 0, 5]\n";
    const std::string seam = "[[seam]]\nname = \"ruffle\"\nsides = [[\"a.0\"], [\"b.0\"]]\n";
    CHECK(fault_of("[[0, 0], [40, 0], [40, 30]]", ruffle + seam + "gather = true\n") == "nothing was thrown");
    CHECK(fault_of("[[0, 0], [40, 0], [40, 30]]", ruffle + seam)
              .find("seam 'ruffle': its sides are 0.4 m and 0.9 m long, more than 25 % apart; gather = true") !=
          std::string::npos);
}

TEST_CASE("each thing that cannot be sewn has an error of its own") {
    Pattern open = parse_pattern_toml(skirt_text, "t");
    open.panels[1].edges[2].to = 0;
    CHECK(fault(open).find("panel 'back' is open: edge 2 ends at corner 0, edge 3 begins at corner 3") != std::string::npos);
    CHECK(fault(Pattern{.file = "t", .panels = {}, .seams = {}}).find("no panels") != std::string::npos);
    CHECK(fault_of("[[0, 0], [40, 0]]").find("panel 'a' has 2 edges") != std::string::npos);
    CHECK(fault_of("[[0, 0], [40, 40], [40, 0], [0, 30]]").find("its outline crosses itself, edge 0 and edge 2") !=
          std::string::npos);
    CHECK(fault_of("[[0, 0], [40, 0], [40, 30]]", "curves = [{ edge = 0, control = [[20, 50]] }]\n").find("crosses itself") !=
          std::string::npos);
    CHECK(fault_of("[[0, 0], [20, 0], [40, 0]]").find("panel 'a' has no area") != std::string::npos);
    CHECK(fault_of("[[0, 0], [4000, 0], [4000, 3000]]").find("more than 5 m; is its unit right?") != std::string::npos);
    CHECK(fault_of("[[0, 0], [0.4, 0], [0.4, 0.3]]").find("less than 1 cm; is its unit right?") != std::string::npos);
    CHECK(fault_of("[[0, 0], [40, 0], [40, 30]]", "[[panel]]\nname = \"b\"\npoints = [[0, 0], [40, 0], [40, 30]]\n")
              .find("panel 'b' lies where panel 'a' lies") != std::string::npos);
}

}  // namespace percale::scenes::test::pattern_check_test
