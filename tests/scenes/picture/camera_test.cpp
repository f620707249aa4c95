#include "picture/camera.h"

#include <cmath>

#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::camera_test {
namespace {

std::vector<Vec3> cloud(unsigned seed) {
    std::vector<Vec3> points;
    std::uint64_t state = seed;
    const auto next = [&] {
        return static_cast<double>((state = state * 6364136223846793005u + 1442695040888963407u) >> 33) / 2147483648.0;
    };
    for (int k = 0; k < 200; ++k) points.emplace_back(3.0 * next() - 1.0, 0.7 * next() + 5.0, 2.0 * next());
    return points;
}

Camera fitted(const CameraAim& aim, int width, int height, const std::vector<Vec3>& points) {
    ViewFit fit(aim, width, height);
    fit.add(points);
    return fit.camera();
}

}  // namespace

TEST_CASE("a fitted camera sees every vertex from everywhere, up to its margin") {
    const std::vector<Vec3> points = cloud(7);
    const std::pair<int, int> sizes[] = {{1200, 900}, {300, 900}, {900, 200}};
    const double elevations[] = {-90.0, -20.0, 0.0, 12.0, 90.0};
    for (int k = 0; k < 165; ++k) {
        const auto [width, height] = sizes[k % 3];
        const Camera camera = fitted({33.0 * (k / 15) - 180.0, elevations[k % 5]}, width, height, points);
        double widest = 0.0;
        for (const Vec3& point : points) {
            const Vec3 seen = camera.project(point);
            CHECK(seen.z() > 0.0);
            widest = std::max({widest, std::abs(seen.x() / width - 0.5), std::abs(seen.y() / height - 0.5)});
        }
        CHECK(widest <= 0.4401);
        CHECK(widest > 0.43);
    }
}

TEST_CASE("rays go through the places where points are seen") {
    const std::vector<Vec3> points = cloud(3);
    const Camera camera = fitted({28.0, 12.0}, 640, 480, points);
    for (const Vec3& point : points) {
        const Vec3 seen = camera.project(point), off = point - camera.eye;
        CHECK(off.normalized().dot(camera.direction(seen.x(), seen.y())) == Approx(1.0).epsilon(1e-12));
        CHECK(camera.pixel_size(seen.z()) == Approx(seen.z() / (camera.focal * 480)));
    }
}

TEST_CASE("azimuth 0 looks at what faces +z with +x to the right, and the top view at what faces up") {
    const std::vector<Vec3> points = {Vec3(-1, -1, -1), Vec3(1, 1, 1)};
    const Camera front = fitted(aim_of_view("front"), 100, 100, points), top = fitted(aim_of_view("top"), 100, 100, points);
    CHECK((front.back - Vec3::UnitZ()).norm() < 1e-12);
    CHECK((front.right - Vec3::UnitX()).norm() < 1e-12);
    CHECK((front.up - Vec3::UnitY()).norm() < 1e-12);
    CHECK((top.back - Vec3::UnitY()).norm() < 1e-12);
    CHECK((top.up + Vec3::UnitZ()).norm() < 1e-12);
    CHECK((fitted(aim_of_view("side"), 100, 100, points).back - Vec3::UnitX()).norm() < 1e-12);
    CHECK((fitted(aim_of_view("back"), 100, 100, points).back + Vec3::UnitZ()).norm() < 1e-12);
}

TEST_CASE("a target is in the middle of the picture, and zoom enlarges about it") {
    const std::vector<Vec3> points = cloud(5);
    CameraAim aim{40.0, 20.0};
    aim.target = Vec3(0.3, 5.1, 0.2);
    const Camera camera = fitted(aim, 400, 300, points);
    const Vec3 middle = camera.project(*aim.target);
    CHECK(middle.x() == Approx(200.0));
    CHECK(middle.y() == Approx(150.0));
    aim.zoom = 2.0;
    const Camera zoomed = fitted(aim, 400, 300, points);
    for (const Vec3& point : points) {
        const Vec3 seen = camera.project(point), larger = zoomed.project(point);
        CHECK(seen.x() > 0.0);
        CHECK(seen.x() < 400.0);
        CHECK(larger.x() - 200.0 == Approx(2.0 * (seen.x() - 200.0)));
        CHECK(larger.y() - 150.0 == Approx(2.0 * (seen.y() - 150.0)));
    }
}

TEST_CASE("points in one place are before the eye, and a wider picture sees them where they were") {
    const Camera camera = fitted({}, 100, 80, {Vec3(1, 2, 3), Vec3(1, 2, 3)});
    CHECK(camera.project(Vec3(1, 2, 3)).z() > 0.0);
    ViewFit fit({}, 400, 300);
    fit.add(cloud(5));
    for (const Vec3& point : cloud(5))
        CHECK((fit.camera().project(point) - fit.camera_of_wider(700).project(point)).norm() == 0.0);
}

TEST_CASE("an aim that cannot be is refused with its value") {
    CHECK(message_of([] { aim_of_view("frnt"); }).find("did you mean 'front'") != std::string::npos);
    CHECK(message_of([] { ViewFit({0.0, 90.5}, 10, 10); }).find("90.5 degrees, must be in -90 ... 90") != std::string::npos);
    CHECK(message_of([] { ViewFit({0.0, 0.0, 0.0}, 10, 10); }).find("zoom is 0") != std::string::npos);
    CHECK(message_of([] { ViewFit({NAN, 0.0}, 10, 10); }).find("azimuth") != std::string::npos);
    CHECK(message_of([] { ViewFit({}, 10, 10).camera(); }).find("nothing is shown") != std::string::npos);
}

}  // namespace percale::scenes::test::camera_test
