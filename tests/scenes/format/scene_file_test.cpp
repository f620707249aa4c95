#include "scenes/format/scene_file.h"

#include <filesystem>

#include "percale/fabric_presets.h"
#include "tests/scenes/scene_texts.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::scene_file_test {
namespace {

Scene scene_with(const std::string& before, const std::string& after = "") {
    return parse_scene(before + small_scene() + after, "t");
}

std::string fault(const std::string& text) {
    return error_of([&] { parse_scene(text, "t"); });
}

Scene scene_set(const std::string& key, const std::string& value) {
    const Override override{key, value};
    return parse_scene(small_scene(), "t", {&override, 1});
}

}  // namespace

TEST_CASE("a scene that says nothing more has the defaults of the structs") {
    const Scene scene = parse_scene(small_scene(), "t");
    CHECK(scene.file == "t");
    CHECK(scene.duration == Scene{}.duration);
    CHECK(scene.step.time_step == StepSettings{}.time_step);
    CHECK(scene.step.scheme == StepSettings{}.scheme);
    CHECK(scene.step.gravity == StepSettings{}.gravity);
    CHECK(scene.detector == Detector::fcl);
    CHECK(scene.output.frames == std::vector<std::string>{"obj"});
    CHECK(scene.output.fps == 30.0);
    CHECK(scene.fabrics.at("sheet").area_density == Fabric{}.area_density);
    CHECK(scene.fabrics.at("sheet").springs.shear == 500.0);
    CHECK(scene.cloths.at(0).name == "flag");
    CHECK(scene.cloths.at(0).place.line == 4);
    CHECK(scene.obstacles.empty());
    CHECK(scene.events.empty());
    CHECK(scene.expectations.empty());
}

TEST_CASE("top-level keys, steps and output are read") {
    const Scene scene = scene_with(
        "title = \"flag\"\nduration = 2\ngravity = [0, -1.5, 0.5]\n"
        "[step]\ntime_step = 0.01\nscheme = \"rk4\"\nnewton_tolerance = 1e-6\nnewton_iterations = 3\nlinear_solver = \"cg\"\n"
        "contact_response = \"penalty\"\ndetector = \"none\"\ndamping_form = \"velocity\"\nmeasure = \"none\"\nskip = false\n"
        "[output]\nframes = \"none\"\nfps = 60\n");
    CHECK(scene.title == "flag");
    CHECK(scene.duration == 2.0);
    CHECK(scene.step.gravity == Vec3(0, -1.5, 0.5));
    CHECK(scene.step.time_step == 0.01);
    CHECK(scene.step.scheme == Scheme::rk4);
    CHECK(scene.step.newton_tolerance == 1e-6);
    CHECK(scene.step.newton_iterations == 3);
    CHECK(scene.step.linear_solver == LinearSolver::cg);
    CHECK(scene.step.contact_response == ContactResponse::penalty);
    CHECK(scene.step.damping_form == DampingForm::velocity);
    CHECK(scene.step.measure == StepMeasures::none);
    CHECK_FALSE(scene.step.skip);
    CHECK(scene.detector == Detector::none);
    CHECK(scene.output.frames == std::vector<std::string>{"none"});
    CHECK(scene.output.fps == 60.0);
}

TEST_CASE("a time step of auto means adaptive steps, by tr_bdf2 unless a scheme is set") {
    const Scene scene = scene_set("step.time_step", "auto");
    CHECK(scene.step.adaptive);
    CHECK(scene.step.time_step == StepSettings{}.time_step);
    CHECK_FALSE(scene_set("step.time_step", "0.01").step.adaptive);
    CHECK(scene_set("step.tolerance", "1e-4").step.tolerance == 1e-4);
}

