#include "scenes/format/scene_check.h"

#include "percale/options.h"
#include "scenes/common/text.h"
#include "scenes/format/scene_table.h"
#include "tests/scenes/scene_texts.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::scene_check_test {
namespace {

std::string fault(const std::string& text) {
    FaultList first(false);
    return error_of([&] { check_document(parse_toml(text, "t"), first); });
}

// The fault of one more table behind a correct scene of 7 lines; it begins in line 8.
std::string fault_after(const std::string& table) { return fault(small_scene() + table); }

const std::string no_fault = "nothing was thrown";

}  // namespace

TEST_CASE("a correct document has no fault") { CHECK(fault(small_scene()) == no_fault); }

TEST_CASE(
    "all faults of a document are kept where that is asked for, what a table lacks behind its own, and the first is the one "
    "thrown") {
    const std::string text =
        "duraton = 3\n[step]\ntime_step = 5.0\nscheme = 3\n[fabric]\none = 1\n[fabric.two]\nspring = 2\n"
        "[[cloth]]\nname = \"flag\"\npose = { translaton = [0, 0, 0], rotation = 1 }\n";
    FaultList all(true);
    check_document(parse_toml(text, "t"), all);
    std::vector<std::string> places;
    for (const SceneFileError& error : all.found) places.push_back(place_text(error.place()));
    CHECK(places == std::vector<std::string>{"t:1:1", "t:3:13", "t:4:10", "t:6:7", "t:8:1", "t:11:10", "t:11:45", "t:9:1"});
    CHECK(all.found[0].what() == fault(text));
}

TEST_CASE("an unknown key is refused with its place, its table and the nearest valid key") {
    CHECK(fault("[fabric.sheet]\nsprngs = 3\n") ==
          "t:2:1: unknown key 'sprngs' in [fabric.sheet]; did you mean 'springs'? valid: " + joined(keys_inside("fabric")));
    CHECK(
        fault("duraton = 3\n").starts_with("t:1:1: unknown key 'duraton' in the scene; did you mean 'duration'? valid: title, "));
    CHECK(fault_after("[stepp]\n").starts_with("t:8:2: unknown key 'stepp' in the scene; did you mean 'step'?"));
    CHECK(fault_after("pose = { translaton = [0, 0, 0] }\n")
              .starts_with("t:8:10: unknown key 'translaton' in [cloth.flag.pose]; did you mean 'translation'?"));
    CHECK(fault_after("pin = { bx = 3 }\n").starts_with("t:8:9: unknown key 'bx' in [cloth.flag.pin]; did you mean 'box'?"));
    CHECK(fault_after("[expect]\nlargest_stain = 1\n")
              .starts_with("t:9:1: unknown key 'largest_stain' in [expect]; did you mean "
                           "'largest_strain'?"));
}

TEST_CASE("a dot in a quoted key does not reach into a table") {
    CHECK(fault("\"step.time_step\" = 0.1\n").starts_with("t:1:1: unknown key 'step.time_step' in the scene"));
}

TEST_CASE("the first fault in the order of the document is reported") {
    CHECK(fault("zz = 1\naa = 2\n").starts_with("t:1:1: unknown key 'zz'"));
}

TEST_CASE("a missing required key is named at its table") {
    CHECK(fault("[[cloth]]\nfabric = \"sheet\"\n").starts_with("t:1:1: [cloth.0] lacks 'name'"));
    CHECK(fault("[[cloth]]\nname = \"flag\"\n").starts_with("t:1:1: [cloth.flag] lacks 'fabric'"));
    CHECK(fault("duration = 1.0\n").find("the scene lacks 'cloth'") != std::string::npos);
    CHECK(fault_after("[[event]]\nunpin = { cloth = \"flag\", vertices = [0] }\n").starts_with("t:8:1: [event.0] lacks 'time'"));
}

