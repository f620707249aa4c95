#pragma once

#include <span>
#include <string>
#include <vector>

#include "export/run_folder.h"
#include "format/scene_file.h"
#include "meshes/obj_file.h"
#include "meshes/ply_output.h"
#include "tests/scenes/test_folder.h"

// Folders of runs: those that a run wrote, and those made by hand.
namespace percale::scenes::test {

/// Runs a scene into a folder, as `percale run` does.
inline void write_run(const std::string& path, const std::string& scene, const std::vector<Override>& overrides = {}) {
    BuiltScene built = build_scene(parse_scene(scene, "test.toml", overrides));
    RunFolder folder(path, built.scene, false);
    RunHooks hooks;
    hooks.begin = [&] { folder.begin(); };
    hooks.frame = [&](const Frame& frame) { folder.add(frame); };
    hooks.step = [&](const StepReport& report, const Simulation& simulation) { folder.add(report, simulation); };
    const RunResult result = run_scene(built, hooks);
    folder.finish(built, result, judge_run(built.scene.expectations, result.measures, result.timed, built.scene));
}

/// A cloth of 3 x 3 vertices that falls by 0.1 m a frame above a ball that rests, as OBJ files and records.
inline std::vector<FrameRecord> write_falling_frames(const TestFolder& folder, int frames) {
    std::filesystem::create_directories(folder.path("frames"));
    const TriangleMesh ball = make_sphere(0.1, 1);
    write_obj(folder.path("frames/ball.obj"), ball.vertices, ball.triangles);
    std::vector<FrameRecord> records;
    for (int i = 0; i < frames; ++i) {
        TriangleMesh sheet = make_grid(0.2, 0.2, 3, 3);
        for (Vec3& x : sheet.vertices) x.y() += 1.0 - 0.1 * i;
        const std::string file = "frames/sheet_" + std::to_string(i) + ".obj";
        write_obj(folder.path(file), sheet.vertices, sheet.triangles);
        records.push_back({.index = i,
                           .time = 0.5 * i,
                           .cloths = {file},
                           .obstacles = {"frames/ball.obj"},
                           .others = {},
                           .check = {},
                           .meeting = {}});
    }
    return records;
}

}  // namespace percale::scenes::test
