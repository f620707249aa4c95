#include "scenes/format/script_tables.h"

#include <limits>

#include "scenes/format/scene_file.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::script_tables_test {
namespace {

const double infinity = std::numeric_limits<double>::infinity();

EventSpec event(const std::string& text) { return read_spec(parse_toml("time = 1.5\n" + text, "t"), event_table()); }

std::vector<Expectation> expectations(const std::string& text) {
    Scene scene;
    FaultList first(false);
    expect_field().read(parse_toml(text, "t"), scene, first);
    return scene.expectations;
}
Expectation expectation(const std::string& text) { return expectations(text).at(0); }

}  // namespace

TEST_CASE("a seam is read with its pairs, and sews at once where that is said") {
    const SeamSpec seam =
        read_spec(parse_toml("cloths = [\"a\", \"b\"]\nvertices = [[1, 2], [3, 4]]\nduration = 0\n", "t"), seam_table());
    CHECK(seam.cloths == std::array<std::string, 2>{"a", "b"});
    CHECK(seam.vertices == std::vector<std::array<int, 2>>{{1, 2}, {3, 4}});
    CHECK(seam.duration == 0.0);
    CHECK(seam.stiffness == SeamSpec{}.stiffness);
    CHECK_FALSE(seam.points);
    CHECK(seam.file.empty());
}

TEST_CASE("a pair of cloths is read, and says something") {
    const PairSpec pair = read_spec(parse_toml("cloths = [\"a\", \"b\"]\nthickness = 0.003\n", "t"), pair_table());
    CHECK(pair.cloths == std::array<std::string, 2>{"a", "b"});
    CHECK(pair.contact);
    CHECK(pair.thickness == 0.003);
    CHECK_FALSE(read_spec(parse_toml("cloths = [\"a\", \"a\"]\ncontact = false\n", "t"), pair_table()).contact);
    const std::string text = sheet_on_box() + "[[pair]]\ncloths = [\"sheet\", \"sheat\"]\ncontact = false\n";
    CHECK(message_of([&] { parse_scene(text, "t"); }).find("pair: no cloth 'sheat'") != std::string::npos);
}

TEST_CASE("a seam is read with points of edges and with a file, its cloths left open, and needs one of the three") {
    const SeamSpec seam =
        read_spec(parse_toml("points = [[1, 2, 3, 0.25]]\nfile = \"mesh\"\nname = \"hem\"\n", "t"), seam_table());
    CHECK_FALSE(seam.cloths);
    CHECK_FALSE(seam.vertices);
    CHECK(seam.points == std::vector<Stitch>{{1, 2, 3, 0.25}});
    CHECK(seam.file == "mesh");
    CHECK(seam.name == "hem");
    CHECK(error_of([] {
              read_spec(parse_toml("duration = 1\n", "t"), seam_table());
          }).find("seam lacks 'vertices', 'points' or 'file'") != std::string::npos);
}

TEST_CASE("every kind of event is read") {
    const EventSpec pin = event("pin = { cloth = \"flag\", vertices = [1] }\n");
    CHECK(pin.time == 1.5);
    CHECK(std::get<PinEvent>(pin.what).cloth == "flag");
    CHECK(std::get<VertexIndices>(std::get<PinEvent>(pin.what).vertices).vertices == std::vector<int>{1});
    const EventSpec unpin = event("unpin = { cloth = \"flag\", vertices = \"boundary\" }\n");
    CHECK(std::holds_alternative<VertexBoundary>(std::get<UnpinEvent>(unpin.what).vertices));
    const EventSpec move = event("move = { cloth = \"flag\", vertices = [1], to = [0, 1, 0], over = 0.5 }\n");
    CHECK(std::get<MoveEvent>(move.what).to == Vec3(0, 1, 0));
    CHECK(std::get<MoveEvent>(move.what).over == 0.5);
    CHECK(std::get<GravityEvent>(event("gravity = [0, 1, 0]\n").what).gravity == Vec3(0, 1, 0));
}