TEST_CASE("a wrong kind of value says what was expected and what was there") {
    CHECK(fault("duration = \"two\"\n") == "t:1:12: duration must be a number or \"rest\" (s), not the text \"two\"");
    CHECK(fault("duration = \"20ms\"\n").ends_with("\"20ms\"; a number is written without its unit, in s: 0.02"));
    CHECK(fault("title = 3\n") == "t:1:9: title must be a text, not the number 3");
    CHECK(fault("step = 3\n") == "t:1:8: step must be a table, not the number 3");
    CHECK(fault("cloth = 3\n") == "t:1:9: cloth must be a list of tables, not the number 3");
    CHECK(fault("[obstacle]\nname = \"ball\"\n") == "t:1:1: obstacle must be a list of tables, not a table; write [[obstacle]]");
    CHECK(fault("cloth = [3]\n") == "t:1:10: cloth.0 must be a list of tables, not the number 3");
    CHECK(fault("fabric = 3\n") ==
          "t:1:10: fabric must be a table of named tables, not the number 3; write [fabric.NAME], once for each");
    CHECK(fault("[fabric]\none = 3\n") == "t:2:7: fabric.one must be a table [fabric.NAME], not the number 3");
    CHECK(fault("[step]\nnewton_iterations = 2.5\n") ==
          "t:2:21: step.newton_iterations must be a whole number, not the number 2.5");
    CHECK(fault("[step]\ntime_step = \"small\"\n") ==
          "t:2:13: step.time_step must be a number or \"auto\" (s), not the text \"small\"");
    CHECK(fault("[step]\nscheme = 1\n").starts_with("t:2:10: step.scheme must be one of "));
    CHECK(fault("duration = true\n") == "t:1:12: duration must be a number or \"rest\" (s), not true");
    CHECK(fault("duration = 2024-01-01\n") == "t:1:12: duration must be a number or \"rest\" (s), not a date or time");
}

TEST_CASE("a number out of range is reported with key, value, unit and allowed range") {
    CHECK(fault("duration = -2.0\n") == "t:1:12: duration = -2 s is out of range; allowed: 1e-6 ... 1e6 s");
    CHECK(fault("duration = nan\n") == "t:1:12: duration = nan s is not finite");
    CHECK(fault("gravity = [0, -inf, 0]\n") == "t:1:15: gravity[1] = -inf m/s^2 is not finite");
    CHECK(fault("gravity = [0, 0, 1e5]\n") == "t:1:18: gravity[2] = 1e5 m/s^2 is out of range; allowed: -10000 ... 10000 m/s^2");
    CHECK(fault("gravity = [0, -9.81]\n") == "t:1:11: gravity must be a list of 3 numbers (m/s^2), not a list of 2");
}

TEST_CASE("a flag is true or false and nothing like it") {
    for (const char* good : {"true", "false"}) CHECK(fault_after(std::string("[step]\nskip = ") + good + "\n") == no_fault);
    for (const char* bad : {"0", "\"true\"", "[true]"})
        CHECK(fault_after(std::string("[step]\nskip = ") + bad + "\n").find("step.skip must be true or false") !=
              std::string::npos);
}

TEST_CASE("the ends of every option's range are allowed and what lies beyond is not") {
    const auto try_value = [](const std::string& table, const std::string& key, double value) {
        return fault_after("[" + table + "]\n" + key + " = " + number_text(value) + "\n");
    };
    const auto try_fabric = [&](const std::string& key, const std::string& value) {
        const std::string springs = key == "springs.structural" ? "" : "springs.structural = 1\n";
        return fault_after("[fabric.other]\n" + springs + key + " = " + value + "\n");
    };
    for (const auto& option : fabric_options()) {
        if (option.flag || !option.choices.empty()) continue;
        const std::string key(option.key);
        CAPTURE(key);
        const auto text = [&](double value) {
            return option.optional_pair ? "[1, " + number_text(value) + "]" : number_text(value);
        };
        CHECK(try_fabric(key, text(option.lowest)) == no_fault);
        CHECK(try_fabric(key, text(option.highest)) == no_fault);
        CHECK(try_fabric(key, text(option.highest * 1.01)).find("is out of range") != std::string::npos);
        CHECK(try_fabric(key, text(option.lowest - 1.0)).find("is out of range") != std::string::npos);
    }
    for (const auto& option : step_options()) {
        if (!option.choices.empty() || option.flag) continue;
        const std::string key(option.key);
        CAPTURE(key);
        CHECK(try_value("step", key, option.lowest) == no_fault);
        CHECK(try_value("step", key, option.highest) == no_fault);
        CHECK(try_value("step", key, option.highest + 1.0).find("is out of range") != std::string::npos);
    }
}

TEST_CASE("an unknown word is refused with the nearest choice") {
    CHECK(fault("[step]\ndetector = \"bullit\"\n") ==
          "t:2:12: step.detector has no choice 'bullit'; did you mean 'bullet'? valid: fcl, bullet, brute_force, none");
    CHECK(fault("[output]\nframes = \"alembic\"\n") ==
          "t:2:10: output.frames has no choice 'alembic'; valid: none, obj, ply, glb, pc2, mdd, vtp");
}