TEST_CASE("every word of a choice means its value") {
    CHECK(scene_set("step.scheme", "tr_bdf2").step.scheme == Scheme::tr_bdf2);
    CHECK(scene_set("step.scheme", "auto").step.scheme == Scheme::automatic);
    CHECK(scene_set("step.scheme", "symplectic_euler").step.scheme == Scheme::symplectic_euler);
    CHECK(scene_set("step.scheme", "backward_euler").step.scheme == Scheme::backward_euler);
    CHECK(scene_set("step.linear_solver", "auto").step.linear_solver == LinearSolver::automatic);
    CHECK(scene_set("step.damping_form", "length_rate").step.damping_form == DampingForm::length_rate);
    CHECK(scene_set("step.skip", "true").step.skip);
    CHECK(scene_set("step.detector", "fcl").detector == Detector::fcl);
    CHECK(scene_set("step.detector", "bullet").detector == Detector::bullet);
    CHECK(scene_set("step.detector", "brute_force").detector == Detector::brute_force);
    CHECK(scene_set("step.detector", "none").detector == Detector::none);
    CHECK(scene_set("output.frames", "ply").output.frames == std::vector<std::string>{"ply"});
    CHECK_THROWS_WITH(scene_set("output.frames", "[]"),
                      Catch::Contains("output.frames is an empty list; for no frames write \"none\""));
    CHECK_THROWS_WITH(scene_set("output.frames", "[\"obj\", \"none\"]"), Catch::Contains("'none' beside formats"));
    CHECK(scene_set("output.frames", "[\"obj\", \"pc2\"]").output.frames == std::vector<std::string>{"obj", "pc2"});
    CHECK_FALSE(scene_set("step.newton_tolerance", "auto").step.newton_tolerance.has_value());
}

TEST_CASE("every field of a fabric is read") {
    const Scene scene = scene_with("",
                                   "[fabric.felt]\narea_density = 0.25\nthickness = 0.002\nspring_damping = 0.3\nsprings = { "
                                   "structural = 5, shear = 6, bend = 7 }\n");
    const Fabric& felt = scene.fabrics.at("felt");
    CHECK(felt.area_density == 0.25);
    CHECK(felt.thickness == 0.002);
    CHECK(felt.spring_damping == 0.3);
    CHECK(felt.springs.structural == 5.0);
    CHECK(felt.springs.shear == 6.0);
    CHECK(felt.springs.bend == 7.0);
    CHECK(scene.fabrics.size() == 2);
}

TEST_CASE("a fabric must say its springs, the rest is as in the struct") {
    const Scene scene = scene_with("", "[fabric.plain]\nsprings = { structural = 70 }\n");
    const Fabric& plain = scene.fabrics.at("plain");
    CHECK(plain.springs.structural == 70.0);
    CHECK(plain.springs.shear == 0.0);
    CHECK(plain.springs.bend == 0.0);
    CHECK(plain.area_density == Fabric{}.area_density);
    CHECK(plain.spring_damping == Fabric{}.spring_damping);
    const std::string lacks = "t:8:1: [fabric.plain] lacks 'springs', 'stretch_stiffness' or 'preset': ";
    CHECK(fault(small_scene() + "[fabric.plain]\n").starts_with(lacks));
    CHECK(fault(small_scene() + "[fabric.plain]\nthickness = 0.01\n").starts_with(lacks));
    CHECK(fault(small_scene() + "[fabric.plain]\nbend_stiffness = 0.01\n").starts_with(lacks));
    CHECK(fault(small_scene() + "[fabric.plain]\nsprings = { shear = 5 }\n")
              .starts_with("t:9:11: [fabric.plain.springs] lacks 'structural': "));
}

