#include "picture/picture.h"

#include <filesystem>

#include "meshes/obj_file.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/picture/png_reader.h"
#include "tests/scenes/picture/shown_shapes.h"
#include "tests/scenes/test_folder.h"

namespace percale::scenes::test::picture_test {
namespace {

FrameSource sheet_source(const TestFolder& folder, const ShownChoice& choice = {}) {
    const TriangleMesh sheet = make_grid(1, 1, 5, 5), ball = moved(make_sphere(0.3, 2), Vec3(0, -0.4, 0));
    write_obj(folder.path("sheet.obj"), sheet.vertices, sheet.triangles);
    write_obj(folder.path("ball.obj"), ball.vertices, ball.triangles);
    return FrameSource::of_meshes({folder.path("sheet.obj"), folder.path("ball.obj")}, choice);
}

}  // namespace

TEST_CASE("sizes are in their range, and grids make their cells large") {
    for (const auto& size : {std::pair(15, 100), std::pair(100, 8193), std::pair(8192, 4096)})
        CHECK(message_of([&] { check_picture_size(size.first, size.second); }).find("16 ... 8192") != std::string::npos);
    check_picture_size(4096, 4096);
    for (int cells = 1; cells < 50; ++cells) {
        const CellGrid grid = grid_for(cells, 1200, 900);
        CHECK(grid.columns * grid.rows >= cells);
        CHECK((grid.columns - 1) * grid.rows < cells + grid.rows);
    }
    CHECK(grid_for(6, 1200, 800).columns == 3);
    CHECK(grid_for(3, 300, 1200).columns == 1);
}

TEST_CASE("the camera is fitted to cloth and to what of bodies is near it, to bodies where there is no cloth") {
    ShownFrame frame{0,
                     0.0,
                     {shown(make_grid(1, 1, 3, 3), true), shown(moved(make_sphere(0.2, 0), Vec3(0, -1, 0)), false),
                      shown(moved(make_plane(50.0), Vec3(0, -2, 0)), false)}};
    CHECK(fitted_points(frame).size() == 9 + 12);
    frame.shapes.erase(frame.shapes.begin());
    CHECK(fitted_points(frame).size() == 12 + 4);
}

TEST_CASE("a picture has its size, its bar at the right, and reports the range") {
    if (!draws()) return;
    const TestFolder folder;
    PictureStyle style;
    style.width = 160;
    style.height = 120;
    style.field = &picture_field("distance");
    ShownChoice choice;
    choice.field = style.field;
    FrameSource source = sheet_source(folder, choice);
    double low = -1.0, high = -1.0;
    const auto keep = [&](const FieldRange& range) { low = range.low, high = range.high; };
    const Image picture = draw_picture({{&source, 0}}, {}, style, nullptr, {.range = keep});
    CHECK((picture.width == 160 && picture.height == 120));
    CHECK((low <= 100.0 && low > 0.0 && high > 300.0));
    style.range = {0.0, 1000.0};
    draw_picture({{&source, 0}}, {}, style, nullptr, {.range = keep});
    CHECK((low == 0.0 && high == 1000.0));
}

TEST_CASE("a sheet has a drawing and a label for each cell, each as if drawn alone") {
    if (!draws()) return;
    const TestFolder folder;
    FrameSource source = sheet_source(folder);
    PictureStyle style;
    style.width = 201;
    style.height = 100;
    style.background = Background::transparent;
    const Image sheet = draw_picture({{&source, 0, "0.00 s"}, {&source, 0, "0.50 s"}}, {2, 1}, style, nullptr);
    const int strip = 14, width = 100, height = 100 - strip;
    PictureStyle single = style;
    single.width = width;
    single.height = height;
    const Image alone = draw_picture({{&source, 0}}, {}, single, nullptr);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column)
            for (int k = 0; k < 4; ++k) CHECK_FALSE(sheet.at(column + 101, row)[k] != alone.at(column, row)[k]);
    int inked = 0;
    for (int row = height; row < 100; ++row)
        for (int column = 0; column < width; ++column) inked += sheet.at(column, row)[3] > 100 ? 1 : 0;
    CHECK(inked > 20);
}

TEST_CASE("cells without room, or more than the grid has, are refused") {
    if (!draws()) return;
    const TestFolder folder;
    FrameSource source = sheet_source(folder);
    const std::vector<PictureCell> cells(3, {&source, 0, "x"});
    PictureStyle style;
    CHECK(message_of([&] { draw_picture(cells, {2, 1}, style, nullptr); }).find("3 frames do not fit a sheet of 2x1") == 0);
    style.width = 40;
    CHECK(message_of([&] {
              draw_picture(cells, {3, 1}, style, nullptr);
          }).find("has no room for 3x1 drawings") != std::string::npos);
}

TEST_CASE("a movie is one picture a frame, numbered, and all or nothing") {
    if (!draws()) return;
    const TestFolder folder;
    FrameSource source = sheet_source(folder);
    PictureStyle style;
    style.width = style.height = 64;
    int last = 0;
    write_movie(folder.path("movie"), source, {0, 0, 0}, style, nullptr, {.done = [&](int done) { last = done; }});
    CHECK(last == 3);
    for (const char* name : {"movie/frame_00000.png", "movie/frame_00002.png"}) {
        const auto png = percale::scenes::test::read_png(folder.read(name));
        CHECK((png.width == 64 && png.height == 64));
    }
    CHECK(folder.read("movie/frame_00000.png") == folder.read("movie/frame_00001.png"));
    std::filesystem::create_directories(folder.path("broken/frame_00002.png"));
    const std::string message = message_of([&] { write_movie(folder.path("broken"), source, {0, 0, 0}, style, nullptr); });
    CHECK(message.find("frame_00002.png: cannot be written") != std::string::npos);
    CHECK_FALSE(folder.holds("broken/frame_00000.png"));
    CHECK_FALSE(folder.holds("broken/frame_00001.png"));
}

}  // namespace percale::scenes::test::picture_test
