#include "picture/painter.h"

#include <cmath>
#include <numbers>

#include "tests/scenes/message_of.h"
#include "tests/scenes/picture/png_reader.h"
#include "tests/scenes/picture/shown_shapes.h"

namespace percale::scenes::test::painter_test {
namespace {

Camera camera_for(const ShownFrame& frame, const CameraAim& aim, int width, int height) {
    ViewFit fit(aim, width, height);
    for (const ShownShape& shape : frame.shapes) fit.add(shape.mesh.vertices);
    return fit.camera();
}

Image painted(const ShownFrame& frame, const CameraAim& aim, PaintSettings settings = {Background::transparent}) {
    return paint(frame, camera_for(frame, aim, 200, 160), settings, nullptr);
}

/// Opaque parts of all pixels, summed.
double covered_pixels(const Image& image) {
    double sum = 0.0;
    for (std::size_t k = 3; k < image.rgba.size(); k += 4) sum += image.rgba[k] / 255.0;
    return sum;
}

ShownFrame square_frame() { return {0, 0.0, {shown(upright(1.0, 5), true, Colour(0.5f, 0.1f, 0.1f))}}; }

}  // namespace

TEST_CASE("the silhouette of a sphere has its area in perspective, to 1 % of it") {
    if (!draws()) return;
    const double radius = 0.7;
    const ShownFrame frame{0, 0.0, {shown(moved(make_sphere(radius, 6), Vec3(3, -1, 2)), false)}};
    const Camera camera = camera_for(frame, {35.0, -20.0}, 200, 160);
    const Image image = paint(frame, camera, {Background::transparent}, nullptr);
    // Seen from distance d its cone has the tangent r/sqrt(d^2 - r^2).
    const double d = (Vec3(3, -1, 2) - camera.eye).norm();
    const double pixels = camera.focal * camera.height * radius / std::sqrt(d * d - radius * radius);
    CHECK(covered_pixels(image) == Approx(std::numbers::pi * pixels * pixels).epsilon(0.01));
}

TEST_CASE("edges are smooth: a slanted square covers its area to a thousandth") {
    if (!draws()) return;
    ShownFrame frame = square_frame();
    for (Vec3& x : frame.shapes[0].mesh.vertices)
        x = Vec3(std::cos(0.3) * x.x() - std::sin(0.3) * x.y(), std::sin(0.3) * x.x() + std::cos(0.3) * x.y(), 0);
    const Camera camera = camera_for(frame, {0.0, 0.0}, 200, 160);
    const double side = 1.0 / camera.pixel_size(camera.eye.z());
    CHECK(covered_pixels(paint(frame, camera, {Background::transparent}, nullptr)) == Approx(side * side).epsilon(1e-3));
}

TEST_CASE("the two sides of cloth differ, those of a body do not") {
    if (!draws()) return;
    for (const bool is_cloth : {true, false}) {
        ShownFrame frame = square_frame();
        frame.shapes[0].is_cloth = is_cloth;
        const Image front = painted(frame, {0.0, 0.0}), back = painted(frame, {180.0, 0.0});
        double difference = 0.0;
        for (std::size_t k = 0; k < 3; ++k) difference += std::abs(front.at(100, 80)[k] - back.at(100, 80)[k]);
        CHECK((difference > 20.0) == is_cloth);
    }
}

TEST_CASE("cloth has the colours of its values, and grey where it has none") {
    if (!draws()) return;
    ShownFrame frame = square_frame();
    for (const Vec3& x : frame.shapes[0].mesh.vertices) frame.shapes[0].field.push_back(10.0 * (x.x() + 0.5));
    PaintSettings settings{Background::transparent};
    settings.range = FieldRange{0.0, 10.0, 2.0};
    const Camera camera = camera_for(frame, {0.0, 0.0}, 200, 160);
    const Image image = paint(frame, camera, settings, nullptr);
    // The plane has one normal and no shadow: all its light is one factor times the colour, but for sheen.
    for (const double x : {-0.4, 0.0, 0.4}) {
        const Vec3 seen = camera.project(Vec3(x, 0.01, 0));
        const std::uint8_t* pixel = image.at(static_cast<int>(seen.x()), static_cast<int>(seen.y()));
        ShownFrame plain = square_frame();
        plain.shapes[0].colour = ramp_colour(x + 0.5, false);
        const std::uint8_t* expected = nullptr;
        const Image same = paint(plain, camera, {Background::transparent}, nullptr);
        expected = same.at(static_cast<int>(seen.x()), static_cast<int>(seen.y()));
        for (std::size_t k = 0; k < 3; ++k) CHECK(pixel[k] == Approx(expected[k]).margin(3.0));
    }
    frame.shapes[0].field.assign(25, std::numeric_limits<double>::infinity());
    const Image none = paint(frame, camera, settings, nullptr);
    CHECK(none.at(100, 80)[0] == none.at(100, 80)[1]);
}

TEST_CASE("a picture has the same bytes with any number of threads, and at any time") {
    if (!draws()) return;
    const ShownFrame frame{
        0, 0.0, {shown(make_sphere(0.5, 3), false), shown(moved(make_grid(1.5, 1.5, 9, 9), Vec3(0, 0.6, 0)), true)}};
    PaintSettings settings;
    settings.wire = true;
    settings.ground = Ground{-0.5, Vec3(0, -0.5, 0), 4.0};
    const Image alone = painted(frame, {}, settings);
    CHECK((painted(frame, {}, settings).rgba == alone.rgba));
    for (const int threads : {1, 2, 5}) {
        const auto workers = make_workers(threads);
        CHECK(paint(frame, camera_for(frame, {}, 200, 160), settings, workers.get()).rgba == alone.rgba);
    }
}

TEST_CASE("what stands on the ground throws a soft shadow there, and is darker below") {
    if (!draws()) return;
    const ShownFrame frame{0, 0.0, {shown(make_sphere(0.5, 4), false)}};
    PaintSettings settings{Background::white};
    CHECK(painted(frame, {0.0, 20.0}, settings).at(3, 3)[0] == 255);
    const Image plain = painted(frame, {0.0, 20.0}, settings);
    settings.ground = Ground{-0.5, Vec3(0, -0.5, 0), 4.0};
    const Image grounded = painted(frame, {0.0, 20.0}, settings);
    const Camera camera = camera_for(frame, {0.0, 20.0}, 200, 160);
    int darkest = 255;
    for (int k = 0; k < 60; ++k) {
        const Vec3 seen = camera.project(Vec3(0.02 * k, -0.5, -0.01 * k));
        if (seen.x() >= 200 || plain.at(static_cast<int>(seen.x()), static_cast<int>(seen.y()))[0] != 255) continue;
        darkest = std::min<int>(darkest, grounded.at(static_cast<int>(seen.x()), static_cast<int>(seen.y()))[0]);
    }
    CHECK(darkest < 235);
    CHECK(grounded.at(3, 3)[0] == 255);
    const Vec3 top = camera.project(Vec3(-0.2, 0.4, 0.2)), low = camera.project(Vec3(0.05, -0.35, 0.35));
    CHECK(plain.at(static_cast<int>(top.x()), static_cast<int>(top.y()))[0] >
          plain.at(static_cast<int>(low.x()), static_cast<int>(low.y()))[0] + 40);
}

TEST_CASE("wire shows the edges of triangles and nothing between them") {
    if (!draws()) return;
    ShownFrame frame = square_frame();
    const Camera camera = camera_for(frame, {0.0, 0.0}, 200, 160);
    PaintSettings settings{Background::transparent};
    const Image plain = paint(frame, camera, settings, nullptr);
    settings.wire = true;
    const Image wire = paint(frame, camera, settings, nullptr);
    // An edge goes through x = 0.25; the middle of a triangle is at a third of its cell.
    const Vec3 edge = camera.project(Vec3(0.25, 0.1, 0));
    const auto value = [](const Image& image, const Vec3& seen) {
        return image.at(static_cast<int>(seen.x()), static_cast<int>(seen.y()))[0];
    };
    CHECK(value(wire, edge) < value(plain, edge) - 25);
    const TriangleMesh& mesh = frame.shapes[0].mesh;
    for (const Triangle& t : {mesh.triangles[4], mesh.triangles[13]}) {
        const Vec3 middle = camera.project((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
        CHECK(value(wire, middle) == value(plain, middle));
    }
}

TEST_CASE("a background that is none is refused, the studio's is lighter above") {
    CHECK(background_of("white") == Background::white);
    CHECK(background_of("transparent") == Background::transparent);
    CHECK(message_of([] { background_of("whit"); }).find("did you mean 'white'") != std::string::npos);
    CHECK(background_colour(Background::studio, 0.0)[1] > background_colour(Background::studio, 1.0)[1]);
    CHECK(background_colour(Background::white, 0.7) == Colour::Ones());
}

}  // namespace percale::scenes::test::painter_test
