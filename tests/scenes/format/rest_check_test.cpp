#include "format/rest_check.h"

#include "format/scene_file.h"
#include "run/scene_build.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::rest_check_test {

// Which scenes with duration = "rest" are refused, by build_scene.

namespace {

const Override until_rest{"duration", "rest"};

/// The sheet on a box, its duration said in the file.
std::string resting_sheet() {
    std::string text = sheet_on_box();
    return text.replace(text.find("0.2"), 3, "\"rest\"");
}

std::string refusal(const std::string& text, const std::vector<Override>& overrides = {}) {
    return message_of([&] { build_scene(parse_scene(text, "t", overrides)); });
}

}  // namespace

TEST_CASE("what can never be proven at rest is refused at its place") {
    CHECK(refusal(resting_sheet()).empty());
    CHECK(refusal(resting_sheet(), {{"step.skip", "false"}})
              .starts_with("t:3:12: duration = \"rest\": cloth at rest falls asleep"));
    CHECK(refusal(sheet_on_box(), {until_rest, {"step.skip", "false"}}).starts_with("--set duration: "));
    for (const std::string scheme : {"forward_euler", "symplectic_euler", "midpoint", "rk4"})
        CHECK(refusal(falling_sheet(), {until_rest, {"step.scheme", scheme}})
                  .starts_with("--set step.scheme: step.scheme: with " + scheme + ", an explicit scheme, rest is not detected"));
    for (const std::string scheme : {"backward_euler", "implicit_midpoint", "trapezoid", "bdf2", "tr_bdf2"})
        CHECK(refusal(falling_sheet(), {until_rest, {"step.scheme", scheme}}).empty());
    CHECK(refusal(resting_sheet(), {{"obstacle.box.spin", "{ turns_per_s = 1.0 }"}}).starts_with("t:15:1: obstacle 'box': with"));
    CHECK(refusal(resting_sheet(), {{"obstacle.box.spin", "{ turns_per_s = 0.0 }"}}).empty());
}

TEST_CASE("what is to happen has to be over before max_duration") {
    const std::string late = sheet_on_box() + "[[event]]\ntime = 2.5\ngravity = [0.0, -5.0, 0.0]\n";
    CHECK(refusal(late, {until_rest, {"max_duration", "3"}}).empty());
    CHECK(refusal(late, {until_rest, {"max_duration", "2.5"}}) ==
          "t:21:1: event goes on until 2.5 s; with duration = \"rest\" all must be over before max_duration = 2.5 s");
    const std::string move =
        sheet_on_box() + "[[event]]\ntime = 2\nmove = { cloth = \"sheet\", vertices = [0], to = [0, 1, 0], over = 2 }\n";
    CHECK(refusal(move, {until_rest, {"max_duration", "3"}, {"cloth.sheet.pin", "[0]"}})
              .starts_with("t:21:1: event goes on until 4 s"));
    const std::string seam = sheet_on_box() + "[[seam]]\ncloths = [\"sheet\", \"sheet\"]\nvertices = [[0, 1]]\nduration = 30\n";
    CHECK(refusal(seam, {until_rest}).starts_with("t:21:1: seam: closing goes on until 30 s"));
    const Override motion{"obstacle.box.motion", "[{ time = 0 }, { time = 25, translation = [0, -0.3, 0] }]"};
    CHECK(refusal(sheet_on_box(), {until_rest, motion}).find(": obstacle 'box': motion goes on until 25 s") != std::string::npos);
    CHECK(refusal(seam).empty());
}

}  // namespace percale::scenes::test::rest_check_test
