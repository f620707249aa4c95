#include "scenes/pattern/pattern_toml.h"

#include "tests/scenes/pattern/garments.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::pattern_toml_test {
namespace {

std::string fault(const std::string& text) {
    return error_of([&] { parse_pattern_toml(text, "t"); });
}

const std::string panel = "unit = \"cm\"\n[[panel]]\nname = \"a\"\npoints = [[0, 0], [10, 0], [10, 10]]\n";

}  // namespace

TEST_CASE("a pattern is read in metres, with its curves, its places and its seams") {
    const Pattern pattern = parse_pattern_toml(skirt_text, "t");
    REQUIRE(pattern.panels.size() == 2);
    const Panel& front = pattern.panels[0];
    CHECK(front.name == "front");
    CHECK((front.corners[2] - Point2(0.15, 0.4)).norm() < 1e-15);
    CHECK(front.edges[2].curve == EdgeCurve::arc);
    CHECK((front.edges[2].control[0] - Point2(0.0, 0.38)).norm() < 1e-15);
    CHECK((front.pose.translation - Vec3(0, 0.6, 0.15)).norm() < 1e-15);
    REQUIRE(pattern.seams.size() == 2);
    CHECK(pattern.seams[0].name == "left");
    CHECK(pattern.seams[0].sides[0][0].panel == 0);
    CHECK(pattern.seams[0].sides[1][0].edge == 3);
    CHECK(pattern.seams[0].sides[1][0].reversed);
}

TEST_CASE("curves with control points, wraps, mirrors and sides whose direction is said") {
    const Pattern pattern =
        parse_pattern_toml(panel + "wrap = 20\nmirror = \"b\"\n" +
                               "curves = [{ edge = 0, control = [[5, -1]] }, { edge = 1, control = [[11, 3], [11, 6]] }]\n" +
                               "[[seam]]\nsides = [[\"a.0\", \"a.1\"], [\"b.1-\", \"b.0-\"]]\ngather = true\n",
                           "t");
    REQUIRE(pattern.panels.size() == 2);
    CHECK(pattern.panels[0].wrap == Approx(0.2));
    CHECK(pattern.panels[0].edges[0].curve == EdgeCurve::quadratic);
    CHECK(pattern.panels[0].edges[1].curve == EdgeCurve::cubic);
    CHECK((pattern.panels[1].edges[0].control[0] - Point2(-0.05, -0.01)).norm() < 1e-15);
    CHECK(pattern.panels[1].flipped);
    CHECK(pattern.seams[0].gather);
    CHECK(pattern.seams[0].sides[1][0].reversed);
    CHECK(pattern.seams[0].sides[1][1].edge == 0);
}

TEST_CASE("what is wrong in a pattern is reported at its place") {
    CHECK(fault("unit = \"foot\"\n[[panel]]\n").find("t:1:8: unit has no choice 'foot'") == 0);
    CHECK(fault("[[panel]]\nname = \"a\"\n").find("a pattern lacks unit") != std::string::npos);
    CHECK(fault("unit = \"cm\"\n").find("a pattern lacks panel") != std::string::npos);
    CHECK(fault(panel + "turns = [0, 0, 0]\n").find("t:5:1: panel 'a' has no key 'turns'; did you mean 'turn'?") == 0);
    CHECK(fault(panel + "at = [0, 0]\n").find("at must be a list of 3 numbers") != std::string::npos);
    CHECK(fault(panel + "wrap = -1\n").find("wrap = -1 is out of range") != std::string::npos);
    CHECK(fault(panel + "curves = [{ edge = 3, bulge = 1 }]\n").find("its edges are 0 ... 2") != std::string::npos);
    CHECK(fault(panel + "curves = [{ edge = 0 }]\n").find("needs either bulge or control") != std::string::npos);
    CHECK(fault(panel + "curves = [{ edge = 0, control = [[0, 1], [0, 2], [0, 3]] }]\n").find("has 3 control points") !=
          std::string::npos);
    CHECK(fault(panel + "mirror = \"a\"\n").find("a second panel 'a'") != std::string::npos);
    CHECK(fault(panel + "[[seam]]\nsides = [[\"a.0\"], [\"b.1\"]]\n").find("no panel 'b'") != std::string::npos);
    CHECK(fault(panel + "[[seam]]\nsides = [[\"a.0\"], [\"a.3\"]]\n").find("panel 'a' has no edge 3, edges are 0 ... 2") !=
          std::string::npos);
    CHECK(fault(panel + "[[seam]]\nsides = [[\"a.0\"], [\"a\"]]\n").find("is PANEL.EDGE") != std::string::npos);
    CHECK(fault(panel + "[[seam]]\nsides = [[\"a.0\"]]\n").find("a seam has two sides, not 1") != std::string::npos);
    CHECK(fault("unit = \"cm\"\n[[panel]]\nname = \"a b\"\npoints = [[0, 0]]\n").find("letters, digits, _ and -") !=
          std::string::npos);
    CHECK(fault("unit = \"cm\"\n[[panel]]\nname = \"a\"\npoints = [[0, 1e9]]\n").find("is out of range") != std::string::npos);
    CHECK(error_of([] { read_pattern_toml("not_there.toml"); }).find("cannot be read") != std::string::npos);
}

TEST_CASE("a scene file is not taken for a pattern") {
    CHECK(fault(small_scene()) == "t: is a scene file, not a sewing pattern: percale run takes it");
}

}  // namespace percale::scenes::test::pattern_toml_test
