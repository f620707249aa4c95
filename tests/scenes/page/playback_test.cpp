#include "scenes/page/playback.h"

#include <cmath>
#include <filesystem>

#include "tests/scenes/message_of.h"
#include "tests/scenes/page/packed_numbers.h"
#include "tests/scenes/page/written_run.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::playback_test {

namespace {

const RunCast sheet_and_ball = {.cloths = {"sheet"}, .obstacles = {"ball"}};

Playback read_falling(const TestFolder& folder, const std::vector<FrameRecord>& records, const PlaybackOptions& options = {}) {
    return read_playback(folder.path(), records, sheet_and_ball, options);
}

std::string refused_falling(const TestFolder& folder, const std::vector<FrameRecord>& records,
                            const PlaybackOptions& options = {}) {
    return message_of([&] { read_falling(folder, records, options); });
}

/// Values of a field of the first mesh, frame by frame.
std::vector<double> field_values(const Playback& playback, std::size_t field) {
    const PlaybackField& packed = playback.meshes.at(0).fields.at(field);
    std::vector<double> values;
    for (const std::uint32_t number : numbers_of_base64(packed.values, 2))
        values.push_back(packed.range.low + packed.range.step * number);
    return values;
}

}  // namespace

TEST_CASE("A playback holds cloth of every frame, and an obstacle that rests once") {
    const TestFolder folder;
    const Playback playback = read_falling(folder, write_falling_frames(folder, 4));
    CHECK(playback.choice.shown == std::vector<int>{0, 1, 2, 3});
    REQUIRE(playback.meshes.size() == 2);
    const PlaybackMesh &sheet = playback.meshes[0], &ball = playback.meshes[1];
    CHECK(sheet.name == "sheet");
    CHECK(sheet.is_cloth);
    CHECK(ball.name == "ball");
    CHECK_FALSE(ball.is_cloth);
    CHECK_FALSE(ball.moves);
    CHECK(ball.fields.empty());
    CHECK(numbers_of_base64(sheet.positions, 2).size() == 4 * 9 * 3);
    CHECK(numbers_of_base64(ball.positions, 2).size() == 3 * ball.vertices);
    CHECK(sheet.axes[1].low == Approx(0.7));
    CHECK(playback.rounding == Approx(0.5 * 0.3 / 65534).epsilon(1e-4));
}

TEST_CASE("Distance is measured and the change of edges is from frame 0 where frames have no fields") {
    const TestFolder folder;
    std::vector<FrameRecord> records = write_falling_frames(folder, 2);
    TriangleMesh wide = make_grid(0.22, 0.22, 3, 3);
    for (Vec3& x : wide.vertices) x.y() += 0.5;
    write_obj(folder.path("frames/sheet_1.obj"), wide.vertices, wide.triangles);
    const Playback playback = read_falling(folder, records);
    REQUIRE(playback.meshes[0].fields.size() == 2);
    CHECK(playback.meshes[0].fields[0].name == "edge_change");
    CHECK(playback.meshes[0].fields[1].name == "distance");
    CHECK_FALSE(playback.meshes[0].fields[1].of_frames);
    const std::vector<double> change = field_values(playback, 0), distance = field_values(playback, 1);
    for (int v = 0; v < 9; ++v) {
        CHECK(change[v] == Approx(0.0).margin(1e-5));
        CHECK(change[9 + v] == Approx(0.1).margin(1e-5));
    }
    // The middle of the sheet is straight above the ball, which is a polyhedron within its radius.
    CHECK(distance[4] == Approx(0.9).margin(0.01));
    CHECK(distance[13] == Approx(0.4).margin(0.01));
    const Playback without = read_falling(folder, records, {.distances = false});
    REQUIRE(without.meshes[0].fields.size() == 1);
}

TEST_CASE("Fields of PLY frames are shown as they are, and none takes their place") {
    const TestFolder folder;
    std::vector<FrameRecord> records = write_falling_frames(folder, 2);
    for (int i = 0; i < 2; ++i) {
        records[i].cloths = {"frames/sheet_" + std::to_string(i) + ".ply"};
        write_ply(folder.path(records[i].cloths[0]), make_grid(0.2, 0.2, 3, 3),
                  {.vertex = {{"strain_warp", std::vector<double>(9, 0.01 * i)}, {"distance", std::vector<double>(9, 0.5)}},
                   .triangle = {}});
    }
    const Playback playback = read_falling(folder, records);
    REQUIRE(playback.meshes[0].fields.size() == 2);
    CHECK(playback.meshes[0].fields[0].name == "strain_warp");
    CHECK(playback.meshes[0].fields[1].of_frames);
    CHECK(field_values(playback, 0)[17] == Approx(0.01).margin(1e-6));
}

TEST_CASE("Frames are left out to keep a size, and the sum of what is packed keeps it") {
    const TestFolder folder;
    const std::vector<FrameRecord> records = write_falling_frames(folder, 20);
    const auto size_of = [](const Playback& playback) {
        std::size_t size = 0;
        for (const PlaybackMesh& mesh : playback.meshes) {
            size += mesh.corners.size() + mesh.positions.size();
            for (const PlaybackField& field : mesh.fields) size += field.values.size();
        }
        return size;
    };
    const std::size_t all = size_of(read_falling(folder, records));
    for (const std::size_t most : {all, all - 1, all * 3 / 4, all * 2 / 3}) {
        const Playback playback = read_falling(folder, records, {.max_bytes = most, .worst_frame = 7});
        CHECK(size_of(playback) <= most);
        CHECK((playback.choice.every == 1) == (most == all));
        CHECK(std::ranges::count(playback.choice.shown, 7) == 1);
        CHECK(numbers_of_base64(playback.meshes[0].positions, 2).size() == playback.choice.shown.size() * 27);
    }
    CHECK(refused_falling(folder, records, {.max_bytes = 1000}).find(": the first and the last frame alone take 0.0") !=
          std::string::npos);
}

TEST_CASE("A run without frames plays nothing") {
    const TestFolder folder;
    const Playback playback = read_playback(folder.path(), std::vector<FrameRecord>(3), {}, {});
    CHECK(playback.meshes.empty());
    CHECK(playback.choice.shown.empty());
}

TEST_CASE("Frames that are missing, broken, of other formats or of other meshes are refused by name") {
    const TestFolder folder;
    std::vector<FrameRecord> records = write_falling_frames(folder, 3);
    const std::string last = folder.path("frames/sheet_2.obj");
    std::filesystem::remove(last);
    CHECK(refused_falling(folder, records) == last + ": is missing; report.json lists it");
    folder.write("frames/sheet_2.obj", "v 0 0\n");
    CHECK(refused_falling(folder, records).find(last + ":1: ") == 0);
    const TriangleMesh other = make_grid(0.2, 0.2, 3, 4);
    write_obj(last, other.vertices, other.triangles);
    CHECK(refused_falling(folder, records) == last + ": has 12 vertices, but 9 in frame 0 of the run");
    folder.write("frames/sheet.vtp", "x");
    records[2].cloths = {"frames/sheet.vtp"};
    CHECK(refused_falling(folder, records) == folder.path("frames/sheet.vtp") +
                                                  ": a page can show frames in OBJ and PLY only; "
                                                  "run the scene with --frames obj or --frames ply");
    records[2].cloths.clear();
    CHECK(refused_falling(folder, records) ==
          folder.path() + "/report.json: frame 2 lists 0 cloths and 1 obstacle, frame 0 1 and 1");
}

}  // namespace percale::scenes::test::playback_test