TEST_CASE("an event is one thing") {
    CHECK(error_of([] { event(""); }).find("event must have exactly one of pin, unpin, move, gravity, wind; it has none") !=
          std::string::npos);
    CHECK(error_of([] {
              event("gravity = [0, 0, 0]\npin = { cloth = \"flag\", vertices = [1] }\n");
          }).find("it has pin, gravity") != std::string::npos);
}

TEST_CASE("the forms of an expectation become limits") {
    const Expectation equal = expectation("intersections = 0\n");
    CHECK(equal.measure == "intersections");
    CHECK(equal.lowest == 0.0);
    CHECK(equal.highest == 0.0);
    CHECK((equal.lowest_included && equal.highest_included));
    const Expectation below = expectation("largest_strain = { below = 0.3 }\n");
    CHECK(below.lowest == -infinity);
    CHECK(below.highest == 0.3);
    CHECK_FALSE(below.highest_included);
    const Expectation above = expectation("smallest_distance = { above = 0.1 }\n");
    CHECK(above.lowest == 0.1);
    CHECK_FALSE(above.lowest_included);
    CHECK(above.highest == infinity);
    CHECK(above.highest_included);
    const Expectation between = expectation("lowest_vertex = { between = [0.1, 0.2] }\n");
    CHECK(between.lowest == 0.1);
    CHECK(between.highest == 0.2);
    CHECK((between.lowest_included && between.highest_included));
    const Expectation matches = expectation("matches = { file = \"a.obj\", within = 1e-3 }\n");
    CHECK(matches.file == "a.obj");
    CHECK(matches.highest == 1e-3);
    CHECK(matches.highest_included);
}

TEST_CASE("tables of expectations have each their time, and are written as they were read") {
    const std::string text =
        small_scene() +
        "[[expect]]\nintersections = 0\n[[expect]]\nat = 1.5\nlowest_vertex = { above = 0.1 }\n"
        "speed_at_end = { below = 1.0 }\n[[expect]]\nduring = [0.5, 1.0]\nlargest_strain = { below = 0.2 }\n";
    const Scene scene = parse_scene(text, "t");
    REQUIRE(scene.expectations.size() == 4);
    CHECK_FALSE(scene.expectations[0].at.has_value());
    CHECK(scene.expectations[1].at == 1.5);
    CHECK(scene.expectations[2].at == 1.5);
    CHECK(scene.expectations[3].during == std::array{0.5, 1.0});
    const TomlNode node = *expect_field().write(scene);
    REQUIRE(node.items.size() == 3);
    CHECK(node.items[1].entries.size() == 3);
    Scene again;
    FaultList faults(false);
    expect_field().read(node, again, faults);
    REQUIRE(again.expectations.size() == 4);
    CHECK(again.expectations[2].at == 1.5);
    CHECK(again.expectations[3].highest == 0.2);
    const Scene twice = parse_scene(small_scene() +
                                        "[[expect]]\nlowest_vertex = { above = 0.1 }\n"
                                        "[[expect]]\nlowest_vertex = { above = 0.2 }\n",
                                    "t");
    CHECK(expect_field().write(twice)->items.size() == 2);
    CHECK_THROWS_WITH(parse_scene(small_scene() + "[[expect]]\nat = 1.0\nduring = [0, 1]\n", "t"),
                      Catch::Contains("exclude each other"));
    CHECK_THROWS_WITH(parse_scene(small_scene() + "[[expect]]\nduring = [2, 1]\n", "t"),
                      Catch::Contains("ends before it begins"));
    CHECK_THROWS_WITH(parse_scene(small_scene() + "[[expect]]\nwhen = 1.0\n", "t"), Catch::Contains("unknown key 'when'"));
}

TEST_CASE("expectations keep the order of the file and know their places") {
    const auto list = expectations("speed_at_end = 0\nintersections = 0\n");
    REQUIRE(list.size() == 2);
    CHECK(list[0].measure == "speed_at_end");
    CHECK(list[1].measure == "intersections");
    CHECK(list[1].place.line == 2);
}

}  // namespace percale::scenes::test::script_tables_test
