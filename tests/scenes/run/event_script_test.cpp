#include "scenes/run/event_script.h"

#include "scenes/format/scene_file.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::event_script_test {
namespace {

// Two cloths: 'flag' (5 by 4 vertices, vertex 0 pinned) and 'towel' (3 by 3).
Scene two_cloths(const std::string& events) {
    const std::string towel = "[[cloth]]\nname = \"towel\"\nfabric = \"sheet\"\ngrid = { size = [1, 1], vertices = [3, 3] }\n";
    return parse_scene(small_scene() + "pin = [0]\n" + towel + events, "t");
}

std::vector<ScriptedEvent> script(const std::string& events) {
    const std::vector<TriangleMesh> meshes = {make_grid(0.4, 0.3, 5, 4), make_grid(1, 1, 3, 3)};
    return script_events(two_cloths(events), meshes);
}

std::string fault(const std::string& events) {
    return error_of([&] { script(events); });
}

std::string event(double time, const std::string& what) {
    return "[[event]]\ntime = " + std::to_string(time) + "\n" + what + "\n";
}

}  // namespace

TEST_CASE("events name cloths by number and vertices by index") {
    const auto events = script(event(1, "pin = { cloth = \"towel\", vertices = \"boundary\" }") +
                               event(2, "unpin = { cloth = \"flag\", vertices = [0] }") + event(3, "gravity = [0, 1, 0]"));
    REQUIRE(events.size() == 3);
    CHECK(events[0].time == 1.0);
    CHECK(std::get<ScriptedPin>(events[0].what).cloth == 1);
    CHECK(std::get<ScriptedPin>(events[0].what).vertices == std::vector<int>{0, 1, 2, 3, 5, 6, 7, 8});
    CHECK(std::get<ScriptedUnpin>(events[1].what).cloth == 0);
    CHECK(std::get<ScriptedUnpin>(events[1].what).vertices == std::vector<int>{0});
    CHECK(std::get<ScriptedGravity>(events[2].what).gravity == Vec3(0, 1, 0));
}

TEST_CASE("a vertex pinned from the start or by an earlier event can be moved") {
    const std::string move = "move = { cloth = \"flag\", vertices = [0], to = [0, 1, 0], over = 0.5 }";
    const auto events = script(event(1, move));
    CHECK(std::get<ScriptedMove>(events.at(0).what).to == Vec3(0, 1, 0));
    CHECK(std::get<ScriptedMove>(events.at(0).what).over == 0.5);
    const std::string other = "move = { cloth = \"flag\", vertices = [3], to = [0, 1, 0], over = 0.5 }";
    CHECK(script(event(1, "pin = { cloth = \"flag\", vertices = [3] }") + event(1, other)).size() == 2);
}

TEST_CASE("a vertex that is not pinned when it is to move is named") {
    const std::string move = "move = { cloth = \"flag\", vertices = [0, 3], to = [0, 1, 0], over = 0.5 }";
    CHECK(fault(event(1, move)) ==
          "t:13:1: event: only pinned vertices can be moved; vertex 3 of cloth 'flag' is not pinned then");
    const std::string late = event(2, "pin = { cloth = \"flag\", vertices = [3] }");
    CHECK(fault(event(1, move) + late).find("vertex 3 of cloth 'flag'") != std::string::npos);
    const std::string gone = event(0.5, "unpin = { cloth = \"flag\", vertices = [0] }");
    const std::string only = "move = { cloth = \"flag\", vertices = [0], to = [0, 1, 0], over = 0.5 }";
    CHECK(fault(gone + event(1, only)).find("vertex 0 of cloth 'flag'") != std::string::npos);
    const std::string towel = "move = { cloth = \"towel\", vertices = [0], to = [0, 1, 0], over = 0.5 }";
    CHECK(fault(event(1, towel)).find("vertex 0 of cloth 'towel'") != std::string::npos);
}

TEST_CASE("a vertex out of range is reported with the place of the event") {
    CHECK(fault(event(1, "unpin = { cloth = \"towel\", vertices = [9] }")) ==
          "t:13:1: event: vertices of cloth 'towel': vertex 9 is out of range; allowed: 0 ... 8");
}

TEST_CASE("a scene made in memory may name a cloth that is not there, which is reported") {
    Scene scene = two_cloths("");
    scene.events.push_back({.time = 0.0, .what = UnpinEvent{"curtain", VertexIndices{{0}}}, .place = {}});
    const std::vector<TriangleMesh> meshes = {make_grid(0.4, 0.3, 5, 4), make_grid(1, 1, 3, 3)};
    CHECK(error_of([&] { script_events(scene, meshes); }) == "event: no cloth 'curtain'");
}

}  // namespace percale::scenes::test::event_script_test
