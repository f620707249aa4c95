#include "export/run_settings.h"

#include <nlohmann/json.hpp>

#include "percale/options.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::run_settings_test {
using nlohmann::ordered_json;

namespace {

ordered_json settings(const Scene& scene) { return ordered_json::parse(settings_text(scene)); }

const ordered_json& at_dotted(const ordered_json& json, std::string key) {
    for (char& letter : key)
        if (letter == '.') letter = '/';
    return json.at(ordered_json::json_pointer("/" + key));
}

}  // namespace

TEST_CASE("every field of the step settings is listed under its key, with the value in use") {
    Scene scene;
    double next = 0.001;
    for (const Option<StepSettings>& option : step_options())
        if (option.number) *option.number(scene.step) = next += 0.001;
    scene.step.newton_iterations = 7;
    scene.step.scheme = Scheme::rk4;
    const ordered_json step = settings(scene).at("step");
    for (const Option<StepSettings>& option : step_options()) {
        INFO(option.key);
        const ordered_json& value = at_dotted(step, std::string(option.key));
        if (option.number) CHECK(value.get<double>() == *option.number(scene.step));
        const bool is_auto = option.zero_is_auto && *option.integer(scene.step) == 0;
        if (is_auto) CHECK(value == "auto");
        if (option.integer && !is_auto) CHECK(value.get<int>() == *option.integer(scene.step));
        if (option.get_choice)
            CHECK(value == std::string(option.choices[static_cast<std::size_t>(option.get_choice(scene.step))]));
    }
    CHECK(step.at("scheme") == "rk4");
}

TEST_CASE("every field of a fabric is listed under its fabric, springs as a table of their own") {
    Scene scene;
    Fabric& fabric = scene.fabrics["silk"];
    double next = 0.001;
    for (const Option<Fabric>& option : fabric_options()) {
        if (option.number) *option.number(fabric) = next += 0.001;
        if (option.flag) *option.flag(fabric) = true;
        if (option.optional_number) *option.optional_number(fabric) = next += 0.001;
        if (option.optional_pair) *option.optional_pair(fabric) = {next, 2.0 * next};
    }
    const ordered_json json = settings(scene).at("fabric").at("silk");
    for (const Option<Fabric>& option : fabric_options()) {
        INFO(option.key);
        const ordered_json& value = at_dotted(json, std::string(option.key));
        if (option.number) CHECK(value.get<double>() == *option.number(fabric));
        if (option.flag) CHECK(value == true);
        if (option.optional_number) CHECK(value.get<double>() == **option.optional_number(fabric));
        if (option.optional_pair) CHECK(value.at(1).get<double>() == (**option.optional_pair(fabric))[1]);
    }
    CHECK(json.at("springs").is_object());
    scene.fabrics["plain"] = {};
    CHECK_FALSE(settings(scene).at("fabric").at("plain").contains("bend_stiffness"));
}

TEST_CASE("an automatic tolerance is the word auto, a given one its number") {
    Scene scene;
    CHECK(settings(scene).at("step").at("newton_tolerance") == "auto");
    scene.step.newton_tolerance = 1e-7;
    CHECK(settings(scene).at("step").at("newton_tolerance") == 1e-7);
}

TEST_CASE("detectors and frame formats have the words of scene files") {
    Scene scene;
    const auto word = [&](Detector detector) {
        scene.detector = detector;
        return settings(scene).at("step").at("detector").get<std::string>();
    };
    CHECK(word(Detector::fcl) == "fcl");
    CHECK(word(Detector::bullet) == "bullet");
    CHECK(word(Detector::brute_force) == "brute_force");
    CHECK(word(Detector::none) == "none");
    scene.output.frames = {"none"};
    CHECK(settings(scene).at("output").at("frames") == "none");
}

TEST_CASE("cloths, obstacles, motion and events are listed as the scene has them") {
    Scene scene;
    ClothSpec cloth;
    cloth.name = "sheet";
    cloth.grid = GridSpec{{1.0, 2.0}, {3, 5}};
    scene.cloths = {cloth};
    ObstacleSpec ball, body;
    ball.name = "ball";
    ball.shape = SphereShape{0.25};
    ball.friction = 0.7;
    ball.motion = {{0.5, Vec3(1.0, 2.0, 3.0), {}}, {1.5, {}, Rotation{0.0, 1.0, 0.0, 0.0}}};
    ball.spin = Spin{Vec3::UnitX(), 2.0, 0.25};
    body.mesh = "body.obj";
    scene.obstacles = {ball, body};
    scene.events = {{1.0, MoveEvent{"sheet", VertexIndices{{0}}, Vec3(0.0, 1.0, 0.0), 0.5}, {}},
                    {2.0, GravityEvent{Vec3(0.0, 1.0, 0.0)}, {}}};
    const ordered_json json = settings(scene);
    CHECK(json.at("cloth")[0].at("grid").at("vertices") == std::vector<int>{3, 5});
    CHECK(json.at("obstacle")[0].at("shape").at("sphere").at("radius") == 0.25);
    CHECK(json.at("obstacle")[0].at("friction") == 0.7);
    CHECK(json.at("obstacle")[0].at("motion")[0].at("translation") == std::vector<double>{1.0, 2.0, 3.0});
    CHECK_FALSE(json.at("obstacle")[0].at("motion")[0].contains("rotation"));
    CHECK(json.at("obstacle")[0].at("motion")[1].at("rotation") == std::vector<double>{0.0, 1.0, 0.0, 0.0});
    CHECK(json.at("obstacle")[0].at("spin").at("turns_per_s") == 2.0);
    CHECK(json.at("obstacle")[1].at("mesh") == "body.obj");
    CHECK(json.at("event")[0].at("move").at("over") == 0.5);
    CHECK(json.at("event")[1].at("gravity") == std::vector<double>{0.0, 1.0, 0.0});
}

TEST_CASE("every kind of shape is listed by its name with its sizes") {
    const auto shape = [](const Shape& value) {
        Scene scene;
        scene.obstacles.emplace_back();
        scene.obstacles[0].shape = value;
        return settings(scene).at("obstacle")[0].at("shape");
    };
    CHECK(shape(BoxShape{Vec3(1.0, 2.0, 3.0)}).at("box").at("size") == std::vector<double>{1.0, 2.0, 3.0});
    CHECK(shape(CylinderShape{0.5, 2.0}).at("cylinder").at("height") == 2.0);
    CHECK(shape(CapsuleShape{0.5, 3.0}).at("capsule").at("height") == 3.0);
    CHECK(shape(PlaneShape{4.0}).at("plane").at("half_size") == 4.0);
}

TEST_CASE("what differs between two settings is named with both values, three at most, and threads are no difference") {
    Scene one;
    one.title = "one";
    one.duration = 2.0;
    Scene other = one;
    CHECK(different_settings(settings_text(one), settings_text(other), "was").empty());
    other.step.threads = 3;
    CHECK(different_settings(settings_text(one), settings_text(other), "was").empty());
    other.duration = 3.0;
    CHECK(different_settings(settings_text(one), settings_text(other), "was") == "duration is 2.0, was 3.0");
    other.step.time_step = 0.5;
    other.step.newton_error_ratio = 2.0;
    other.step.work_limit = 7;
    const std::string text = different_settings(settings_text(one), settings_text(other), "in the checkpoint");
    CHECK(std::count(text.begin(), text.end(), ';') == 3);
    CHECK(text.ends_with("; and more"));
}

}  // namespace percale::scenes::test::run_settings_test
