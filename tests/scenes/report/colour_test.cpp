#include "report/colour.h"

#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::colour_test {

TEST_CASE("colours keep their bytes through linear light, and linear light follows the curve of sRGB") {
    for (int k = 0; k < 256; ++k) {
        const float encoded = static_cast<float>(k) / 255.0f;
        CHECK(srgb_of_linear(linear_of_srgb(encoded)) == Approx(encoded).margin(1e-6));
    }
    // Middle grey: a byte of 188 is half the light of white (IEC 61966-2-1).
    CHECK(linear_of_srgb(188.0f / 255.0f) == Approx(0.503).margin(0.001));
    const auto bytes = srgb_bytes(colour_of_hex("b53F00"));
    CHECK(bytes == std::array<std::uint8_t, 3>{0xb5, 0x3f, 0x00});
    CHECK(srgb_bytes(Colour(2.0f, -1.0f, 1.0f)) == std::array<std::uint8_t, 3>{255, 0, 255});
}

TEST_CASE("what is no colour is refused with an example") {
    using percale::scenes::test::message_of;
    for (const char* text : {"", "12345", "1234567", "12345g", "#12345"})
        CHECK(message_of([&] { colour_of_hex(text); }).find("six hexadecimal digits") != std::string::npos);
}

TEST_CASE("colours of the first sixteen cloths are distinct, from each other and from bodies") {
    for (std::size_t a = 0; a < 16; ++a) {
        for (std::size_t b = 0; b < a; ++b) CHECK((cloth_colour(a) - cloth_colour(b)).norm() > 0.04f);
        for (std::size_t b = 0; b < 4; ++b) CHECK((cloth_colour(a) - body_colour(b)).norm() > 0.1f);
    }
}

TEST_CASE("the rising ramp gets ever lighter, the diverging one is lightest in its middle") {
    const auto light = [](const Colour& colour) { return colour.dot(Colour(0.2126f, 0.7152f, 0.0722f)); };
    for (int k = 0; k < 100; ++k) {
        const double share = 0.01 * k;
        CHECK(light(ramp_colour(share + 0.01, false)) > light(ramp_colour(share, false)));
        CHECK(light(ramp_colour(share, true)) <= light(ramp_colour(0.5, true)));
    }
    CHECK(ramp_colour(-1.0, false) == ramp_colour(0.0, false));
    CHECK(ramp_colour(2.0, true) == ramp_colour(1.0, true));
}

}  // namespace percale::scenes::test::colour_test
