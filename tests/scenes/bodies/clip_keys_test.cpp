#include "bodies/clip_keys.h"

#include <Eigen/Geometry>
#include <cmath>

#include "tests/support/catch.h"

namespace percale::scenes::test::clip_keys_test {
namespace {

ModelTrack track(Interpolation interpolation, const std::vector<std::array<double, 4>>& values) {
    return {.interpolation = interpolation, .times = {1.0, 3.0}, .values = values};
}

}  // namespace

TEST_CASE("A node's transform is linear between its keys, its rotation at a constant rate, and constant outside") {
    ModelChannel channel;
    channel.translation = track(Interpolation::linear, {{0, 0, 0, 0}, {4, 0, 0, 0}});
    channel.rotation = track(Interpolation::linear, {{0, 0, 0, 1}, {0, 0, std::sin(0.5), std::cos(0.5)}});
    channel.scale = track(Interpolation::linear, {{1, 1, 1, 0}, {3, 1, 1, 0}});
    CHECK(last_key({.name = "", .ticks_per_s = 1.0, .channels = {channel}, .morphs = {}}) == 3.0);
    for (const double tick : {0.0, 1.0, 1.5, 2.2, 3.0, 9.0}) {
        const double share = std::clamp(0.5 * (tick - 1.0), 0.0, 1.0);
        const Eigen::Matrix4d expected =
            (Eigen::Translation3d(4.0 * share, 0.0, 0.0) * Eigen::AngleAxisd(share, Eigen::Vector3d::UnitZ()) *
             Eigen::Scaling(1.0 + 2.0 * share, 1.0, 1.0))
                .matrix();
        CHECK((node_transform(channel, tick) - expected).norm() < 1e-14);
    }
    CHECK(node_transform(ModelChannel(), 1.0) == Eigen::Matrix4d::Identity());
}

TEST_CASE("Steps keep a value until the next key") {
    ModelChannel channel;
    channel.translation = track(Interpolation::step, {{1, 0, 0, 0}, {4, 0, 0, 0}});
    for (const auto& [tick, x] : {std::pair{0.0, 1.0}, {2.9, 1.0}, {3.0, 4.0}, {7.0, 4.0}})
        CHECK(node_transform(channel, tick)(0, 3) == x);
}

TEST_CASE("A spline is any cubic that its values and tangents are of, exactly, and weights likewise") {
    const auto x = [](double t) { return 1.0 - 2.0 * t + 0.5 * t * t + 0.25 * t * t * t; };
    const auto slope = [](double t) { return -2.0 + t + 0.75 * t * t; };
    ModelChannel channel;
    ModelMorphs morphs{.nodes = {0}, .interpolation = Interpolation::cubic, .times = {1.0, 3.0}, .weights = {}};
    channel.translation = track(Interpolation::cubic, {});
    for (const double t : {1.0, 3.0}) {
        for (const double value : {slope(t), x(t), slope(t)}) {
            channel.translation.values.push_back({value, 0, 0, 0});
            morphs.weights.push_back({value, 2.0 * value});
        }
    }
    for (const double t : {1.0, 1.3, 2.0, 2.9, 3.0}) {
        CHECK(node_transform(channel, t)(0, 3) == Approx(x(t)).margin(1e-13));
        CHECK(morph_weights(morphs, t)[0] == Approx(x(t)).margin(1e-13));
        CHECK(morph_weights(morphs, t)[1] == Approx(2.0 * x(t)).margin(1e-13));
    }
    CHECK(node_transform(channel, 9.0)(0, 3) == x(3.0));
}

TEST_CASE("Weights of morph targets are linear between keys; of lists of different lengths those that are missing are 0") {
    CHECK(morph_weights({}, 0.0).empty());
    const ModelMorphs morphs{
        .nodes = {0}, .interpolation = Interpolation::linear, .times = {0.0, 10.0}, .weights = {{1.0}, {2.0, 4.0}}};
    CHECK(morph_weights(morphs, 2.5) == std::vector<double>{1.25, 1.0});
    CHECK(last_key({.name = "", .ticks_per_s = 1.0, .channels = {}, .morphs = {morphs}}) == 10.0);
    const ModelMorphs held{.nodes = {0}, .interpolation = Interpolation::step, .times = {0.0, 10.0}, .weights = {{1.0}, {2.0}}};
    CHECK(morph_weights(held, 9.0) == std::vector<double>{1.0});
}

}  // namespace percale::scenes::test::clip_keys_test
