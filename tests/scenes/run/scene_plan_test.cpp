#include "run/scene_plan.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/scene_file_error.h"
#include "format/scene_file.h"
#include "run/run_scene.h"
#include "tests/scenes/small_scenes.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::scene_plan_test {
namespace {

BuiltScene built(const std::string& text, const std::vector<Override>& overrides = {}) {
    return build_scene(parse_scene(text, "test.toml", overrides));
}

bool skips(const BuiltScene& scene, const std::string& what) {
    const ScenePlan plan = plan_of(scene);
    return std::any_of(plan.skipped.begin(), plan.skipped.end(), [&](const Skip& skip) { return skip.what == what; });
}

const std::string lift = "[[obstacle.motion]]\ntime = 0.0\n[[obstacle.motion]]\ntime = 1.0\ntranslation = [0.1, -0.2, 0.03]\n";
const std::string pin_event = "[[event]]\ntime = 0.05\npin = { cloth = \"sheet\", vertices = [0] }\n";

}  // namespace

TEST_CASE("the plan of a scene counts what it holds") {
    const ScenePlan plan = plan_of(built(sheet_on_box(), {{"cloth.sheet.pin", "[0, 5]"}}));
    CHECK(plan.vertices == 36);
    CHECK(plan.pinned_vertices == 2);
    CHECK(plan.springs.structural == 60);
    CHECK(plan.springs.shear == 50);
    CHECK(plan.springs.bend == 48);
    CHECK(plan.obstacles == 1);
    CHECK(plan.obstacle_triangles == 12);
}

TEST_CASE("motion and events of the file are known before the first step") {
    const std::string box = sheet_on_box();
    CHECK(skips(built(box), "motion of obstacles"));
    CHECK_FALSE(skips(built(box + lift), "motion of obstacles"));
    CHECK(skips(built(box), "motion and work of pins"));
    CHECK_FALSE(skips(built(box + pin_event), "motion and work of pins"));
    const std::vector<Override> weightless = {{"gravity", "[0, 0, 0]"}, {"step.measure", "all"}};
    CHECK(skips(built(box, weightless), "energy of gravity"));
    const std::string gravity = "[[event]]\ntime = 0.05\ngravity = [0.0, -1.0, 0.0]\n";
    CHECK_FALSE(skips(built(box + gravity, weightless), "energy of gravity"));
}

TEST_CASE("a plan that is kept is that of the start, and the run's") {
    BuiltScene scene = built(falling_sheet() + pin_event, {{"duration", "0.04"}, {"step.scheme", "auto"}});
    const ScenePlan before = plan_of(scene);
    keep_plan(scene);
    const RunResult result = run_scene(scene);
    for (const ScenePlan& plan : {plan_of(scene), result.plan}) {
        CHECK(plan.scheme == before.scheme);
        CHECK(plan.scheme_reason == before.scheme_reason);
        CHECK(plan.stable_step == before.stable_step);
        CHECK(plan.warning_texts() == before.warning_texts());
    }
}

TEST_CASE("events after the end are warned of") {
    const auto warnings = [](const std::string& end) {
        const BuiltScene scene = built(falling_sheet() + pin_event, {{"duration", end}});
        return plan_findings(scene, plan_of(scene));
    };
    CHECK(warnings("0.05").empty());
    REQUIRE(warnings("0.04").size() == 1);
    CHECK(warnings("0.04")[0].kind == "late_events");
    CHECK(warnings("0.04")[0].place == "test.toml:18:1");
    CHECK(finding_text(warnings("0.04")[0]) == "1 of 1 event would come after the end, 0.04 s, the first at 0.05 s");
}

TEST_CASE("the plan says what the start needed") {
    CHECK(plan_text(built(sheet_on_box())).find("moved out of") == std::string::npos);
    std::string inside = sheet_on_box();
    inside.replace(inside.find("0.015"), 5, "-0.01");
    const std::string text = plan_text(built(inside));
    CAPTURE(text);
    CHECK(text.find("start      36 vertices of sheet moved out of box before the start") != std::string::npos);
    const std::vector<Finding> moves = start_findings(built(inside));
    REQUIRE(moves.size() == 1);
    CHECK(moves[0].kind == "start_moved");
    CHECK(moves[0].severity == Severity::warning);  // 15 mm, three thicknesses
    CHECK(start_findings(built(sheet_on_box())).empty());
}

TEST_CASE("a run lists what its plan lists") {
    BuiltScene scene = built(sheet_on_box() + pin_event);
    const ScenePlan plan = plan_of(scene);
    const RunResult result = run_scene(scene);
    REQUIRE(result.plan.skipped.size() == plan.skipped.size());
    for (std::size_t i = 0; i < plan.skipped.size(); ++i) CHECK(result.plan.skipped[i].what == plan.skipped[i].what);
}

TEST_CASE("a run that skips nothing ends where one ends that skips what it can") {
    for (const std::string& text : {sheet_on_box(), sheet_on_box() + lift, sheet_on_box() + pin_event}) {
        // The box is shifted so that none of its edges lies below one of the sheet, where contacts would change to and fro.
        const std::vector<Override> longer = {{"duration", "1.5"}, {"obstacle.box.pose.translation", "[0.1, -0.25, 0.03]"}};
        std::vector<Override> everything = longer;
        everything.push_back({"step.skip", "false"});
        BuiltScene skipping = built(text, longer), whole = built(text, everything);
        run_scene(skipping);
        run_scene(whole);
        const auto reference = whole.simulation.positions(whole.cloths[0]);
        CHECK(largest_vertex_distance(skipping.simulation, skipping.cloths, reference) < 1e-4);
    }
}

