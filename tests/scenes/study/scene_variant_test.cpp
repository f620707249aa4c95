#include "scenes/study/scene_variant.h"

#include <algorithm>

#include "percale/settings.h"
#include "tests/scenes/compare_scenes.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::scene_variant_test {

TEST_CASE("The words of schemes stand where their values do, and none chooses by itself") {
    const std::vector<std::string> words = scheme_words();
    CHECK(words.size() == 9);
    CHECK(words.at(static_cast<std::size_t>(Scheme::rk4)) == "rk4");
    CHECK(words.at(static_cast<std::size_t>(Scheme::tr_bdf2)) == "tr_bdf2");
    CHECK(std::find(words.begin(), words.end(), "auto") == words.end());
}

TEST_CASE("A scene of which only the steps matter has its first frame, and expects nothing") {
    const std::string text = falling_sheet() + "[expect]\nlowest_vertex = { above = 1.9 }\n";
    int frames = 0, used = 0;
    CHECK(use_steps(source_of(text)({}), [&](BuiltScene& built) {
              ++used;
              CHECK(built.scene.expectations.empty());
              RunHooks hooks;
              hooks.frame = [&](const Frame&) { ++frames; };
              CHECK(run_scene(built, hooks).status == RunStatus::finished);
          }) == "");
    CHECK(used == 1);
    CHECK(frames == 1);
}

TEST_CASE("What a scheme does not take is refused with the reason, and not used") {
    Scene scene = source_of(sheet_on_box())({});
    scene.step.scheme = Scheme::rk4;
    CHECK(use_steps(scene, [](BuiltScene&) { FAIL("used"); }).find("obstacles") != std::string::npos);
}

}  // namespace percale::scenes::test::scene_variant_test
