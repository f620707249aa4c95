#include "scenes/frames/vtp_frames.h"

#include <bit>

#include "scenes/common/bytes.h"
#include "scenes/frames/frame_folder.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::vtp_frames_test {
namespace {

/// The bytes of an array by its name, as its element says where they are.
std::string array_bytes(const std::string& file, const std::string& name) {
    const std::size_t element = file.find("Name=\"" + name + "\"");
    REQUIRE(element != std::string::npos);
    const std::size_t offset = std::stoul(file.substr(file.find("offset=\"", element) + 8));
    const std::size_t start = file.find("encoding=\"raw\">\n_") + 17 + offset;
    return file.substr(start + 8, little_at<std::uint64_t>(file.data() + start));
}

double double_at(const std::string& bytes, std::size_t k) {
    return std::bit_cast<double>(little_at<std::uint64_t>(bytes.data() + 8 * k));
}

}  // namespace

TEST_CASE("a VTP file has the points in double precision, the triangles and the fields") {
    const TestFolder folder;
    FrameFolder files(folder.path());
    std::vector<TriangleMesh> cloths = {make_grid(1.0 / 3.0, 1.0 / 7.0, 2, 3)};
    const std::vector<MeshFields> fields = {
        {.vertex = {{"distance", std::vector<double>(6, 0.1)}}, .triangle = {{"strain_warp", {1, 2, 3, 4}}}}};
    const FrameCast cast{.cloths = {"a<b"}, .obstacles = {"floor"}, .obstacle_moves = {false}};
    const auto encoder = vtp_frames().make(cast);
    const std::vector<TriangleMesh> obstacles = {make_plane(1.0)};
    for (const int index : {0, 1})
        encoder->write({.index = index, .cloths = cloths, .obstacles = obstacles, .cloth_fields = fields}, files);
    encoder->finish(std::vector<double>{0.0, 0.5}, files);
    files.finish();
    const std::string file = folder.read("frames/a<b_00001.vtp");
    const std::string points = array_bytes(file, "Points"), corners = array_bytes(file, "connectivity");
    REQUIRE(points.size() == 6 * 3 * 8);
    for (std::size_t v = 0; v < 6; ++v)
        for (int k = 0; k < 3; ++k) CHECK(double_at(points, 3 * v + k) == cloths[0].vertices[v][k]);
    REQUIRE(corners.size() == 4 * 3 * 4);
    for (std::size_t t = 0; t < 4; ++t)
        for (int k = 0; k < 3; ++k)
            CHECK(little_at<std::uint32_t>(corners.data() + 4 * (3 * t + k)) ==
                  static_cast<std::uint32_t>(cloths[0].triangles[t][k]));
    CHECK(little_at<std::uint32_t>(array_bytes(file, "offsets").data() + 12) == 12);
    CHECK(double_at(array_bytes(file, "distance"), 5) == 0.1);
    CHECK(double_at(array_bytes(file, "strain_warp"), 3) == 4.0);
    CHECK(file.find("<CellData>\n<DataArray type=\"Float64\" Name=\"strain_warp\"") != std::string::npos);
}

TEST_CASE("the collection lists every mesh of every frame with its time, an obstacle that rests always the same") {
    const TestFolder folder;
    FrameFolder files(folder.path());
    const FrameCast cast{.cloths = {"a<b"}, .obstacles = {"floor", "ball"}, .obstacle_moves = {false, true}};
    const auto encoder = vtp_frames().make(cast);
    encoder->finish(std::vector<double>{0.0, 0.25}, files);
    const std::string text = folder.read("frames/scene.pvd");
    for (const char* entry : {"timestep=\"0\" part=\"0\" name=\"a&lt;b\" file=\"a&lt;b_00000.vtp\"",
                              "timestep=\"0.25\" part=\"0\" name=\"a&lt;b\" file=\"a&lt;b_00001.vtp\"",
                              "timestep=\"0.25\" part=\"1\" name=\"floor\" file=\"../obstacles/floor_00000.vtp\"",
                              "timestep=\"0.25\" part=\"2\" name=\"ball\" file=\"../obstacles/ball_00001.vtp\""}) {
        CAPTURE(entry);
        CHECK(text.find(entry) != std::string::npos);
    }
    CHECK(encoder->first_frame_of("frames/scene.pvd") == 0);
    CHECK(encoder->first_frame_of("frames/a<b_00004.vtp") == 4);
    CHECK(encoder->is_made_at_end("frames/scene.pvd"));
}

}  // namespace percale::scenes::test::vtp_frames_test
