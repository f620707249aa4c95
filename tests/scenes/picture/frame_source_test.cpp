#include "picture/frame_source.h"

#include "meshes/obj_file.h"
#include "meshes/ply_output.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/picture/shown_shapes.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::frame_source_test {
namespace {

/// A run of three frames, with a body that rests: a report that lists what is there.
std::string run_folder(const TestFolder& folder, const std::string& ending = ".ply") {
    std::string frames;
    for (const char* name : {"frames", "obstacles"}) std::filesystem::create_directories(folder.path(name));
    write_ply(folder.path("obstacles/ball_00000.ply"), make_sphere(0.3, 1));
    for (int k = 0; k < 3; ++k) {
        const std::string number = "0000" + std::to_string(k);
        const TriangleMesh mesh = moved(make_grid(1, 1, 3, 3), Vec3(0, 0.5 - 0.1 * k, 0));
        write_ply(folder.path("frames/my_sheet_" + number + ".ply"), mesh, {{{"pressure", std::vector<double>(9, 2.0 * k)}}, {}});
        frames += std::string(k == 0 ? "" : ",") + "{\"index\": " + std::to_string(k) +
                  ", \"time\": " + std::to_string(0.25 * k) + ", \"cloths\": [\"frames/my_sheet_" + number + ending +
                  "\"], \"obstacles\": [\"obstacles/ball_00000.ply\"]," +
                  "\"intersections\": 0, \"touching_pairs\": 0, \"vertices_inside\": 0, \"deepest_penetration\": 0," +
                  "\"smallest_distance\": null}";
    }
    folder.write("report.json", "{\"frames\": [" + frames + "]}");
    return folder.path();
}

}  // namespace

TEST_CASE("the frames of a run are read with names, roles, times and colours") {
    const TestFolder folder;
    FrameSource source = FrameSource::of_run(run_folder(folder), {});
    CHECK(source.count() == 3);
    CHECK(source.time(2) == 0.5);
    const ShownFrame frame = source.load(2);
    CHECK(frame.index == 2);
    REQUIRE(frame.shapes.size() == 2);
    CHECK((frame.shapes[0].name == "my_sheet" && frame.shapes[0].is_cloth));
    CHECK((frame.shapes[1].name == "ball" && !frame.shapes[1].is_cloth));
    CHECK(frame.shapes[0].mesh.vertices[0].y() == Approx(0.3));
    CHECK(frame.shapes[0].colour == cloth_colour(0));
    CHECK(frame.shapes[1].colour == body_colour(0));
    CHECK(source.load(0).shapes[0].mesh.vertices[0].y() == Approx(0.5));
    CHECK(source.nearest_frame(0.3) == 1);
    CHECK(source.nearest_frame(0.125) == 0);
    CHECK(source.nearest_frame(9.0) == 2);
}

TEST_CASE("a field comes from the frames' PLY files, distance also from the shapes, hidden bodies included") {
    const TestFolder folder;
    const std::string path = run_folder(folder);
    ShownChoice choice;
    choice.field = &picture_field("pressure");
    CHECK(FrameSource::of_run(path, choice).load(2).shapes[0].field == std::vector<double>(9, 4.0));
    choice.field = &picture_field("distance");
    choice.hidden = {"ball"};
    const ShownFrame frame = FrameSource::of_run(path, choice).load(0);
    REQUIRE(frame.shapes.size() == 1);
    CHECK(frame.shapes[0].field[4] == Approx(200.0).margin(10.0));
    choice.field = &picture_field("strain_warp");
    const std::string message = message_of([&] { FrameSource::of_run(path, choice).load(0); });
    CHECK(message.find("my_sheet_00000.ply: has no strain_warp; run the scene with output.fields = [\"strain\"]") !=
          std::string::npos);
}

TEST_CASE("names that no shape has, and frames that cannot be drawn, are refused") {
    const TestFolder folder;
    const std::string path = run_folder(folder);
    CHECK(message_of([&] { FrameSource::of_run(path, {nullptr, {"bal"}, {}}); }).find("--hide bal: no cloth or body of") == 0);
    CHECK(message_of([&] {
              FrameSource::of_run(path, {nullptr, {"bal"}, {}});
          }).find("did you mean 'ball'?") != std::string::npos);
    CHECK(message_of([&] { FrameSource::of_run(path, {nullptr, {}, {{"shet", Colour::Ones()}}}); }).find("--colour shet") == 0);
    CHECK(message_of([&] {
              FrameSource::of_run(path, {nullptr, {"ball", "my_sheet"}, {}}).load(0);
          }).find("all shapes") != std::string::npos);
    const TestFolder other;
    run_folder(other, ".pc2");
    CHECK(message_of([&] { FrameSource::of_run(other.path(), {}); })
              .find(".pc2: of frames in this format no picture can be made; "
                    "write obj or ply too, as by --frames obj,pc2") != std::string::npos);
    const TestFolder empty;
    CHECK(message_of([&] { FrameSource::of_run(empty.path(), {}); }).find("report.json") != std::string::npos);
    empty.write("report.json", "{\"frames\": []}");
    CHECK(message_of([&] { FrameSource::of_run(empty.path(), {}); }).find("lists no frames") != std::string::npos);
}

TEST_CASE("a mesh that moves by itself is drawn as it stands, and that is said") {
    const FrameSource source = FrameSource::of_meshes({PERCALE_DATA_DIR "/meshes/mannequin.glb"}, {});
    REQUIRE(source.warnings().size() == 1);
    CHECK(source.warnings()[0].kind == "left_out");
    CHECK(source.warnings()[0].place.ends_with("mannequin.glb"));
}

TEST_CASE("meshes are one frame, of which closed ones are bodies unless there are several and all are") {
    const TestFolder folder;
    const TriangleMesh ball = make_sphere(0.3, 1), sheet = make_grid(1, 1, 3, 3);
    write_obj(folder.path("ball.obj"), ball.vertices, ball.triangles);
    write_obj(folder.path("sheet.obj"), sheet.vertices, sheet.triangles);
    write_obj(folder.path("other.obj"), ball.vertices, ball.triangles);
    ShownChoice choice{nullptr, {}, {{"sheet", Colour(0.1f, 0.2f, 0.3f)}}};
    FrameSource both = FrameSource::of_meshes({folder.path("ball.obj"), folder.path("sheet.obj")}, choice);
    CHECK(both.count() == 1);
    const ShownFrame frame = both.load(0);
    CHECK((!frame.shapes[0].is_cloth && frame.shapes[1].is_cloth));
    CHECK(frame.shapes[1].colour == Colour(0.1f, 0.2f, 0.3f));
    CHECK_FALSE(FrameSource::of_meshes({folder.path("ball.obj")}, {}).load(0).shapes[0].is_cloth);
    CHECK(FrameSource::of_meshes({folder.path("ball.obj"), folder.path("other.obj")}, {}).load(0).shapes[1].is_cloth);
    CHECK(message_of([&] { FrameSource::of_meshes({folder.path("absent.off")}, {}); }).find("absent.off: no such file") !=
          std::string::npos);
}

}  // namespace percale::scenes::test::frame_source_test
