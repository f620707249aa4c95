#include "report/image.h"

#include "tests/scenes/message_of.h"
#include "tests/scenes/picture/png_reader.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::image_test {

TEST_CASE("colours blend over what is there by their cover, and nothing happens outside") {
    Image image(2, 2);
    blend(image, 0, 0, {200, 100, 0}, 0.5f);
    CHECK(image.at(0, 0)[0] == 200);  // over nothing the colour is whole, and half there
    CHECK(image.at(0, 0)[3] == 128);
    blend(image, 1, 1, {0, 0, 0}, 1.0f);
    blend(image, 1, 1, {255, 255, 255}, 0.25f);
    CHECK(image.at(1, 1)[0] == 64);
    CHECK(image.at(1, 1)[3] == 255);
    const std::vector<std::uint8_t> before = image.rgba;
    for (const int outside : {-1, 2}) {
        blend(image, outside, 0, {1, 2, 3}, 1.0f);
        blend(image, 0, outside, {1, 2, 3}, 1.0f);
    }
    CHECK((image.rgba == before));
}

TEST_CASE("a part is pasted where it belongs and refused where it does not fit") {
    Image whole(5, 4), part(2, 3);
    for (std::size_t k = 0; k < part.rgba.size(); ++k) part.rgba[k] = static_cast<std::uint8_t>(k + 1);
    paste(whole, part, 3, 1);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 5; ++column)
            CHECK(whole.at(column, row)[0] == (column >= 3 && row >= 1 ? *part.at(column - 3, row - 1) : 0));
    CHECK(message_of([&] { paste(whole, part, 4, 1); }).find("does not fit") != std::string::npos);
    CHECK(message_of([&] { paste(whole, part, 3, 2); }).find("does not fit") != std::string::npos);
}

TEST_CASE("a PNG holds its pixels, with transparency only where there is some") {
    if (!percale::scenes::test::draws()) return;
    const TestFolder folder;
    Image image(7, 5);
    for (std::size_t k = 0; k < image.rgba.size(); ++k) image.rgba[k] = static_cast<std::uint8_t>(k % 4 == 3 ? 255 : 37 * k);
    write_png(folder.path("opaque.png"), image);
    image.at(3, 2)[3] = 100;
    write_png(folder.path("clear.png"), image);
    const auto opaque = percale::scenes::test::read_png(folder.read("opaque.png"));
    const auto clear = percale::scenes::test::read_png(folder.read("clear.png"));
    CHECK(opaque.channels == 3);
    CHECK(clear.channels == 4);
    REQUIRE((opaque.width == 7 && opaque.height == 5));
    CHECK((clear.bytes == image.rgba));
    for (std::size_t k = 0; k < 35; ++k)
        for (std::size_t c = 0; c < 3; ++c) CHECK((opaque.bytes[3 * k + c] == image.rgba[4 * k + c]));
    CHECK(folder.file_count() == 2);
}

TEST_CASE("a PNG that cannot be written names the file and leaves nothing") {
    if (!percale::scenes::test::draws()) return;
    const TestFolder folder;
    const std::string file = folder.path("absent/a.png");
    CHECK(message_of([&] { write_png(file, Image(2, 2)); }).find("absent/a.png: cannot be written: ") != std::string::npos);
    CHECK(folder.file_count() == 0);
}

}  // namespace percale::scenes::test::image_test