TEST_CASE("a fabric of moduli is read, and has no springs of its own") {
    const Scene scene = scene_with("",
                                   "[fabric.denim]\nstretch_stiffness = [2000, 1500]\nshear_stiffness = 100\npoisson_ratio = "
                                   "0.2\nmembrane = \"triangle_springs\"\ndamping_time = 0.01\nbend_stiffness = 2e-5\n");
    const Fabric& denim = scene.fabrics.at("denim");
    CHECK(denim.stretch_stiffness == std::array{2000.0, 1500.0});
    CHECK(denim.shear_stiffness == 100.0);
    CHECK(denim.poisson_ratio == 0.2);
    CHECK(denim.damping_time == 0.01);
    CHECK(denim.bend_stiffness == 2e-5);
    CHECK(denim.springs.structural == 0.0);
    CHECK(denim.spring_damping == 0.0);
    const Scene isotropic = scene_with("", "[fabric.f]\nstretch_stiffness = [20, 20]\nmembrane = \"van_gelder\"\n");
    const Fabric& van_gelder = isotropic.fabrics.at("f");
    CHECK(van_gelder.membrane == Membrane::van_gelder);
    CHECK(van_gelder.spring_damping == Fabric{}.spring_damping);
}

TEST_CASE("single keys override a preset, and damping of one kind the other") {
    const auto fabric = [](const std::string& keys) {
        return scene_with("", "[fabric.f]\npreset = \"ponte\"\n" + keys).fabrics.at("f");
    };
    const Fabric& ponte = fabric_preset("ponte");
    const Fabric plain = fabric(""), heavy = fabric("area_density = 1.5\nstretch_stiffness = [7, 8]\n");
    CHECK(plain.stretch_stiffness == ponte.stretch_stiffness);
    CHECK(plain.damping_time == ponte.damping_time);
    CHECK(plain.springs.structural == 0.0);
    CHECK(heavy.area_density == 1.5);
    CHECK(heavy.stretch_stiffness == std::array{7.0, 8.0});
    CHECK(heavy.shear_stiffness == ponte.shear_stiffness);
    const Fabric damped = fabric("spring_damping = 0.4\n");
    CHECK(damped.spring_damping == 0.4);
    CHECK_FALSE(damped.damping_time.has_value());
    CHECK(fault(small_scene() + "[fabric.f]\npreset = \"cottn\"\n")
              .starts_with("t:9:10: fabric.f.preset has no choice 'cottn'; did you mean 'cotton'? valid: cotton, "));
    CHECK(fault(small_scene() + "[fabric.f]\nsprings = { structural = 5 }\npreset = \"ponte\"\n") ==
          "t:10:1: [fabric.f]: springs and preset exclude each other");
}

TEST_CASE("keys of a fabric that exclude each other are refused at the second") {
    const auto refusal = [](const std::string& keys) { return fault(small_scene() + "[fabric.f]\n" + keys); };
    const std::string springs = "springs = { structural = 5 }\n", moduli = "stretch_stiffness = [5, 5]\n";
    CHECK(refusal(springs + moduli) == "t:10:1: [fabric.f]: springs and stretch_stiffness exclude each other");
    CHECK(refusal("springs = { structural = 5, bend = 1 }\nbend_stiffness = 1e-5\n") ==
          "t:10:1: [fabric.f]: springs.bend and bend_stiffness exclude each other");
    CHECK(refusal(moduli + "damping_time = 0.1\nspring_damping = 0.1\n") ==
          "t:10:1: [fabric.f]: spring_damping and damping_time exclude each other");
    CHECK(refusal(springs + "shear_stiffness = 5\n") == "t:8:1: [fabric.f]: shear_stiffness needs stretch_stiffness");
    CHECK(refusal("stretch_stiffness = [5, 6]\nmembrane = \"van_gelder\"\n") ==
          "t:8:1: [fabric.f]: membrane = van_gelder is isotropic, stretch_stiffness must be the same along warp and weft");
}

TEST_CASE("events are put in the order of their times, equal times in that of the file") {
    const Scene scene = scene_with("",
                                   "[[event]]\ntime = 2\ngravity = [0, 2, 0]\n[[event]]\ntime = 1\ngravity = [0, 1, 0]\n"
                                   "[[event]]\ntime = 2\ngravity = [0, 3, 0]\n");
    REQUIRE(scene.events.size() == 3);
    CHECK(std::get<GravityEvent>(scene.events[0].what).gravity.y() == 1.0);
    CHECK(std::get<GravityEvent>(scene.events[1].what).gravity.y() == 2.0);
    CHECK(std::get<GravityEvent>(scene.events[2].what).gravity.y() == 3.0);
}

