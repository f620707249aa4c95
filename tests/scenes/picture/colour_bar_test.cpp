#include "picture/colour_bar.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::colour_bar_test {

TEST_CASE("the numbers at a bar are multiples of its step, each where its value is") {
    const std::vector<BarNumber> numbers = bar_numbers({-0.4, 0.4, 0.2});
    const char* texts[] = {"-0.4", "-0.2", "0.0", "0.2", "0.4"};
    REQUIRE(numbers.size() == 5);
    for (std::size_t k = 0; k < 5; ++k) {
        CHECK(numbers[k].text == texts[k]);
        CHECK(numbers[k].share == Approx(0.25 * static_cast<double>(k)));
    }
    CHECK(bar_numbers({0.0, 3e6, 1e6}).back().text == "3e+06");
}

TEST_CASE("an end beyond which values lie says so, also where it is no round number") {
    const std::vector<BarNumber> numbers = bar_numbers({0.0, 250.0, 50.0, false, true});
    CHECK(numbers.front().text == "0");
    CHECK(numbers.back().text == "> 250");
    CHECK(numbers.back().share == 1.0);
    REQUIRE(numbers.size() == 6);
    const std::vector<BarNumber> odd = bar_numbers({0.9, 4.1, 1.0, true, true});
    CHECK(odd.front().text == "< 0.9");
    CHECK(odd.back().text == "> 4.1");
    CHECK(odd.size() == 4);  // 1 and 4 would lie on the ends
}

TEST_CASE("the bar has the colours of its values, high above low, inside its strip") {
    Image picture(400, 600);
    const FieldRange range{0.0, 10.0, 2.0};
    draw_colour_bar(picture, picture_field("strain_warp"), range);
    const int left = 400 - colour_bar_width(600);
    for (int row = 0; row < 600; ++row)
        for (int column = 0; column < left - 2; ++column) CHECK_FALSE(picture.at(column, row)[3] != 0);
    const auto colour_at = [&](double share) {
        const std::uint8_t* pixel = picture.at(left + 3, static_cast<int>(0.76 * 600 - share * 0.5 * 600));
        return Bytes3{pixel[0], pixel[1], pixel[2]};
    };
    for (const double share : {0.1, 0.5, 0.9}) {
        const Bytes3 expected = srgb_bytes(ramp_colour(share, false)), seen = colour_at(share);
        for (std::size_t k = 0; k < 3; ++k) CHECK(seen[k] == Approx(expected[k]).margin(3.0));
    }
}

}  // namespace percale::scenes::test::colour_bar_test