TEST_CASE("a scene without obstacles has a detector only if nothing is skipped, and ends the same") {
    const std::vector<Override> implicit = {{"step.scheme", "backward_euler"}, {"step.newton_tolerance", "1e-8"}};
    std::vector<Override> everything = implicit;
    everything.push_back({"step.skip", "false"});
    BuiltScene skipping = built(falling_sheet(), implicit), whole = built(falling_sheet(), everything);
    CHECK(skips(skipping, "contact detection, contact constraints, clamps and predicted positions"));
    CHECK_FALSE(skips(whole, "contact detection, contact constraints, clamps and predicted positions"));
    run_scene(skipping);
    run_scene(whole);
    const auto reference = whole.simulation.positions(whole.cloths[0]);
    CHECK(largest_vertex_distance(skipping.simulation, skipping.cloths, reference) < 1e-9);
}

TEST_CASE("a plan says which scheme was chosen and why, and warns of steps that are too long") {
    const BuiltScene open = built(falling_sheet(), {{"step.scheme", "auto"}});
    CHECK(plan_text(open).find(plan_of(open).scheme_reason) != std::string::npos);
    CHECK(nlohmann::json::parse(plan_json(open)).at("scheme_reason") == plan_of(open).scheme_reason);
    CHECK(plan_of(open).scheme != Scheme::automatic);
    CHECK(plan_of(open).warnings.empty());
    const BuiltScene stiff = built(falling_sheet(), {{"fabric.sheet.springs.structural", "1e5"}});
    const std::vector<Finding> found = plan_findings(stiff, plan_of(stiff));
    REQUIRE(found.size() == 1);
    CHECK(found[0].kind == "unstable_step");
    CHECK(found[0].place == place_text(stiff.scene.scheme_place));
    CHECK(plan_text(stiff).find("warning    " + finding_text(found[0]) + "\n") != std::string::npos);
    const auto json = nlohmann::json::parse(plan_json(stiff));
    CHECK(json.at("warnings") == nlohmann::json(finding_texts(found)));
    CHECK(json.at("findings").at(0).at("kind") == "unstable_step");
    const BuiltScene adaptive = built(sheet_on_box(), {{"step.time_step", "auto"}, {"step.tolerance", "0.002"}});
    CHECK(plan_text(adaptive).find("an error of 0.002 m a second allows, tr_bdf2") != std::string::npos);
    CHECK(nlohmann::json::parse(plan_json(adaptive)).at("time_step_s") == "auto");
}

TEST_CASE("a plan of a scene that ends at rest says so, and how many steps that may take") {
    const BuiltScene scene = built(sheet_on_box(), {{"duration", "rest"}, {"max_duration", "3"}});
    CHECK(plan_text(scene).find("until rest, at most 3 s; at most 180 steps of 0.0167 s, backward_euler") != std::string::npos);
    CHECK(nlohmann::json::parse(plan_json(scene)).at("steps") == 180);
    CHECK(nlohmann::json::parse(plan_json(scene)).at("until_rest") == true);
    const BuiltScene adaptive = built(sheet_on_box(), {{"duration", "rest"}, {"step.time_step", "auto"}});
    CHECK(plan_text(adaptive).find("until rest, at most 20 s; steps as long as an error of ") != std::string::npos);
    CHECK(nlohmann::json::parse(plan_json(built(sheet_on_box()))).at("until_rest") == false);
}

TEST_CASE("text and JSON say the same") {
    const BuiltScene scene = built(sheet_on_box());
    const std::string text = plan_text(scene);
    const auto json = nlohmann::json::parse(plan_json(scene));
    for (const char* part : {"sheet on a box", "12 steps of 0.0167 s, backward_euler", "36, 0 pinned",
                             "158 (60 structural, 50 shear, 48 bending)", "box, 12 triangles", "MB predicted"})
        CHECK(text.find(part) != std::string::npos);
    CHECK(json.at("title") == "sheet on a box");
    CHECK(json.at("scheme") == "backward_euler");
    CHECK(json.at("steps") == 12);
    CHECK(json.at("vertices") == 36);
    CHECK(json.at("springs").at("bend") == 48);
    CHECK(json.at("obstacles").at(0).at("name") == "box");
    CHECK(json.at("obstacles").at(0).at("triangles") == 12);
    CHECK(json.at("memory_bytes").get<double>() == plan_of(scene).memory_bytes);
    for (const auto& skip : json.at("skipped"))
        CHECK(text.find("  " + skip.at("what").get<std::string>() + ": " + skip.at("why").get<std::string>()) !=
              std::string::npos);
    CHECK(text.find("  contact of sheet with cloth: self_contact is false") != std::string::npos);
    const std::string all = plan_text(built(sheet_on_box(), {{"step.skip", "false"}, {"fabric.sheet.self_contact", "true"}}));
    for (const char* skip : {"motion", "work", "energy", "matrix", "contact"})
        CHECK(all.find(std::string("\n  ") + skip) == std::string::npos);
}

}  // namespace percale::scenes::test::scene_plan_test
