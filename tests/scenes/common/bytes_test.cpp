#include "scenes/common/bytes.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::bytes_test {

TEST_CASE("numbers lie in files with their lowest byte first, or their highest, whatever the machine") {
    std::string bytes;
    append_little(bytes, std::uint32_t{0x01020304});
    append_big(bytes, std::uint32_t{0x01020304});
    append_little(bytes, std::uint16_t{0xfffe});
    CHECK(bytes == std::string("\4\3\2\1\1\2\3\4\xfe\xff"));
    CHECK(little_at<std::uint32_t>(bytes.data()) == 0x01020304u);
    CHECK(little_at<std::uint16_t>(bytes.data() + 8) == 0xfffeu);
}

TEST_CASE("real numbers are those of IEEE 754: 1 is 3f800000, -2.5 is c0040000 00000000") {
    std::string bytes;
    append_float(bytes, 1.0);
    append_big_float(bytes, 1.0);
    append_double(bytes, -2.5);
    CHECK(bytes == std::string("\0\0\x80\x3f\x3f\x80\0\0\0\0\0\0\0\0\x04\xc0", 16));
    CHECK(float_at(bytes.data()) == 1.0f);
    bytes.clear();
    append_float(bytes, 0.1);
    CHECK(float_at(bytes.data()) == 0.1f);
}

}  // namespace percale::scenes::test::bytes_test
