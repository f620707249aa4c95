#include "data/generators/spikes.h"

#include "percale/certify.h"
#include "tests/scenes/mesh_laws.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::spikes_test {

TEST_CASE("a bed of spikes is closed, outward and as large as its plate and pyramids") {
    SpikeBed single, dense;
    single.count = 1;
    dense.count = 12, dense.base = 0.04;
    for (const SpikeBed& bed : {SpikeBed{}, single, dense}) {
        const TriangleMesh mesh = make_spikes(bed);
        CHECK(is_watertight(mesh));
        CHECK(has_single_fans(mesh));
        CHECK(euler_number(mesh) == 2);
        CHECK(self_intersections(mesh).empty());
        CHECK_NOTHROW(check_mesh(mesh, "spikes", true));
        const double plate = bed.width * bed.width * bed.thickness;
        const double pyramids = bed.count * bed.count * bed.base * bed.base * bed.height / 3.0;
        CHECK(volume(mesh) == Approx(plate + pyramids).epsilon(1e-12));
    }
}

TEST_CASE("the tips stand in rows at the height asked for") {
    const SpikeBed bed;
    std::set<std::pair<long, long>> tips;  // mm
    for (const Vec3& x : make_spikes(bed).vertices) {
        REQUIRE((x[1] == bed.height || x[1] == 0.0 || x[1] == -bed.thickness));
        REQUIRE(std::max(std::abs(x[0]), std::abs(x[2])) <= 0.5 * bed.width);
        if (x[1] == bed.height) tips.insert({std::lround(1e3 * x[0]), std::lround(1e3 * x[2])});
    }
    std::set<std::pair<long, long>> expected;
    for (const long x : {-240, -120, 0, 120, 240})
        for (const long z : {-240, -120, 0, 120, 240}) expected.insert({x, z});
    CHECK(tips == expected);
}

TEST_CASE("a bed that cannot be made is refused with the field and its range") {
    const auto refusal = [](auto SpikeBed::*field, auto value) {
        SpikeBed bed;
        bed.*field = value;
        return message_of([&] { make_spikes(bed); });
    };
    CHECK(refusal(&SpikeBed::count, 0) == "spikes: count is 0.000000, allowed are 1.000000 ... 100.000000");
    CHECK(refusal(&SpikeBed::count, 101).find("spikes: count") == 0);
    CHECK(refusal(&SpikeBed::base, 0.12).find("spikes: base is 0.120000, allowed are 0.000100 ... 0.118800") == 0);
    CHECK(refusal(&SpikeBed::height, -0.1).find("spikes: height") == 0);
    CHECK(refusal(&SpikeBed::thickness, 0.0).find("spikes: thickness") == 0);
    CHECK(refusal(&SpikeBed::width, std::nan("")).find("spikes: width") == 0);
}

}  // namespace percale::scenes::test::spikes_test
