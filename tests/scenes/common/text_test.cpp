#include "scenes/common/text.h"

#include <cstdlib>
#include <limits>
#include <random>

#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::text_test {

TEST_CASE("number texts are short") {
    CHECK(number_text(0.3) == "0.3");
    CHECK(number_text(0.0) == "0");
    CHECK(number_text(33.0) == "33");
    CHECK(number_text(-9.81) == "-9.81");
    CHECK(number_text(1e-6) == "1e-6");
    CHECK(number_text(1e6) == "1e6");
    CHECK(number_text(1e-14) == "1e-14");
    CHECK(number_text(1e20) == "1e20");
    CHECK(number_text(2.5e-103) == "2.5e-103");
    CHECK(number_text(std::numeric_limits<double>::infinity()) == "inf");
    CHECK(number_text(-std::numeric_limits<double>::infinity()) == "-inf");
    CHECK(number_text(std::numeric_limits<double>::quiet_NaN()) == "nan");
}

TEST_CASE("number texts read back as the same number") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> mantissa(-10.0, 10.0);
    std::uniform_int_distribution<int> exponent(-300, 300);
    for (int i = 0; i < 2000; ++i) {
        const double value = mantissa(random) * std::pow(10.0, exponent(random));
        REQUIRE(std::strtod(number_text(value).c_str(), nullptr) == value);
    }
}

TEST_CASE("fractions are written in per cent, however large") {
    CHECK(percent_text(0.0123) == "1.2 %");
    CHECK(percent_text(-0.5) == "-50 %");
    CHECK(percent_text(123.4) == "12340 %");
    CHECK(percent_text(1.28408e19) == "1.28e+21 %");
    CHECK(percent_text(std::numeric_limits<double>::infinity()) == "inf %");
}

TEST_CASE("a distance is written in metres, an infinite one in words") {
    CHECK(nearness_text(0.00321) == "smallest distance 0.00321 m");
    CHECK(nearness_text(0.0) == "smallest distance 0 m");
    CHECK(nearness_text(std::numeric_limits<double>::infinity()) == "never near");
}

TEST_CASE("hashes have 16 hexadecimal digits") {
    CHECK(hexadecimal(0) == "0000000000000000");
    CHECK(hexadecimal(123456789) == "00000000075bcd15");
    CHECK(hexadecimal(std::numeric_limits<std::uint64_t>::max()) == "ffffffffffffffff");
}

TEST_CASE("joined words have commas between them") {
    const std::string words[] = {"a", "b", "c"};
    CHECK(joined(words) == "a, b, c");
    CHECK(joined({}).empty());
}

TEST_CASE("short numbers have three digits, and one of a thing has no s") {
    CHECK(short_number(1.0 / 60.0) == "0.0167");
    CHECK(short_number(12345678.0) == "1.23e+07");
    CHECK(short_number(30.0) == "30");
    CHECK(short_number(1.0 / 60.0, 2) == "0.017");
    CHECK(short_number(12345678.0, 2) == "1.2e+07");
    CHECK(counted(1, "step") == "1 step");
    CHECK(counted(0, "step") == "0 steps");
    CHECK(counted(12, "step") == "12 steps");
}

TEST_CASE("a round step is the smallest of 1, 2, 5 times powers of ten that is not below, and its multiples have its digits") {
    CHECK(round_step(1.0) == 1.0);
    CHECK(round_step(1.01) == 2.0);
    CHECK(round_step(0.2) == Approx(0.2));
    CHECK(round_step(0.21) == Approx(0.5));
    CHECK(round_step(0.0051) == Approx(0.01));
    CHECK(round_step(600.0) == Approx(1000.0));
    CHECK(multiple_text(3.0 * 0.1, 0.1) == "0.3");
    CHECK(multiple_text(5.0 * 0.02, 0.02) == "0.10");
    CHECK(multiple_text(-0.0, 0.5) == "0.0");
    CHECK(multiple_text(20.0, 5.0) == "20");
    CHECK(multiple_text(3e-8, 1e-8) == "3e-08");
}

TEST_CASE("advice on a number with a decimal comma or a unit says how it is written") {
    CHECK(number_advice("0,005") == "; decimals take a point: 0.005");
    CHECK(number_advice(" -1,5 ") == "; decimals take a point: -1.5");
    CHECK(number_advice("5mm") == "; a number is written without its unit, in m: 0.005");
    CHECK(number_advice("1.5 cm") == "; a number is written without its unit, in m: 0.015");
    CHECK(number_advice("150g") == "; a number is written without its unit, in kg: 0.15");
    CHECK(number_advice("20 N/m") == "; a number is written without its unit: 20");
    CHECK(number_advice("1e999mm") == "; a number is written without its unit, in m: inf");
    for (const char* text : {"1.5,2", "1e3,5", "5", "+", "-+5 mm", "inf m", "5 !"}) CHECK(number_advice(text).empty());
    CHECK(number_advice("+.5 %") == "; a number is written without its unit: +.5");
    CHECK(number_advice(std::string(1000000, '1') + "mm").empty());
    for (const char* text : {"", "soft", "1,2,3", "a,b", "[1, 2]"}) CHECK(number_advice(text).empty());
}

}  // namespace percale::scenes::test::text_test
