#include "picture/picture_field.h"

#include <cmath>
#include <limits>

#include "tests/scenes/message_of.h"
#include "tests/scenes/picture/shown_shapes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::picture_field_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

FieldSpread spread_of_values(const std::vector<double>& values) {
    ShownShape shape = shown(make_grid(1, 1, 2, 2), true);
    shape.field = values;
    FieldSpread spread;
    spread.add({0, 0.0, {shape}});
    return spread;
}

}  // namespace

TEST_CASE("values of a file are shown in their unit, strain as the larger one of warp and weft") {
    const MeshFields file{{{"strain_warp", {0.01, -0.02}}, {"strain_weft", {0.03, -0.05}}, {"pressure", {5.0, 0.0}}}, {}};
    CHECK(values_of_file(picture_field("strain"), file) == std::vector<double>{100.0 * 0.03, 100.0 * -0.02});
    CHECK(values_of_file(picture_field("strain_weft"), file) == std::vector<double>{100.0 * 0.03, 100.0 * -0.05});
    CHECK(values_of_file(picture_field("pressure"), file) == std::vector<double>{5.0, 0.0});
    CHECK(values_of_file(picture_field("distance"), file).empty());
    CHECK(values_of_file(picture_field("strain"), {{{"strain_warp", {0.0}}}, {}}).empty());
}

TEST_CASE("a field that is none is refused with the nearest name") {
    CHECK(message_of([] { picture_field("strain_wrap"); }).find("did you mean 'strain_warp'?") != std::string::npos);
    CHECK(message_of([] { picture_field("colour"); }).find("valid: strain, strain_warp") != std::string::npos);
}

TEST_CASE("distances are those to the nearest body, in mm, negative inside, infinite without one") {
    const std::vector<ShownShape> bodies = {shown(make_box(Vec3(1, 1, 1)), false),
                                            shown(moved(make_box(Vec3(1, 1, 1)), Vec3(4, 0, 0)), false),
                                            shown(moved(make_box(Vec3(1, 1, 1)), Vec3(0, 0.6, 0)), true)};
    TriangleMesh cloth = make_grid(1, 1, 2, 2);
    cloth.vertices = {Vec3(0, 0.75, 0), Vec3(4, 1.5, 0), Vec3(0, 0.4, 0), Vec3(2, 0, 0)};
    const std::vector<double> distances = distances_to_bodies(picture_field("distance"), cloth, bodies);
    const double expected[] = {250.0, 1000.0, -100.0, 1500.0};
    for (std::size_t v = 0; v < 4; ++v) CHECK(distances[v] == Approx(expected[v]));
    for (const double distance : distances_to_bodies(picture_field("distance"), cloth, {})) CHECK(distance == infinity);
}

TEST_CASE("a range goes from the smallest to nearly the largest value, in round numbers") {
    const FieldRange range = spread_of_values({0.3, 9.7, 4.0, infinity}).range();
    CHECK(range.low == 0.0);
    CHECK(range.high == 10.0);
    CHECK(range.step == 2.0);
    CHECK_FALSE((range.some_below || range.some_above || range.diverging()));
    std::vector<double> values(1000, 1.0);
    for (std::size_t k = 0; k < 500; ++k) values[k] = 0.0;
    values[0] = 50.0;
    const FieldRange outlier = spread_of_values(values).range();
    CHECK(outlier.high == 1.0);
    CHECK(outlier.some_above);
    CHECK(outlier.share(50.0) == 1.0);
}

TEST_CASE("values of both signs have a range alike on both sides of 0, equal ones a range around them") {
    const FieldRange both = spread_of_values({-1.0, 4.0}).range();
    CHECK(both.low == -both.high);
    CHECK(both.high >= 4.0);
    CHECK(both.diverging());
    CHECK(both.share(0.0) == 0.5);
    for (const double value : {0.0, 3.0, -2e-5}) {
        const FieldRange equal = spread_of_values({value, value}).range();
        CHECK((equal.low < value && equal.high > value));
        CHECK_FALSE((equal.some_below || equal.some_above));
    }
}

TEST_CASE("a range that is asked for is kept and says what lies beyond, and a wrong one is refused") {
    const FieldRange range = spread_of_values({-3.0, 0.5}).range(-1.0, 0.77);
    CHECK((range.low == -1.0 && range.high == 0.77));
    CHECK((range.some_below && !range.some_above));
    CHECK(message_of([] { spread_of_values({1.0}).range(2.0, 2.0); }).find("the lower one first") != std::string::npos);
    CHECK(message_of([] { spread_of_values({1.0}).range(0.0, infinity); }).find("two finite ends") != std::string::npos);
    CHECK(message_of([] { spread_of_values({infinity, NAN}).range(); }).find("no cloth") != std::string::npos);
}

}  // namespace percale::scenes::test::picture_field_test
