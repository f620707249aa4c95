#include "scenes/meshes/mesh_import.h"
#include "tests/scenes/pattern/garments.h"
#include "tests/scenes/program/run_program.h"
#include "tests/support/catch.h"

namespace percale::program::test::sew_test {

TEST_CASE("a pattern is sewn into a mesh, which a scene drapes with its seams closed") {
    const TestFolder folder;
    folder.write("skirt.toml", scenes::test::skirt_text);
    const ProgramRun sewn = run_program({"sew", "skirt.toml", "-o", "skirt.obj", "--edge-length", "0.04"}, folder.path());
    CAPTURE(sewn.out, sewn.error);
    CHECK(sewn.exit_code == 0);
    CHECK(sewn.out.find("skirt.obj: 2 panels, ") != std::string::npos);
    CHECK(sewn.out.find("2 seams of ") != std::string::npos);
    const std::string head =
        "duration = 0.8\ngravity = [0, 0, 0]\n[fabric.f]\npreset = \"cotton\"\ndamping_time = 0.05\n"
        "[[cloth]]\nname = \"skirt\"\nfabric = \"f\"\n";
    const std::string seam = "[[seam]]\nfile = \"mesh\"\nduration = 0.3\n";
    folder.write("by_mesh.toml", head + "mesh = \"skirt.obj\"\nrest = \"uv\"\n" + seam);
    folder.write("by_pattern.toml", head + "pattern = \"skirt.toml\"\nedge_length = 0.04\n" + seam);
    for (const std::string name : {"by_mesh", "by_pattern"}) {
        const ProgramRun run = run_program({"run", name + ".toml", "-o", name, "--quiet"}, folder.path());
        CAPTURE(run.error);
        CHECK(run.exit_code == 0);
        CHECK(folder.read(name + "/report.json").find("\"largest_gap\": 0.2") == std::string::npos);
    }
    // The same cloth either way, in every bit; a frame of the mesh has what that file has besides.
    const TriangleMesh by_mesh = scenes::import_mesh(folder.path("by_mesh/frames/skirt_00024.obj"));
    const TriangleMesh by_pattern = scenes::import_mesh(folder.path("by_pattern/frames/skirt_00024.obj"));
    CHECK(by_mesh.vertices == by_pattern.vertices);
    CHECK(by_mesh.triangles == by_pattern.triangles);
    CHECK(folder.read("by_mesh/frames/skirt_00024.obj").find("\nvt ") != std::string::npos);
}

TEST_CASE("a pattern that cannot be sewn leaves nothing behind") {
    const TestFolder folder;
    folder.write("bad.toml", "unit = \"cm\"\n[[panel]]\nname = \"a\"\npoints = [[0, 0], [40, 40], [40, 0], [0, 30]]\n");
    CHECK(refused(run_program({"sew", "bad.toml", "-o", "out.obj"}, folder.path()), "crosses itself"));
    CHECK(refused(run_program({"sew", "bad.toml", "-o", "out.stl"}, folder.path()), "must end in .obj"));
    CHECK(refused(run_program({"sew", "none.toml", "-o", "out.obj"}, folder.path()), "none.toml: cannot be read"));
    CHECK(folder.file_count() == 1);
}

}  // namespace percale::program::test::sew_test
