#include "scenes/pattern/pattern_json.h"

#include "scenes/pattern/panel_curve.h"
#include "scenes/pattern/pattern_parts.h"
#include "tests/scenes/pattern/garments.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::pattern_json_test {
namespace {

Pattern pattern_of(const std::string& text) {
    const TestFolder folder;
    return read_pattern_json(folder.write("pattern.json", text));
}

std::string panel_with(const std::string& edges, const std::string& stitches = "[]") {
    return R"({"pattern": {"panels": {"front": {"translation": [0, 100, 20], "rotation": [0, 0, 90],
        "vertices": [[0, 0], [40, 0], [40, 30]], "edges": [)" +
           edges + R"(]}}, "stitches": )" + stitches + R"(}, "properties": {"units_in_meter": 100}})";
}

constexpr const char* straight = R"({"endpoints": [1, 2]}, {"endpoints": [2, 0]})";

std::string fault(const std::string& text) {
    return error_of([&] { pattern_of(text); });
}

}  // namespace

TEST_CASE("panels are read in metres and placed") {
    const Pattern pattern = pattern_of(panel_with(std::string(R"({"endpoints": [0, 1], "label": "hem"}, )") + straight));
    const Panel& panel = pattern.panels.at(0);
    CHECK(panel.name == "front");
    CHECK(panel.edges[0].label == "hem");
    CHECK((placed_point(panel, panel.corners[1]) - Vec3(0.0, 1.4, 0.2)).norm() < 1e-14);
}

TEST_CASE("curves are relative to their edge, circles have a radius and two flags") {
    const auto middle_with = [](const std::string& curvature) {
        const std::string edge = R"({"endpoints": [0, 1], "curvature": )" + curvature + "}, ";
        const Panel panel = pattern_of(panel_with(edge + straight)).panels.at(0);
        return point_on(panel, panel.edges[0], 0.5);
    };
    CHECK((middle_with(R"({"type": "quadratic", "params": [[0.5, 0.2]]})") - Point2(0.2, 0.04)).norm() < 1e-15);
    CHECK((middle_with("[0.5, 0.2]") - Point2(0.2, 0.04)).norm() < 1e-15);
    CHECK((middle_with(R"({"type": "cubic", "params": [[0.25, 0.4], [0.75, 0.4]]})") - Point2(0.2, 0.12)).norm() < 1e-15);
    const double rise = 0.25 - std::sqrt(0.25 * 0.25 - 0.2 * 0.2);
    CHECK((middle_with(R"({"type": "circle", "params": [25, 0, 1]})") - Point2(0.2, -rise)).norm() < 1e-14);
    CHECK((middle_with(R"({"type": "circle", "params": [25, 0, 0]})") - Point2(0.2, rise)).norm() < 1e-14);
    CHECK((middle_with(R"({"type": "circle", "params": [25, 1, 1]})") - Point2(0.2, rise - 0.5)).norm() < 1e-14);
}

TEST_CASE("the end of an edge is sewn to the beginning of the other, unless the stitch says otherwise") {
    const std::string edges = std::string(R"({"endpoints": [0, 1]}, )") + straight;
    const std::string two = R"([[{"panel": "front", "edge": 0}, {"panel": "front", "edge": 1}],
                                [{"panel": "front", "edge": 0}, {"panel": "front", "edge": 2}, "right_wrong"]])";
    const Pattern pattern = pattern_of(panel_with(edges, two));
    CHECK_FALSE(pattern.seams[0].sides[0][0].reversed);
    CHECK(pattern.seams[0].sides[1][0].reversed);
    CHECK_FALSE(pattern.seams[1].sides[1][0].reversed);
    CHECK(pattern.seams[1].sides[1][0].edge == 2);
}

TEST_CASE("what is no pattern is reported with its panel or stitch") {
    const std::string edges = std::string(R"({"endpoints": [0, 1]}, )") + straight;
    CHECK(fault("{").find("is no JSON from its byte") != std::string::npos);
    CHECK(fault("{}").find("is no sewing pattern") != std::string::npos);
    CHECK(fault(panel_with(R"({"endpoints": [0, 7]})")).find("panel 'front': edge 0 ends at vertex 7, vertices are 0 ... 2") !=
          std::string::npos);
    CHECK(fault(panel_with(R"({"endpoints": [0]})")).find("panel 'front': a key is missing") != std::string::npos);
    CHECK(fault(panel_with(R"({"endpoints": [0, 1], "curvature": {"type": "circles", "params": [1, 0, 0]}})"))
              .find("no type of curve 'circles'; did you mean 'circle'?") != std::string::npos);
    CHECK(fault(panel_with(edges, R"([[{"panel": "frond", "edge": 0}, {"panel": "front", "edge": 1}]])"))
              .find("stitch 0: no panel 'frond'; did you mean 'front'?") != std::string::npos);
    CHECK(fault(panel_with(edges, R"([[{"panel": "front", "edge": 0}, {"panel": "front", "edge": 5}]])"))
              .find("panel 'front' has no edge 5, edges are 0 ... 2") != std::string::npos);
    CHECK(fault(panel_with(edges, R"([[{"panel": "front", "edge": 0}]])")).find("it joins two edges") != std::string::npos);
    CHECK(error_of([] { read_pattern_json("not_there.json"); }).find("cannot be read") != std::string::npos);
}

}  // namespace percale::scenes::test::pattern_json_test
