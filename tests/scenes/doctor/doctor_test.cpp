#include "doctor/doctor.h"

#include "meshes/obj_file.h"
#include "tests/scenes/faulty_meshes.h"
#include "tests/scenes/message_of.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::doctor_test {

TEST_CASE("a mesh file is looked at as cloth and as obstacle, or as what it is said to be") {
    const TestFolder folder;
    const TriangleMesh crowded = crowded_sheet();
    write_obj(folder.path("crowded.obj"), crowded.vertices, crowded.triangles);
    const Diagnosis both_ways = diagnose(folder.path("crowded.obj"));
    REQUIRE(both_ways.findings.size() >= 2);
    CHECK(both_ways.findings[0].severity == Severity::error);
    CHECK(both_ways.findings[0].role == MeshRole::cloth);
    CHECK(both_ways.count(Severity::error) == 1);
    CHECK(both_ways.has("crowded_edges"));
    CHECK_FALSE(both_ways.has("slivers"));
    for (const MeshRole role : {MeshRole::cloth, MeshRole::obstacle}) {
        const Diagnosis one = diagnose(folder.path("crowded.obj"), {.role = role});
        for (const Finding& finding : one.findings) CHECK(finding.role == role);
        CHECK(one.count(Severity::error) == (role == MeshRole::cloth ? 1 : 0));
    }
}

TEST_CASE("errors come before warnings and these before notes") {
    const TestFolder folder;
    const TriangleMesh mesh = scaled(crowded_sheet(), 1000.0);
    write_obj(folder.path("mesh.obj"), mesh.vertices, mesh.triangles);
    const Diagnosis diagnosis = diagnose(folder.path("mesh.obj"));
    CHECK(diagnosis.count(Severity::warning) > 0);
    CHECK(diagnosis.count(Severity::note) > 0);
    for (std::size_t i = 1; i < diagnosis.findings.size(); ++i)
        CHECK(diagnosis.findings[i - 1].severity >= diagnosis.findings[i].severity);
}

TEST_CASE("a mesh file that cannot be read is a finding, one that is not there is refused") {
    const TestFolder folder;
    const Diagnosis broken = diagnose(folder.write("broken.obj", "v 0 0 nan\nf 1 2 3\n"));
    REQUIRE(broken.findings.size() == 1);
    CHECK(broken.findings[0].kind == "unreadable");
    CHECK(broken.findings[0].severity == Severity::error);
    CHECK(broken.findings[0].place == broken.file + ":1");
    CHECK(broken.findings[0].what.find("coordinate z is not") != std::string::npos);
    CHECK(diagnose(folder.write("empty.ply", "")).has("unreadable"));
    CHECK(message_of([&] { diagnose(folder.path("none.obj")); }).find("no such file") != std::string::npos);
    CHECK(message_of([&] { diagnose(folder.path()); }).find("not a file") != std::string::npos);
}

TEST_CASE("the files of a folder that can be looked at are its scenes and meshes, by name") {
    const TestFolder folder;
    CHECK(message_of([&] { examinable_files(folder.path()); }).find("no scene file and no mesh file") != std::string::npos);
    for (const char* name : {"b.obj", "c.STL", "a.toml", "d.txt", "e"}) folder.write(name, "");
    const std::vector<std::string> files = examinable_files(folder.path());
    REQUIRE(files.size() == 3);
    CHECK((files[0] == folder.path("a.toml") && files[1] == folder.path("b.obj") && files[2] == folder.path("c.STL")));
}

TEST_CASE("a file whose name ends in .toml is a scene, with its overrides") {
    const TestFolder folder;
    const std::string file = folder.write("Scene.TOML", falling_sheet());
    CHECK(diagnose(file).has("free_fall"));
    CHECK_FALSE(diagnose(file, {.overrides = {{"gravity", "[0, 0, 0]"}}}).has("free_fall"));
}

}  // namespace percale::scenes::test::doctor_test