TEST_CASE("overrides come before the checks and their faults name the key") {
    CHECK(scene_set("duration", "3.5").duration == 3.5);
    CHECK(error_of([] { scene_set("durtion", "3.5"); }).starts_with("--set durtion: unknown key 'durtion'"));
    CHECK(error_of([] { scene_set("duration", "-1"); }).starts_with("--set duration: duration = -1 s is out of range"));
    CHECK(error_of([] { scene_set("step.detector", "octree"); }).starts_with("--set step.detector: step.detector has no choice"));
    const Override good{"fabric.sheet.thickness", "0.01"};
    const std::string wrong =
        "[fabric.sheet]\nsprings = { structural = 1 }\nthickness = -1\n[[cloth]]\nname = \"a\"\nfabric = \"sheet\"\n"
        "grid = { size = [1, 1], vertices = [2, 2] }\n";
    CHECK(parse_scene(wrong, "t", {&good, 1}).fabrics.at("sheet").thickness == 0.01);
}

TEST_CASE("an empty file is one clear error") {
    for (const char* text : {"", "\n\n", "# only a remark\n"})
        CHECK(fault(text) == "t: is empty; a scene needs at least one [fabric.NAME] and one [[cloth]]");
}

TEST_CASE("a scene without cloth is an error") {
    CHECK(fault("duration = 1\n").starts_with("t: the scene lacks 'cloth'"));
    CHECK(fault("cloth = []\n") == "t: has no cloth; a scene needs at least one [[cloth]]");
}

TEST_CASE("an unknown fabric is named with the cloth and the nearest fabric") {
    const std::string text =
        "[fabric.sheet]\nsprings = { structural = 1 }\n[[cloth]]\nname = \"flag\"\nfabric = \"shet\"\ngrid = { size = [1, 1], "
        "vertices = [2, 2] }\n";
    CHECK(fault(text) == "t:3:1: cloth 'flag': no fabric 'shet'; did you mean 'sheet'? valid: sheet");
    CHECK(fault("[[cloth]]\nname = \"flag\"\nfabric = \"shet\"\ngrid = { size = [1, 1], vertices = [2, 2] }\n") ==
          "t:1:1: cloth 'flag': no fabric 'shet'");
}

TEST_CASE("an event of an unknown cloth is named with the nearest cloth") {
    CHECK(fault(small_scene() + "[[event]]\ntime = 0\nunpin = { cloth = \"flga\", vertices = [0] }\n") ==
          "t:8:1: event: no cloth 'flga'; did you mean 'flag'? valid: flag");
}

TEST_CASE("a name twice is an error that names both places") {
    const std::string second = "[[cloth]]\nname = \"flag\"\nfabric = \"sheet\"\ngrid = { size = [1, 1], vertices = [2, 2] }\n";
    CHECK(fault(small_scene() + second) == "t:8:1: a second cloth 'flag'; the first is at t:4:1");
    const std::string body = "[[obstacle]]\nname = \"body\"\nshape = { plane = {} }\n";
    CHECK(fault(small_scene() + body + body) == "t:11:1: a second obstacle 'body'; the first is at t:8:1");
}

TEST_CASE("a file is read like its text") {
    const test::TestFolder folder;
    const std::string file = folder.write("good.toml", small_scene());
    const Scene scene = load_scene(file);
    CHECK(scene.file == file);
    CHECK(scene.cloths.at(0).name == "flag");
    CHECK(scene.cloths.at(0).place.file == file);
}

