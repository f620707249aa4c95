#include "scenes/page/page_data.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"

namespace percale::scenes::test::page_data_test {

using nlohmann::json;

TEST_CASE("Meshes have the names of the settings, or of their files where the settings hold none") {
    FrameRecord first;
    first.cloths = {"frames/a_00000.obj", "frames/b_00000.obj"};
    first.obstacles = {"obstacles/c_00000.obj"};
    const RunCast reported =
        cast_of_report(R"({"settings": {"cloth": [{"name": "A"}, {"name": "B"}], "obstacle": [{"name": "C"}]}})", first);
    CHECK(reported.cloths == std::vector<std::string>{"A", "B"});
    CHECK(reported.obstacles == std::vector<std::string>{"C"});
    for (const char* report :
         {"{}", "[]", R"({"settings": 3})", R"({"settings": {"cloth": [{"name": "A"}], "obstacle": [1]}})"}) {
        const RunCast untold = cast_of_report(report, first);
        CHECK(untold.cloths == std::vector<std::string>{"a_00000", "b_00000"});
        CHECK(untold.obstacles == std::vector<std::string>{"c_00000"});
    }
}

TEST_CASE("The worst frame is the report's, as long as there is such a frame") {
    CHECK(worst_frame_of_report(R"({"worst_frame": 11})", 12) == 11);
    for (const char* report :
         {R"({"worst_frame": 12})", R"({"worst_frame": null})", R"({"worst_frame": -1})", R"({"worst_frame": 1.5})", "{}"})
        CHECK(worst_frame_of_report(report, 12) == -1);
}

TEST_CASE("A page is titled by its run, else by its scene") {
    CHECK(title_of_report(R"({"title": "a flag", "scene": "x/y.toml"})") == "a flag");
    CHECK(title_of_report(R"({"title": "", "scene": "x/y.toml"})") == "y");
    CHECK(title_of_report(R"({"title": 3})") == "run");
}

TEST_CASE("The data of a page holds the report without files and stitches, and null for what is not finite") {
    PageData data;
    data.report =
        R"({"status": "finished", "frames": [{"index": 0}], "seams": [{"name": "s", "stitches": [[0, 1, 1, 0.0], [2, 3, 3, 0.5]]}]})";
    data.records.resize(2);
    data.records[1].index = 1;
    data.records[1].time = 0.5;
    data.records[1].check.smallest_distance = 0.25;
    data.steps.steps = 4;
    data.steps.every = 2;
    data.steps.time = {0.1, 0.2};
    data.steps.columns = {{"newton", {1, 2}, {3, std::numeric_limits<double>::quiet_NaN()}}};
    data.playback.choice = {.every = 1, .shown = {0, 1}};
    PlaybackMesh mesh;
    mesh.name = "<script>";
    mesh.vertices = 3;
    mesh.fields.resize(1);
    mesh.fields[0].values = "AAAA";
    data.playback.meshes = {mesh};
    const json page = json::parse(page_json(data));
    CHECK(page["report"] == json::parse(R"({"status": "finished", "seams": [{"name": "s", "stitches": 2}]})"));
    CHECK(page["frames"][0]["smallest_distance"].is_null());
    CHECK(page["frames"][1]["smallest_distance"] == 0.25);
    CHECK(page["steps"]["columns"]["newton"] == json::parse(R"({"least": [1.0, 2.0], "most": [3.0, null]})"));
    CHECK(page["shown"] == json({0, 1}));
    CHECK(page["meshes"][0]["name"] == "<script>");
    const std::vector<PageBlob> blobs = page_blobs(data.playback);
    REQUIRE(blobs.size() == 3);
    CHECK(blobs[0].id == page["meshes"][0]["corners"]);
    CHECK(blobs[1].id == page["meshes"][0]["positions"]);
    CHECK(blobs[2].id == page["meshes"][0]["fields"][0]["values"]);
    CHECK(blobs[2].text == "AAAA");
}

}  // namespace percale::scenes::test::page_data_test
