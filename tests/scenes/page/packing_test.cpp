#include "scenes/page/packing.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/scenes/page/packed_numbers.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::packing_test {

TEST_CASE("Base64 is that of the examples of RFC 4648") {
    const std::vector<std::pair<std::string, std::string>> examples = {{"", ""},
                                                                       {"f", "Zg=="},
                                                                       {"fo", "Zm8="},
                                                                       {"foo", "Zm9v"},
                                                                       {"foob", "Zm9vYg=="},
                                                                       {"fooba", "Zm9vYmE="},
                                                                       {"foobar", "Zm9vYmFy"}};
    for (const auto& [bytes, text] : examples) {
        CHECK(base64(bytes) == text);
        CHECK(base64_size(bytes.size()) == text.size());
    }
}

TEST_CASE("All bytes go through base64 and back") {
    std::string bytes;
    for (int i = 0; i < 1000; ++i) bytes += static_cast<char>(i * 37 % 256);
    CHECK(bytes_of_base64(base64(bytes)) == bytes);
}

TEST_CASE("A packed number is off by half a step at most and the ends of its range are exact") {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-3.0f, 5.0f);
    std::vector<float> values(5000);
    for (float& value : values) value = place(random);
    const PackRange range = range_of(values);
    for (const float value : values)
        CHECK(std::abs(range.low + range.step * packed(value, range) - value) <= 0.5000001 * range.step);
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    CHECK(packed(*least, range) == 0);
    CHECK(packed(*most, range) == 65534);
    CHECK(range.low + range.step * 65534 == Approx(*most).epsilon(1e-12));
}

TEST_CASE("What is not finite is absent and does not widen the range") {
    constexpr float infinity = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
    const PackRange range = range_of(std::vector<float>{infinity, 1.0f, none, 2.0f, -infinity});
    CHECK(range.low == 1.0);
    CHECK(range.step == Approx(1.0 / 65534));
    for (const float value : {infinity, -infinity, none}) CHECK(packed(value, range) == packed_absent);
    const PackRange nothing = range_of(std::vector<float>{infinity});
    CHECK(nothing.low == 0.0);
    CHECK(nothing.step == 0.0);
}

TEST_CASE("Values that are all equal are packed as their lowest") {
    const PackRange range = range_of(std::vector<float>{0.25f, 0.25f});
    CHECK(range.low == 0.25);
    CHECK(packed(0.25, range) == 0);
}

}  // namespace percale::scenes::test::packing_test