TEST_CASE("a file with a byte order mark and Windows line ends is read") {
    std::string text = small_scene();
    for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) text.insert(i, "\r");
    CHECK(parse_scene("\xef\xbb\xbf" + text, "t").cloths.at(0).place.line == 4);
}

TEST_CASE("a missing file, a folder and a file of rubbish are errors that name them") {
    CHECK(error_of([] { load_scene("no/such/scene.toml"); }) == "no/such/scene.toml: cannot be read: No such file or directory");
    const test::TestFolder folder;
    CHECK(error_of([&] { load_scene(folder.path()); }) == folder.path() + ": is a folder, not a scene file");
    const std::string mesh = folder.write("sheet.OBJ", "v 0 0 0\n");
    CHECK(error_of([&] { load_scene(mesh); }) ==
          mesh + ": is a mesh, not a scene file: a scene names it as mesh, percale drape needs no scene");
    const std::string pattern = folder.write("skirt.toml", "unit = \"cm\"\n[[panel]]\nname = \"a\"\n");
    CHECK(error_of([&] { load_scene(pattern); }).starts_with(pattern + ": is a sewing pattern, not a scene file: "));
    const std::string json = folder.write("skirt.json", "{}");
    CHECK(error_of([&] { load_scene(json); }).starts_with(json + ": is a sewing pattern, not a scene file: "));
    const std::string rubbish = folder.write("rubbish.toml", std::string("\x7f\x45LF\x02\x01\0\0\xff\xfe", 10));
    CHECK(error_of([&] { load_scene(rubbish); }).starts_with(rubbish + ":1:"));
}

TEST_CASE("the scenes of the data folder are correct and each expects something") {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(PERCALE_DATA_DIR "/scenes")) {
        if (entry.path().extension() != ".toml") continue;
        CAPTURE(entry.path().string());
        const Scene scene = load_scene(entry.path().string());
        CHECK_FALSE(scene.title.empty());
        CHECK_FALSE(scene.expectations.empty());
        ++count;
    }
    CHECK(count >= 4);
}

TEST_CASE("the hanging sheet is the common scene of the field, to the number") {
    const Scene scene = load_scene(PERCALE_DATA_DIR "/scenes/hang.toml");
    const Fabric& fabric = scene.fabrics.at(scene.cloths.at(0).fabric);
    CHECK(scene.duration == 2.0);
    CHECK(scene.step.scheme == Scheme::backward_euler);
    CHECK(scene.step.time_step == 1.0 / 60.0);
    CHECK(scene.step.gravity == Vec3(0, -9.81, 0));
    CHECK(fabric.area_density == 0.2);
    CHECK(fabric.springs.structural == 1000.0);
    CHECK(fabric.springs.shear == 500.0);
    CHECK(fabric.springs.bend == 10.0);
    CHECK(fabric.spring_damping == 0.1);
    CHECK(scene.cloths.at(0).grid->size == std::array{1.0, 1.0});
    CHECK(scene.cloths.at(0).grid->vertices == std::array{33, 33});
    CHECK(std::get<VertexIndices>(scene.cloths.at(0).pin).vertices == std::vector<int>{0, 32});
    CHECK(scene.obstacles.empty());
}

TEST_CASE("a document that was not read from a text is a scene as its text is") {
    const Override override{"step.time_step", "0.01"};
    const Scene from_text = parse_scene(small_scene(), "t", {&override, 1});
    const Scene from_document = scene_of_document(parse_toml(small_scene(), "t"), "t", {&override, 1});
    CHECK(from_document.step.time_step == 0.01);
    CHECK(from_document.file == from_text.file);
    CHECK(from_document.cloths.at(0).name == from_text.cloths.at(0).name);
    CHECK(from_document.fabrics.at("sheet").springs.shear == from_text.fabrics.at("sheet").springs.shear);
    CHECK(error_of([&] { scene_of_document(TomlNode(), "t"); }) == fault(""));
}

}  // namespace percale::scenes::test::scene_file_test
