#include "export/frames.h"

#include <filesystem>
#include <fstream>

#include "meshes/obj_file.h"
#include "percale/error.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::frames_test {
namespace {

ClothSpec cloth(const std::string& name) {
    ClothSpec spec;
    spec.name = name;
    return spec;
}

ObstacleSpec obstacle(const std::string& name, int keyframes) {
    ObstacleSpec spec;
    spec.name = name;
    for (int i = 0; i < keyframes; ++i) spec.motion.push_back({static_cast<double>(i), Vec3(i, 0.0, 0.0), {}});
    return spec;
}

Scene scene_with(std::vector<ClothSpec> cloths, std::vector<ObstacleSpec> obstacles) {
    Scene scene;
    scene.cloths = std::move(cloths);
    scene.obstacles = std::move(obstacles);
    return scene;
}

/// Coordinates with no short decimal form.
TriangleMesh crooked(double shift) {
    TriangleMesh mesh = make_sphere(1.0 / 3.0, 1);
    for (Vec3& x : mesh.vertices) x = x / 7.0 + Vec3::Constant(shift);
    return mesh;
}

TriangleMesh read_back(const std::string& file) {
    std::ifstream in(file);
    return read_obj(in, file);
}

}  // namespace

TEST_CASE("frames are named after their cloth and number, and read back with the same bits") {
    const TestFolder folder;
    FrameWriter writer(folder.path("out"), scene_with({cloth("shirt"), cloth("skirt")}, {}));
    Frame frame;
    frame.index = 12;
    frame.time = 0.4;
    frame.cloths = {crooked(0.1), crooked(0.2)};
    frame.check.intersections = 3;
    const FrameRecord record = writer.write(frame);
    CHECK(record.index == 12);
    CHECK(record.time == 0.4);
    CHECK(record.check.intersections == 3);
    CHECK(record.cloths == std::vector<std::string>{"frames/shirt_00012.obj", "frames/skirt_00012.obj"});
    CHECK(record.obstacles.empty());
    for (std::size_t i = 0; i < 2; ++i) {
        const TriangleMesh mesh = read_back(folder.path("out/" + record.cloths[i]));
        CHECK(mesh.vertices == frame.cloths[i].vertices);
        CHECK(mesh.triangles == frame.cloths[i].triangles);
    }
    CHECK(folder.file_count() == 2);
}

TEST_CASE("a resting obstacle is written once, a moving one in every frame") {
    const TestFolder folder;
    FrameWriter writer(folder.path(), scene_with({cloth("sheet")}, {obstacle("floor", 0), obstacle("ball", 2)}));
    Frame frame;
    frame.cloths = {crooked(0.0)};
    frame.obstacles = {crooked(0.3), crooked(0.4)};
    FrameRecord record;
    for (frame.index = 0; frame.index < 3; ++frame.index) {
        frame.obstacles[1] = crooked(0.4 + 0.1 * frame.index);
        record = writer.write(frame);
    }
    CHECK(record.obstacles == std::vector<std::string>{"obstacles/floor_00000.obj", "obstacles/ball_00002.obj"});
    CHECK(folder.holds("obstacles/ball_00000.obj"));
    CHECK(folder.holds("obstacles/ball_00001.obj"));
    CHECK_FALSE(folder.holds("obstacles/floor_00001.obj"));
    CHECK(read_back(folder.path("obstacles/ball_00002.obj")).vertices == frame.obstacles[1].vertices);
    CHECK(folder.file_count() == 3 + 1 + 3);
}

TEST_CASE("names that cannot be part of a file name are refused before anything is written") {
    const TestFolder folder;
    const auto refused = [&](const std::string& name) {
        CHECK_THROWS_AS(FrameWriter(folder.path(), scene_with({cloth(name)}, {})), SceneError);
        CHECK_THROWS_AS(FrameWriter(folder.path(), scene_with({}, {obstacle(name, 0)})), SceneError);
    };
    for (const char* name : {"", "../sheet", "a/b", "a\\b", ".hidden", "two\nlines"}) refused(name);
    refused(std::string("nul\0", 4));
    CHECK_NOTHROW(FrameWriter(folder.path(), scene_with({cloth("table cloth 2.0")}, {obstacle("table cloth 2.0", 0)})));
    CHECK(folder.file_count() == 0);
}

TEST_CASE("two cloths of the same name would overwrite each other and are refused") {
    const TestFolder folder;
    CHECK_THROWS_WITH(FrameWriter(folder.path(), scene_with({cloth("a"), cloth("b"), cloth("a")}, {})),
                      Catch::Contains("'a'") && Catch::Contains("twice"));
}

TEST_CASE("a folder that cannot be made is named") {
    const TestFolder folder;
    folder.write("out", "a file");
    FrameWriter writer(folder.path("out"), scene_with({cloth("sheet")}, {}));
    Frame frame;
    frame.cloths = {crooked(0.0)};
    CHECK_THROWS_WITH(writer.write(frame), Catch::Contains("out/frames"));
}

TEST_CASE("frames of a scene are distinguished from other files by name and number, whole or not") {
    const TestFolder folder;
    std::filesystem::create_directories(folder.path("frames"));
    std::filesystem::create_directories(folder.path("obstacles"));
    for (const std::string name :
         {"frames/shirt_00002.obj", "frames/shirt_00003.obj", "frames/shirt_100000.obj.part", "frames/shirt_3.obj",
          "frames/shirt_00003.stl", "frames/shirt_00003.ply", "frames/shirts_00003.obj", "frames/shirt_0000x.obj",
          "obstacles/ball_00000.obj", "obstacles/ball_00005.obj"})
        folder.write(name, "");
    const FrameWriter writer(folder.path(), scene_with({cloth("shirt")}, {obstacle("ball", 2)}));
    writer.remove_from(3);
    CHECK(folder.file_count() == 6);
    for (const std::string name : {"shirt_00002.obj", "shirt_3.obj", "shirt_00003.stl", "shirts_00003.obj", "shirt_0000x.obj"})
        CHECK(folder.holds("frames/" + name));
    CHECK(folder.holds("obstacles/ball_00000.obj"));
    writer.remove_from(0);
    CHECK(folder.file_count() == 4);
}

TEST_CASE("a record names the files of a format that certify reads, with fields of one that holds them, and all others beside") {
    const TestFolder folder;
    const auto record_of = [&](const std::vector<std::string>& words, const std::vector<std::string>& fields) {
        Scene scene = scene_with({cloth("sheet")}, {});
        scene.output.frames = words;
        scene.output.fields = fields;
        FrameWriter writer(folder.path(), scene);
        Frame frame;
        frame.cloths = {crooked(0.0)};
        const FrameRecord record = writer.write(frame);
        writer.finish(std::vector<double>{0.0});
        return record;
    };
    const FrameRecord plain = record_of({"pc2", "obj", "ply"}, {});
    CHECK(plain.cloths == std::vector<std::string>{"frames/sheet_00000.obj"});
    CHECK(plain.others == std::vector<std::string>{"frames/sheet_00000.ply", "frames/sheet.mesh.obj", "frames/sheet.pc2"});
    CHECK(record_of({"pc2", "obj", "ply"}, {"strain"}).cloths == std::vector<std::string>{"frames/sheet_00000.ply"});
    CHECK(record_of({"pc2"}, {}).cloths == std::vector<std::string>{"frames/sheet.pc2"});
    CHECK(record_of({"none"}, {}).cloths.empty());
}

}  // namespace percale::scenes::test::frames_test
