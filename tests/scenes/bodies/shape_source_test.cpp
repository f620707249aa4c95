#include "bodies/shape_source.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::shape_source_test {
namespace {

/// One vertex, at 10 k in sample k; counts what is loaded.
class Counted : public SampledShapes {
public:
    explicit Counted(std::vector<double> times) { set_times(std::move(times)); }
    explicit Counted(int count) { set_equal_times(count, 2.0); }
    const TriangleMesh& mesh() const override { return mesh_; }
    mutable int loads = 0;

private:
    std::vector<Vec3> load(int sample) const override {
        ++loads;
        return {{10.0 * sample, 0.0, 0.0}};
    }
    TriangleMesh mesh_{.vertices = {{0, 0, 0}}, .triangles = {}};
};

}  // namespace

TEST_CASE("Shapes go straight from sample to sample, whose times need not be equal, and stay at the ends") {
    Counted shapes({0.0, 1.0, 3.0});
    CHECK(shapes.length() == 3.0);
    CHECK(shapes.frame_time() == 1.5);
    CHECK(shapes.text() == "3 frames in 3 s");
    for (const auto& [time, x] :
         {std::pair{-1.0, 0.0}, {0.0, 0.0}, {0.25, 2.5}, {1.0, 10.0}, {2.5, 17.5}, {3.0, 20.0}, {8.0, 20.0}})
        CHECK(shapes.at(time)[0].x() == Approx(x));
}

TEST_CASE("A sample is loaded once while time goes on, and equal times are those of a rate") {
    Counted shapes(9);
    CHECK(shapes.length() == 4.0);
    for (int step = 0; step <= 80; ++step) CHECK(shapes.at(0.05 * step)[0].x() == Approx(step));
    CHECK(shapes.loads == 9);
}

}  // namespace percale::scenes::test::shape_source_test