TEST_CASE("pins on an obstacle need a box, and only the pins of a cloth may be on one") {
    CHECK(fault_after("pin = { box = [[0, 0, 0], [1, 1, 1]], to = \"ball\" }\n") == no_fault);
    CHECK(fault_after("pin = { to = \"ball\" }\n").find("lacks 'box'") != std::string::npos);
    CHECK(fault_after(
              "[[event]]\ntime = 1\nunpin = { cloth = \"flag\", vertices = { box = [[0, 0, 0], [1, 1, 1]], to = \"ball\" } }\n")
              .find("unknown key 'to'") != std::string::npos);
}

TEST_CASE("a list of words takes each choice once") {
    CHECK(fault_after("[output]\nfields = []\n") == no_fault);
    CHECK(fault_after("[output]\nfields = [\"pressure\", \"strain\"]\n") == no_fault);
    CHECK(fault_after("[output]\nfields = \"strain\"\n") == no_fault);
    CHECK(fault("[output]\nfields = 3\n").find("must be one of strain, pressure, distance, or a list of some of them") !=
          std::string::npos);
    CHECK(fault("[output]\nfields = [\"strian\"]\n").find("no choice 'strian'; did you mean 'strain'?") != std::string::npos);
    CHECK(fault("[output]\nfields = [\"strain\", \"strain\"]\n") == "t:2:21: output.fields has 'strain' twice");
    CHECK(fault("[output]\nfields = [3]\n").find("or a list of some of them") != std::string::npos);
}

TEST_CASE("formats of frames are one or several") {
    CHECK(fault_after("[output]\nframes = [\"obj\", \"pc2\"]\n") == no_fault);
    CHECK(fault_after("[output]\nframes = [\"none\"]\n") == no_fault);
}

TEST_CASE("an unknown key is refused with those that its table has") {
    CHECK(fault("[[cloth]]\nname = \"a\"\nshape = \"shirt.json\"\n")
              .starts_with("t:3:1: unknown key 'shape' in [cloth.a]; valid: name, "));
    CHECK(
        fault_after("[[event]]\ntime = 1\ndetach = 3\n").starts_with("t:10:1: unknown key 'detach' in [event.0]; valid: time, "));
}

TEST_CASE("a number or auto takes both and nothing else") {
    CHECK(fault_after("[step]\nnewton_tolerance = \"auto\"\n") == no_fault);
    CHECK(fault_after("[step]\nnewton_tolerance = 1e-3\n") == no_fault);
    CHECK(fault_after("[step]\nnewton_tolerance = \"tight\"\n").find("must be a number or \"auto\"") != std::string::npos);
    CHECK(fault_after("[step]\nnewton_tolerance = 0.0\n").find("is out of range") != std::string::npos);
}

TEST_CASE("vertices are indices, a box or the boundary") {
    CHECK(fault_after("pin = [0, 4]\n") == no_fault);
    CHECK(fault_after("pin = []\n") == no_fault);
    CHECK(fault_after("pin = \"boundary\"\n") == no_fault);
    CHECK(fault_after("pin = { box = [[0, 0, 0], [1, 1, 1]] }\n") == no_fault);
    CHECK(fault_after("pin = \"bounds\"\n").starts_with("t:8:7: cloth.flag.pin must be a list of vertex indices"));
    CHECK(fault_after("pin = {}\n").starts_with("t:8:7: cloth.flag.pin must be a list of vertex indices"));
    CHECK(fault_after("pin = 3\n").starts_with("t:8:7: cloth.flag.pin must be a list of vertex indices"));
    CHECK(fault_after("pin = [-1]\n").find("cloth.flag.pin = -1 is out of range; allowed: 0 ...") != std::string::npos);
    CHECK(fault_after("pin = [0.5]\n").find("must be a whole number") != std::string::npos);
    CHECK(fault_after("pin = [99999999999]\n").find("is out of range") != std::string::npos);
}

TEST_CASE("a box is two corners, the first nowhere above the second") {
    CHECK(fault_after("pin = { box = [[0, 0, 0]] }\n").find("cloth.flag.pin.box must be two corners") != std::string::npos);
    CHECK(fault_after("pin = { box = [[0, 0, 0], [1, 1]] }\n").find("pin.box[1] must be a list of 3 numbers") !=
          std::string::npos);
    CHECK(fault_after("pin = { box = [[0, 0.5, 0], [1, 0.2, 1]] }\n").find("on axis 1 0.5 > 0.2") != std::string::npos);
    CHECK(fault_after("pin = { box = [[0, 0, 0], [1, 1, 100]] }\n").find("is out of range") != std::string::npos);
}

