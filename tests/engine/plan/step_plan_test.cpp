#include "engine/plan/step_plan.h"

#include <algorithm>

#include "tests/support/catch.h"

namespace percale::test::step_plan_test {
namespace {

constexpr ScriptedChanges nothing_moves;

bool skips(const StepSettings& settings, const SceneFacts& facts, const std::string& what) {
    const std::vector<Skip> skipped = skipped_by(make_step_plan(settings, facts), settings, facts);
    return std::any_of(skipped.begin(), skipped.end(),
                       [&](const Skip& skip) { return skip.what.find(what) != std::string::npos && !skip.why.empty(); });
}

/// The reason for a skip, empty where there is none.
std::string why_skipped(const StepSettings& settings, const SceneFacts& facts, const std::string& what) {
    for (const Skip& skip : skipped_by(make_step_plan(settings, facts), settings, facts)) {
        if (skip.what.find(what) != std::string::npos) return skip.why;
    }
    return "";
}

SceneFacts sheet_facts() {
    SceneFacts facts;
    facts.cloth_vertices = 9;
    facts.cloths = {{"sheet", true, {.springs = {.structural = 100.0, .shear = 50.0, .bend = 1.0}}}};
    return facts;
}

ScriptedChanges changes(bool obstacles, bool pins) {
    ScriptedChanges result;
    result.obstacles = obstacles;
    result.pins = pins;
    return result;
}

}  // namespace

TEST_CASE("Contacts are planned only where there is cloth and an obstacle") {
    for (const int vertices : {0, 9}) {
        for (const int obstacles : {0, 1, 3}) {
            const SceneFacts facts{.cloth_vertices = vertices, .obstacles = obstacles};
            const StepPlan plan = make_step_plan({}, facts);
            CHECK(plan.contacts == (vertices > 0 && obstacles > 0));
            CHECK(skips({}, facts, "contact detection") == !plan.contacts);
            CHECK_FALSE(make_step_plan({.scheme = Scheme::rk4}, facts).contacts);
        }
    }
}

TEST_CASE("Contacts are planned where cloth meets cloth, and cloth without contact is listed by name") {
    SceneFacts facts = sheet_facts();
    facts.cloths[0].fabric.self_contact = true;
    CHECK(make_step_plan({}, facts).contacts);
    CHECK_FALSE(skips({}, facts, "contact"));
    CHECK_FALSE(skips({}, facts, "motion of obstacles"));
    facts.cloths.push_back({"towel"});
    CHECK(make_step_plan({}, facts).contacts);
    CHECK(skips({}, facts, "contact of towel with cloth"));
    CHECK_FALSE(skips({}, facts, "contact of sheet with cloth"));
    facts.cloths[0].fabric.self_contact = false;
    CHECK_FALSE(make_step_plan({}, facts).contacts);
    CHECK(skips({}, facts, "contact detection"));
}

TEST_CASE("The plan passes on the motion in the coming step") {
    const StepSettings measured{.measure = StepMeasures::all};
    for (const bool obstacles : {false, true}) {
        for (const bool pins : {false, true}) {
            const SceneFacts facts{.cloth_vertices = 4, .obstacles = 1, .changes = changes(obstacles, pins)};
            StepPlan plan = make_step_plan(measured, facts);
            CHECK(plan.obstacles_move == obstacles);
            CHECK(plan.pins_move == pins);
            CHECK(plan.pin_work == pins);
            set_motion(plan, nothing_moves);
            CHECK_FALSE((plan.obstacles_move || plan.pins_move || plan.pin_work));
        }
    }
}

TEST_CASE("Explicit schemes damp by velocity whatever the setting") {
    for (const DampingForm form : {DampingForm::length_rate, DampingForm::velocity}) {
        for (const Scheme scheme : {Scheme::symplectic_euler, Scheme::rk4, Scheme::backward_euler}) {
            const StepPlan plan = make_step_plan({.scheme = scheme, .damping_form = form}, {.cloth_vertices = 4});
            CHECK(plan.implicit == (scheme == Scheme::backward_euler));
            CHECK(plan.damping == (plan.implicit ? form : DampingForm::velocity));
            CHECK(skips({.scheme = scheme, .damping_form = form}, {.cloth_vertices = 4}, "linear solve") == !plan.implicit);
        }
    }
}

TEST_CASE("Without damping no start lengths are planned") {
    SceneFacts facts = sheet_facts();
    CHECK(make_step_plan({}, facts).damping == DampingForm::length_rate);
    CHECK_FALSE(skips({}, facts, "start lengths"));
    facts.damped = false;
    CHECK(make_step_plan({}, facts).damping == DampingForm::velocity);
    CHECK(skips({}, facts, "start lengths"));
    CHECK_FALSE(skips({.damping_form = DampingForm::velocity}, facts, "start lengths"));
}

TEST_CASE("Where no vertex is free nothing is solved, unless a pin moves or contact has to be checked") {
    for (const int pinned : {0, 8, 9}) {
        for (const int obstacles : {0, 1}) {
            for (const bool pins_move : {false, true}) {
                SceneFacts facts = sheet_facts();
                facts.pinned_vertices = pinned;
                facts.obstacles = obstacles;
                facts.changes.pins = pins_move;
                const bool needed = pinned < 9 || obstacles > 0 || pins_move;
                CHECK(make_step_plan({}, facts).solve == needed);
                CHECK(skips({}, facts, "the whole solve") == !needed);
            }
        }
    }
    CHECK_FALSE(make_step_plan({}, SceneFacts{}).solve);
}

TEST_CASE("Spring kinds that a cloth lacks are listed by cloth, with the reason") {
    SceneFacts facts = sheet_facts();
    for (const char* kind : {"structural", "shear", "bending"}) CHECK_FALSE(skips({}, facts, kind));
    facts.cloths[0].fabric.springs = {.structural = 0.0, .shear = 0.0, .bend = 0.0};
    for (const char* kind : {"structural springs of sheet", "shear springs of sheet", "bending springs of sheet"})
        CHECK(skips({}, facts, kind));
    facts.cloths[0].grid = false;
    const std::vector<Skip> skipped = skipped_by(make_step_plan({}, facts), {}, facts);
    const auto shear = std::find_if(skipped.begin(), skipped.end(), [](const Skip& s) { return s.what.starts_with("shear"); });
    REQUIRE(shear != skipped.end());
    CHECK(shear->why == "a free mesh has none");
}

TEST_CASE("Known future motion of the script is not listed as skipped") {
    SceneFacts facts = sheet_facts();
    facts.obstacles = 1;
    CHECK(skips({}, facts, "motion of obstacles"));
    CHECK(skips({}, facts, "motion and work of pins"));
    facts.pinned_vertices = 2;
    CHECK_FALSE(skips({}, facts, "motion and work of pins"));
    CHECK(skips({}, facts, "work of pins"));
    facts.changes = changes(true, true);
    CHECK_FALSE(skips({}, facts, "motion of obstacles"));
    CHECK_FALSE(skips({}, facts, "work of pins"));
}

TEST_CASE("Gravity that is and stays zero has no energy to be measured") {
    const StepSettings heavy{.measure = StepMeasures::all};
    const StepSettings weightless{.measure = StepMeasures::all, .gravity = Vec3::Zero()};
    SceneFacts facts = sheet_facts();
    CHECK(make_step_plan(heavy, facts).gravity_energy);
    CHECK_FALSE(skips(heavy, facts, "energy of gravity"));
    CHECK_FALSE(make_step_plan(weightless, facts).gravity_energy);
    CHECK(skips(weightless, facts, "energy of gravity"));
    facts.changes.gravity = true;
    CHECK(make_step_plan(weightless, facts).gravity_energy);
    CHECK_FALSE(skips(weightless, facts, "energy of gravity"));
}

TEST_CASE("Measures are left out where the setting excludes them") {
    SceneFacts facts = sheet_facts();
    facts.changes.pins = true;
    const StepSettings automatic, none{.measure = StepMeasures::none};
    for (const auto& [settings, why] :
         {std::pair(automatic, "nothing reads them after each step"), std::pair(none, "step.measure is none")}) {
        const StepPlan plan = make_step_plan(settings, facts);
        CHECK_FALSE((plan.measures || plan.ledger || plan.pin_work));
        CHECK(why_skipped(settings, facts, "energy, strain and speed") == why);
        CHECK(why_skipped(settings, facts, "ledger of energy") == why);
    }
    const StepSettings all{.measure = StepMeasures::all};
    const StepPlan measured = make_step_plan(all, facts);
    CHECK((measured.measures && measured.gravity_energy && measured.pin_work));
    CHECK_FALSE(measured.ledger);
    CHECK_FALSE(skips(all, facts, "energy, strain and speed"));
    CHECK(why_skipped(all, facts, "ledger of energy") == "step.measure is all");
    const StepSettings ledger{.measure = StepMeasures::ledger};
    CHECK((make_step_plan(ledger, facts).ledger && make_step_plan(ledger, facts).measures));
    CHECK_FALSE(skips(ledger, facts, "ledger of energy"));
}

TEST_CASE("With skipping off only absent things are left out") {
    SceneFacts facts = sheet_facts();
    facts.pinned_vertices = 9;
    facts.damped = false;
    facts.detector = true;
    facts.cloths[0].fabric.self_contact = true;
    const StepSettings all{.measure = StepMeasures::none, .skip = false, .gravity = Vec3::Zero()};
    const StepPlan plan = make_step_plan(all, facts);
    CHECK((plan.solve && plan.contacts && plan.pins && plan.pin_work && plan.still_obstacles && plan.gravity_energy &&
           plan.measures && plan.everything));
    CHECK_FALSE((plan.rest || plan.keep_work_space));
    CHECK(plan.damping == DampingForm::length_rate);
    const auto whats = [&] {
        std::vector<std::string> result;
        for (const Skip& skip : skipped_by(plan, all, facts)) result.push_back(skip.what);
        return result;
    };
    const std::vector<std::string> absent = {"closing of seams", "triangle springs of sheet", "strain limit of sheet",
                                             "hinges of sheet",  "drag of the air",           "pressure in sheet"};
    CHECK(whats() == absent);
    facts.cloths[0].fabric.springs.bend = 0.0;
    const std::vector<std::string> more = whats();
    CHECK(more.size() == absent.size() + 1);
    CHECK(std::count(more.begin(), more.end(), "bending springs of sheet") == 1);
}

TEST_CASE("Springs that cloth of given moduli lacks are listed") {
    SceneFacts facts = sheet_facts();
    CHECK(skips({}, facts, "triangle springs of sheet"));
    facts.cloths[0].fabric = {.stretch_stiffness = {{90.0, 80.0}}};
    CHECK_FALSE(skips({}, facts, "triangle springs of sheet"));
    CHECK(skips({}, facts, "springs of sheet other than along edges"));
    facts.cloths[0].fabric.membrane = Membrane::van_gelder;
    CHECK(skips({}, facts, "triangle springs of sheet"));
}

}  // namespace percale::test::step_plan_test
