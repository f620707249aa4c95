#include "scenes/format/former_keys.h"

#include "scenes/export/run_settings.h"
#include "scenes/format/scene_file.h"
#include "scenes/format/scene_table.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::former_keys_test {
namespace {

const std::string seam = "[[seam]]\ncloths = [\"flag\", \"flag\"]\nvertices = [[0, 1]]\n";

/// A small scene that ends at rest, with two seams, by former or by present names of keys.
std::string sewn(bool former) {
    const std::string from = former ? "from" : "start_time", over = former ? "over" : "duration";
    const std::string times = from + " = 0.25\n" + over + " = 0.5\n";
    const std::string head = std::string("duration = \"rest\"\n") + (former ? "longest" : "max_duration") + " = 7.0\n";
    return head + small_scene() + seam + times + seam + times;
}

std::vector<Override> step(const std::string& key, const std::string& value) { return {{"step." + key, value}}; }

}  // namespace

TEST_CASE("Former names of keys are read as the present ones, each is reported once") {
    const Scene before = parse_scene(sewn(true), "t", step("newton_share", "0.5"));
    const Scene now = parse_scene(sewn(false), "t", step("newton_error_ratio", "0.5"));
    CHECK(settings_text(before) == settings_text(now));
    CHECK(now.max_duration == 7.0);
    CHECK(now.seams.at(1).start_time == 0.25);
    CHECK(now.seams.at(1).duration == 0.5);
    CHECK(now.step.newton_error_ratio == 0.5);
    CHECK(now.warnings.empty());
    REQUIRE(before.warnings.size() == 4);
    CHECK(finding_text(before.warnings[0]) ==
          "the key longest is called max_duration now; the former name works in this release only");
    CHECK(before.warnings[1].what == "the key seam.from is called start_time now");
    CHECK(before.warnings[2].what == "the key seam.over is called duration now");
    CHECK(before.warnings[3].what == "the key step.newton_share is called newton_error_ratio now");
    for (const Finding& warning : before.warnings) CHECK(warning.kind == "former_key");
    CHECK(before.warnings[0].place == "t:2:1");
    CHECK(before.warnings[3].place == "--set step.newton_share");
}

TEST_CASE("An override by either name takes the place of a value by either name") {
    for (const bool former : {true, false}) {
        for (const std::string key : {"longest", "max_duration"})
            CHECK(parse_scene(sewn(former), "t", std::vector<Override>{{key, "3"}}).max_duration == 3.0);
        for (const std::string key : {"over", "duration"})
            CHECK(parse_scene(sewn(former), "t", std::vector<Override>{{"seam.1." + key, "3"}}).seams[1].duration == 3.0);
    }
}

TEST_CASE("A table that has a key by both names is refused where the former one stands") {
    const auto error = error_of([] { parse_scene(sewn(true) + "duration = 1\n", "t", {}); });
    CHECK(error.find("'over' is the former name of 'duration', which is there, too") != std::string::npos);
    CHECK(error.starts_with("t:"));
}

TEST_CASE("A former name counts in its own table only, and every one has a present key") {
    CHECK(present_path("longest") == "max_duration");
    CHECK(present_path("seam.over") == "seam.duration");
    for (const std::string path : {"event.move.over", "obstacle.spin.from", "duration", "cloth.longest", ""})
        CHECK(present_path(path).empty());
    int former = 0;
    for (const SceneKey& key : scene_keys()) {
        if (key.former.empty()) continue;
        ++former;
        const std::size_t dot = key.path.rfind('.');
        const std::string path = (dot == std::string::npos ? "" : key.path.substr(0, dot + 1)) + key.former;
        CHECK(present_path(path) == key.path);
        CHECK(find_scene_key(path) == nullptr);
    }
    CHECK(former == 4);
}

}  // namespace percale::scenes::test::former_keys_test
