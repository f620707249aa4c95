#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "format/expectations.h"
#include "run/run_scene.h"

namespace percale::python {

namespace py = pybind11;

/// An output frame that is kept.
struct KeptFrame {
    int index = 0;
    double time = 0.0;  // s
    std::vector<std::vector<Vec3>> cloths, obstacles;
    scenes::FrameCheck check;
};

/// A run with what Python asks of it.
struct SceneRun {
    scenes::RunResult result;
    std::vector<scenes::ExpectationResult> expectations;
    std::vector<std::string> cloth_names, obstacle_names, warnings;
    std::vector<KeptFrame> frames;
    std::string report;  // JSON
    std::uint64_t state_hash = 0;

    bool passed() const;
};

/// What `on_step` sees of a run; good during the call alone.
struct RunView {
    const scenes::BuiltScene* built = nullptr;  // null after the call

    const scenes::BuiltScene& now() const;
};

/// What a run is asked for beside its result.
struct RunWishes {
    std::string output;        // folder; "": nothing is written
    py::object on_step;        // None: nothing is called
    bool keep_frames = false;  // in SceneRun::frames
    bool certify_steps = false;
};

/// Runs a scene without the GIL but for `on_step`; a Python error there, or a KeyboardInterrupt, ends it and leaves no files.
std::shared_ptr<SceneRun> run_with(const scenes::Scene& scene, const RunWishes& wishes);

/// Scene, path of a file, or dict laid out like one; overrides as of the program's --set.
scenes::Scene scene_from(py::handle source, py::handle overrides);

}  // namespace percale::python