TEST_CASE("an expectation has one of four forms") {
    CHECK(fault_after("[expect]\nintersections = 0\n") == no_fault);
    CHECK(fault_after("[expect]\nlargest_strain = { below = 0.3 }\n") == no_fault);
    CHECK(fault_after("[expect]\nlargest_strain = { above = 0.3 }\n") == no_fault);
    CHECK(fault_after("[expect]\nlargest_strain = { between = [0.1, 0.3] }\n") == no_fault);
    CHECK(fault_after("[expect]\nlargest_strain = { between = [0.3, 0.1] }\n").find("0.3 > 0.1") != std::string::npos);
    CHECK(fault_after("[expect]\nlargest_strain = { between = 0.1 }\n").find("must be a list of 2 numbers") != std::string::npos);
    CHECK(fault_after("[expect]\nlargest_strain = { below = \"x\" }\n").find("expect.largest_strain.below must be a number") !=
          std::string::npos);
    CHECK(fault_after("[expect]\nlargest_strain = { below = 1, above = 0 }\n")
              .find("exactly one of below, above, between, not 2") != std::string::npos);
    CHECK(fault_after("[expect]\nlargest_strain = {}\n").find("exactly one of below, above, between, not 0") !=
          std::string::npos);
    CHECK(fault_after("[expect]\nlargest_strain = { belo = 1 }\n").find("did you mean 'below'?") != std::string::npos);
    CHECK(fault_after("[expect]\nlargest_strain = \"low\"\n").find("must be a number, {") != std::string::npos);
    CHECK(fault_after("[expect]\nlargest_strain = inf\n").find("is not finite") != std::string::npos);
}

TEST_CASE("matches needs a file and a distance") {
    CHECK(fault_after("[expect]\nmatches = { file = \"a.obj\", within = 1e-3 }\n") == no_fault);
    CHECK(fault_after("[expect]\nmatches = { file = \"a.obj\" }\n").find("lacks 'within'") != std::string::npos);
    CHECK(fault_after("[expect]\nmatches = 3\n").find("expect.matches must be a table") != std::string::npos);
}

TEST_CASE("a part of a document is checked as it is in the whole") {
    const auto fault_of = [](const std::string& text, const std::string& path) {
        return error_of([&] {
            FaultList first(false);
            check_part(parse_toml(text, "t"), path, first);
        });
    };
    CHECK(fault_of("time_stp = 1", "step").find("did you mean 'time_step'") != std::string::npos);
    CHECK(fault_of("time_step = 7", "step").find("step.time_step = 7 s is out of range") != std::string::npos);
    CHECK(fault_of("[springs]\nshear = 1.0", "fabric").find("[fabric.springs] lacks 'structural'") != std::string::npos);
    FaultList first(false);
    CHECK_NOTHROW(check_part(parse_toml("time_step = 0.5", "t"), "step", first));
}

TEST_CASE("the error of a fabric without a name says how to name it, a fabric with the name of a key is no error") {
    const std::string advice = "[fabric] lacks a name; write [fabric.NAME], not [fabric], above '";
    CHECK(fault("[fabric]\narea_density = 0.2\n") == "t:2:1: " + advice + "area_density'");
    CHECK(fault("[fabric]\nsprings = { structural = 500 }\n") == "t:2:1: " + advice + "springs'");
    FaultList all(true);
    check_document(parse_toml("[fabric]\narea_density = 0.2\nthickness = 0.005\nspring_damping = 0\n", "t"), all);
    CHECK(std::ranges::count_if(all.found, [](const SceneFileError& one) {
              return std::string(one.what()).find("lacks a name") != std::string::npos;
          }) == 1);
    CHECK(fault_after("[fabric.springs]\narea_density = 0.2\nsprings = { structural = 500 }\n") == no_fault);
    CHECK(fault("[[fabric]]\nname = \"f\"\n") ==
          "t:1:1: fabric must be a table of named tables, not a list of 1; write [fabric.NAME], once for each");
}

TEST_CASE("the errors of a rotation in degrees, and of one of three numbers, say what a quaternion is") {
    const std::string advice = "; it is a unit quaternion [w, x, y, z]: a turn by the angle a about";
    CHECK(fault_after("pose = { rotation = [0, 90, 0, 0] }\n").find("allowed: -1.001 ... 1.001" + advice) != std::string::npos);
    CHECK(fault_after("pose = { rotation = [0, 90, 0] }\n").find("not a list of 3" + advice) != std::string::npos);
    CHECK(fault_after("pose = { translation = [0, 9e99, 0] }\n").find("quaternion") == std::string::npos);
}

}  // namespace percale::scenes::test::scene_check_test
