#include "percale/saved_state.h"

#include <limits>

#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::saved_state_test {

enum class Colour { red, green, blue };

/// One value of every type that can be saved.
struct Everything {
    double number = 0.0;
    float small = 0.0F;
    int whole = 0;
    bool flag = false;
    Colour colour = Colour::red;
    Vec3 point = Vec3::Zero();
    Pose pose;
    std::string text;
    std::optional<Vec3> maybe, never;
    std::array<int, 3> three{};
    std::vector<double> numbers;
    std::vector<Vec3> points;
    std::vector<std::string> texts;
};

template <class Archive, OfType<Everything> Value>
void exchange(Archive& archive, Value& e) {
    archive(e.number, e.small, e.whole, e.flag);
    archive.choice(e.colour, 3);
    archive(e.point, e.pose, e.text, e.maybe, e.never, e.three, e.numbers, e.points, e.texts);
}

namespace {

constexpr SealKind test_seal{.name = "TESTSEAL", .version = 3, .words = "test state"};

Everything some() {
    return {.number = 0.1,
            .small = -3e-30F,
            .whole = -7,
            .flag = true,
            .colour = Colour::blue,
            .point = {1, -0.0, 1e300},
            .pose = {.translation = {1, 2, 3}, .rotation = {0.6, 0, 0.8, 0}, .scale = 2},
            .text = "a b",
            .maybe = Vec3(4, 5, 6),
            .never = {},
            .three = {1, 2, 3},
            .numbers = {std::numeric_limits<double>::infinity(), 5e-324},
            .points = {{7, 8, 9}},
            .texts = {"", "x"}};
}

std::vector<std::byte> bytes_of(const Everything& everything) {
    StateWriter writer;
    writer(everything);
    return writer.take();
}

}  // namespace

TEST_CASE("Every bit of a value is restored") {
    const std::vector<std::byte> bytes = bytes_of(some());
    StateReader reader(bytes);
    Everything back;
    back.never = Vec3::Ones();
    reader(back);
    CHECK(reader.at_end());
    CHECK(bytes_of(back) == bytes);
    CHECK(back.number == 0.1);
    CHECK(back.colour == Colour::blue);
    CHECK(back.pose == some().pose);
    CHECK(back.text == "a b");
    CHECK(back.maybe == Vec3(4, 5, 6));
    CHECK_FALSE(back.never.has_value());
    CHECK(back.numbers == some().numbers);
    CHECK(back.texts == some().texts);
}

TEST_CASE("Bytes that end too early are refused wherever they end") {
    const std::vector<std::byte> bytes = bytes_of(some());
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        StateReader reader({bytes.data(), length});
        Everything back;
        CHECK_THROWS_AS(reader(back), SceneError);
    }
}

TEST_CASE("A count of more than there can be is refused before any memory is asked for") {
    for (const std::uint64_t count : {std::uint64_t{2}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
        StateWriter writer;
        writer(count, 1.0);
        const std::vector<std::byte> bytes = writer.take();
        std::vector<double> numbers;
        StateReader reader(bytes);
        CHECK(mentions(scene_error([&] { reader(numbers); }), {"saved state", "too early", "of 16"}));
        CHECK(numbers.capacity() < 100);
    }
}

TEST_CASE("Bytes that no writer produces are refused") {
    StateWriter writer;
    writer(std::uint8_t{2}, 0, 3);
    const std::vector<std::byte> bytes = writer.take();
    bool flag = false;
    StateReader reader(bytes);
    CHECK(mentions(scene_error([&] { reader(flag); }), {"neither true nor false"}));
    Colour colour = Colour::red;
    StateReader choices({bytes.data() + 5, 4});
    CHECK(mentions(scene_error([&] { choices.choice(colour, 3); }), {"no such choice"}));
}

TEST_CASE("A seal distinguishes its content from other kinds and versions and from truncated or damaged bytes") {
    const std::vector<std::byte> content = bytes_of(some());
    const std::vector<std::byte> good = sealed(test_seal, content);
    const std::span<const std::byte> back = unsealed(test_seal, good);
    CHECK(std::vector<std::byte>(back.begin(), back.end()) == content);
    const auto fault = [&](const SealKind& kind, const std::vector<std::byte>& bytes) {
        return scene_error([&] { unsealed(kind, bytes); });
    };
    CHECK(mentions(fault({"OTHERONE", 3, "test state"}, good), {"test state: it is none"}));
    CHECK(mentions(fault({"TESTSEAL", 4, "test state"}, good), {"of version 3", "reads version 4"}));
    CHECK(mentions(fault(test_seal, {}), {"empty"}));
    for (std::size_t length = 1; length < good.size(); ++length) {
        CHECK_FALSE(fault(test_seal, {good.begin(), good.begin() + static_cast<long>(length)}).empty());
    }
    for (std::size_t at = 0; at < good.size(); ++at) {
        std::vector<std::byte> bad = good;
        bad[at] ^= std::byte{0x10};
        CHECK_FALSE(fault(test_seal, bad).empty());
    }
    std::vector<std::byte> longer = good;
    longer.push_back(std::byte{0});
    CHECK(mentions(fault(test_seal, longer), {"cut off or not all of it"}));
}

}  // namespace percale::test::saved_state_test
