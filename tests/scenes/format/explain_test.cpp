#include "scenes/format/explain.h"

#include <sstream>

#include "percale/fabric_presets.h"
#include "scenes/format/scene_table.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::explain_test {
namespace {

std::string explained(const std::string& topic = "") {
    std::ostringstream out;
    explain(out, topic);
    return out.str();
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("without a topic every key is explained with its sentence") {
    const std::string text = explained();
    for (const SceneKey& key : scene_keys()) {
        CAPTURE(key.path);
        CHECK(contains(text, key.sentence));
    }
    for (const char* heading : {"[step]", "[fabric.NAME]", "[[cloth]]", "[[obstacle]]", "[[event]]", "[expect]", "[output]"})
        CHECK(contains(text, heading));
}

TEST_CASE("a key is explained with kind, range, unit and default") {
    CHECK(explained("output.fps") ==
          "[output]\n  fps: a number, 0.01 ... 1e5 1/s; default 30\n      Frames per second of simulated time.\n");
    CHECK(explained("step.detector").starts_with("[step]\n  detector: one of fcl, bullet, brute_force, none; default fcl\n"));
    CHECK(contains(explained("cloth.name"), "name: a text; required\n"));
    CHECK(explained("title").starts_with("  title: a text; default \"\"\n"));
}

TEST_CASE("presets are listed with their numbers under where these come from") {
    const std::string text = explained("presets");
    for (const percale::FabricPreset& preset : percale::fabric_presets()) {
        CAPTURE(preset.name);
        CHECK(contains(text, "\n  " + std::string(preset.name) + ": area_density "));
        CHECK(text.find(preset.source) < text.find("\n  " + std::string(preset.name) + ": "));
    }
    CHECK(contains(text, "  ponte: area_density 0.284 kg/m^2, stretch_stiffness [31, 44] N/m, shear_stiffness 32 N/m, "));
    CHECK(contains(error_of([] { explained("presetss"); }), "did you mean 'presets'?"));
}

TEST_CASE("a topic takes in what lies below it and nothing else") {
    const std::string text = explained("cloth.pin");
    CHECK(contains(text, "  pin: "));
    CHECK(contains(text, "  pin.box: "));
    CHECK_FALSE(contains(text, "fabric:"));
    CHECK_FALSE(contains(text, "unpin"));
    const std::string step = explained("step");
    CHECK(contains(step, "time_step"));
    CHECK_FALSE(contains(step, "area_density"));
}

TEST_CASE("the scheme is explained with a line on each") {
    const std::string text = explained("scheme");
    for (const char* word : {"forward_euler ", "symplectic_euler ", "midpoint ", "rk4 ", "backward_euler ", "implicit_midpoint ",
                             "trapezoid ", "bdf2 ", "tr_bdf2 "})
        CHECK(contains(text, std::string("\n") + word));
    CHECK_FALSE(contains(explained("step"), "order  kind"));
}

TEST_CASE("the last part of a key is enough") {
    CHECK(explained("time_step") == explained("step.time_step"));
    const std::string both = explained("friction");
    CHECK(contains(both, "[[obstacle]]"));
    const std::string poses = explained("pose.scale");
    CHECK(contains(poses, "[[cloth]]"));
    CHECK(contains(poses, "[[obstacle]]"));
}

TEST_CASE("an unknown topic is an error with the nearest") {
    CHECK(error_of([] {
              explained("tme_step");
          }).starts_with("explain: no topic 'tme_step'; did you mean 'time_step'? topics: presets, title, "));
    CHECK(contains(error_of([] { explained("cloth.pinn"); }), "did you mean 'cloth.pin'?"));
    CHECK(contains(error_of([] { explained("."); }), "no topic '.'"));
}

TEST_CASE("the tables of keys have a row for every key that is no heading") {
    const std::string text = key_tables_markdown();
    std::size_t rows = 0, position = 0;
    while ((position = text.find("\n| `", position)) != std::string::npos) {
        ++rows;
        ++position;
    }
    std::size_t headings = 0;
    for (const SceneKey& key : scene_keys()) {
        const bool table = key.kind == KeyKind::table || key.kind == KeyKind::table_or_list || key.kind == KeyKind::table_list ||
                           key.kind == KeyKind::named_tables;
        headings += table && !contains(key.path, ".") ? 1 : 0;
    }
    CHECK(rows + headings == scene_keys().size());
}

}  // namespace percale::scenes::test::explain_test
