#include "python/scene_runs.h"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <optional>

#include "export/run_folder.h"
#include "export/run_settings.h"
#include "format/scene_file.h"
#include "percale/error.h"
#include "python/arrays.h"
#include "python/module.h"
#include "python/released_gil.h"
#include "python/values.h"
#include "run/run_verdict.h"
#include "run/scene_plan.h"

namespace percale::python {
namespace {

using namespace percale::scenes;

/// How a scene that no file holds is named in messages; its meshes are relative to the working directory.
constexpr const char* name_of_dict = "scene";

py::object parsed_json(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

KeptFrame kept(const Frame& frame) {
    KeptFrame copy{.index = frame.index, .time = frame.time, .cloths = {}, .obstacles = {}, .check = frame.check};
    for (const TriangleMesh& mesh : frame.cloths) copy.cloths.push_back(mesh.vertices);
    for (const TriangleMesh& mesh : frame.obstacles) copy.obstacles.push_back(mesh.vertices);
    return copy;
}

/// Calls on_step where there is one; true if the run is to stop. Looks for signals, which Python's own code cannot meanwhile.
bool reported(const py::object& on_step, const StepReport& report, const BuiltScene& built, std::atomic<bool>& cancel) {
    const TakenGil gil;
    cancel = false;  // earlier signals are reported now; those during on_step are its own
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (on_step.is_none()) return false;
    const auto view = std::make_shared<RunView>(RunView{&built});
    struct Ended {
        RunView& view;
        ~Ended() { view.built = nullptr; }
    } ended{*view};
    const bool stop = on_step(report, view).cast<py::object>().is(py::bool_(true));
    cancel = false;
    return stop;
}

std::size_t number_of(const std::vector<std::string>& names, const std::string& name, const char* what) {
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return i;
    throw SceneError(std::string("no ") + what + " '" + name + "'; valid: " + py::str(py::cast(names)).cast<std::string>());
}

template <class Specs>
std::vector<std::string> names_of(const Specs& specs) {
    std::vector<std::string> names;
    for (const auto& spec : specs) names.push_back(spec.name);
    return names;
}

/// Runs what is built; files where they are asked for.
class Recorder {
public:
    Recorder(BuiltScene& built, const RunWishes& wishes, std::atomic<bool>& cancel, SceneRun& run)
        : built_(built), wishes_(wishes), cancel_(cancel), run_(run) {
        if (!wishes.output.empty()) folder_.emplace(wishes.output, built.scene, true);
    }

    void record() {
        RunHooks hooks;
        hooks.begin = [&] {
            if (folder_) folder_->begin();
        };
        hooks.frame = [&](const Frame& frame) {
            if (folder_) folder_->add(frame);
            if (wishes_.keep_frames) run_.frames.push_back(kept(frame));
            records_.push_back({.index = frame.index,
                                .time = frame.time,
                                .cloths = {},
                                .obstacles = {},
                                .others = {},
                                .check = frame.check,
                                .meeting = frame.meeting});
        };
        hooks.step = [&](const StepReport& report, const Simulation& simulation) {
            if (folder_) folder_->add(report, simulation);
            stop_ = reported(wishes_.on_step, report, built_, cancel_) || stop_;
        };
        hooks.stop_asked = [&] { return stop_; };
        hooks.cancel = &cancel_;
        run_.result = run_scene(built_, hooks, {.certify_steps = wishes_.certify_steps});
        if (cancel_) throw SceneError("the run was interrupted");
        const std::vector<Expectation> expected =
            wishes_.certify_steps ? with_every_step(built_.scene.expectations) : built_.scene.expectations;
        run_.expectations = judge_run(expected, run_.result.measures, run_.result.timed, built_.scene);
        run_.report = run_report_text(built_, run_.result, records_, run_.expectations);
        if (folder_) folder_->finish(built_, run_.result, run_.expectations);
    }

private:
    BuiltScene& built_;
    const RunWishes& wishes_;
    std::atomic<bool>& cancel_;
    SceneRun& run_;
    std::optional<RunFolder> folder_;
    std::vector<FrameRecord> records_;
    bool stop_ = false;
};

void bind_scene(py::module_& module) {
    py::class_<Scene>(module, "Scene", "A scene file, checked: what cloth, on what bodies, for how long, what is expected.")
        .def_readonly("file", &Scene::file, "As given; \"scene\" for a dict.")
        .def_readonly("title", &Scene::title)
        .def_property_readonly(
            "duration", [](const Scene& scene) { return scene.latest_end(); }, "s, when it ends at the latest.")
        .def_property_readonly(
            "settings", [](const Scene& scene) { return parsed_json(settings_text(scene)); },
            "Every value that a run uses, defaults included, laid out like a scene file: a dict.")
        .def("__repr__", [](const Scene& scene) { return "<percale.Scene: " + scene.file + ">"; });
    module.def(
        "load_scene", &scene_from, py::arg("scene"), py::arg("overrides") = py::none(),
        "A scene from a file, or from a dict laid out like one, checked as files are. overrides: dotted keys and values, as\n"
        "--set of the program: {\"step.time_step\": 0.01, \"cloth.towel.pin\": [0]}. Throws SceneError with file, line, column.");
    module.def(
        "plan",
        [](py::handle source, py::handle overrides) {
            const Scene scene = scene_from(source, overrides);
            std::atomic<bool> cancel = false;
            return parsed_json(interruptible(cancel, [&] {
                const ReleasedGil others_run;
                return plan_json(build_scene(scene, &cancel));
            }));
        },
        py::arg("scene"), py::arg("overrides") = py::none(), "What a run of a scene would do and cost: a dict; runs nothing.");
}

void bind_view(py::module_& module) {
    py::class_<RunView, std::shared_ptr<RunView>>(module, "RunView", "What on_step sees of a run; good during the call alone.")
        .def_property_readonly(
            "time", [](const RunView& view) { return view.now().simulation.time(); }, "s.")
        .def(
            "positions",
            [](const RunView& view, const std::string& cloth) {
                const BuiltScene& built = view.now();
                return array_of(
                    built.simulation.positions(built.cloths[number_of(names_of(built.scene.cloths), cloth, "cloth")]));
            },
            py::arg("cloth"), "(n, 3), m, of the cloth of that name; a copy.")
        .def(
            "velocities",
            [](const RunView& view, const std::string& cloth) {
                const BuiltScene& built = view.now();
                return array_of(
                    built.simulation.velocities(built.cloths[number_of(names_of(built.scene.cloths), cloth, "cloth")]));
            },
            py::arg("cloth"), "(n, 3), m/s, likewise.")
        .def(
            "force_on",
            [](const RunView& view, const std::string& obstacle) {
                const BuiltScene& built = view.now();
                const std::size_t number = number_of(names_of(built.scene.obstacles), obstacle, "obstacle");
                return array_of(built.simulation.force_on(built.obstacles[number]));
            },
            py::arg("obstacle"), "N, shape (3,), of all cloth on the obstacle of that name.")
        .def(
            "state_hash", [](const RunView& view) { return view.now().simulation.state_hash(); }, "As of Simulation.");
}

py::dict by_name(const std::vector<std::string>& names, const std::vector<std::vector<Vec3>>& meshes) {
    py::dict dict;
    for (std::size_t i = 0; i < names.size(); ++i) dict[py::str(names[i])] = array_of(meshes[i]);
    return dict;
}

py::list frame_list(const SceneRun& run) {
    py::list list;
    for (const KeptFrame& frame : run.frames) {
        py::dict entry;
        entry["index"] = frame.index;
        entry["time"] = frame.time;
        entry["cloths"] = by_name(run.cloth_names, frame.cloths);
        entry["obstacles"] = by_name(run.obstacle_names, frame.obstacles);
        entry["intersections"] = frame.check.intersections;
        entry["deepest_penetration"] = frame.check.deepest_penetration;
        entry["smallest_distance"] = frame.check.smallest_distance;
        list.append(entry);
    }
    return list;
}

py::list expectation_list(const SceneRun& run) {
    py::list list;
    for (const ExpectationResult& result : run.expectations) {
        py::dict entry;
        entry["measure"] = result.expectation.measure;
        entry["value"] = result.value ? py::object(py::float_(*result.value)) : py::none();
        entry["limit"] = limit_text(result.expectation);
        entry["passed"] = result.passed;
        if (result.expectation.at) entry["at"] = *result.expectation.at;
        if (result.expectation.during) entry["during"] = *result.expectation.during;
        entry["text"] = result.text;
        list.append(entry);
    }
    return list;
}

/// Warns on standard error unless the host's warning filter says otherwise: nobody has to read `status` to hear of it.
void warn_of(const SceneRun& run, const std::string& scene) {
    const scenes::RunVerdict verdict = scenes::verdict_of_run(run.result);
    if (verdict.word != "crossed" && verdict.word != "unsolved") return;
    if (PyErr_WarnEx(PyExc_RuntimeWarning, (scene + ": " + verdict.word + ": " + verdict.reason).c_str(), 1) != 0)
        throw py::error_already_set();
}

void bind_run(py::module_& module) {
    py::class_<SceneRun, std::shared_ptr<SceneRun>>(module, "RunResult", "What became of a run of a scene.")
        .def_property_readonly(
            "status", [](const SceneRun& run) { return scenes::verdict_of_run(run.result).word; },
            "finished, failed, stopped, crossed (something crosses in a frame) or unsolved (a step was taken unsolved).")
        .def_property_readonly(
            "reason", [](const SceneRun& run) { return scenes::verdict_of_run(run.result).reason; },
            "What was not well; empty where it finished.")
        .def_property_readonly("passed", &SceneRun::passed, "It finished, and every expectation was met.")
        .def_property_readonly(
            "measures", [](const SceneRun& run) { return measure_values(run.result.measures); },
            "By the names of [expect]; without what was not measured.")
        .def_property_readonly("expectations", &expectation_list, "A dict each: measure, value, limit, passed, text.")
        .def_property_readonly(
            "report", [](const SceneRun& run) { return parsed_json(run.report); }, "report.json as a dict; frames without files.")
        .def_property_readonly(
            "frames", &frame_list,
            "With frames = True: a dict each: index, time (s), cloths and obstacles ((n, 3) arrays by name, m, world),\n"
            "intersections, deepest_penetration, smallest_distance (m).")
        .def_readonly("warnings", &SceneRun::warnings, "What is not quite as the scene says, and what was repaired.")
        .def_property_readonly(
            "findings", [](const SceneRun& run) { return py::object(parsed_json(run.report)["findings"]); },
            "The same, a dict each: severity, kind, place, what, fix.")
        .def_readonly("state_hash", &SceneRun::state_hash, "Of the last state.")
        .def("__repr__", [](const SceneRun& run) {
            return "<percale.RunResult: " + scenes::verdict_of_run(run.result).word + ", " +
                   std::to_string(run.result.totals.steps) + " steps>";
        });
    module.def(
        "run",
        [](py::handle scene, const std::optional<std::filesystem::path>& output, const py::object& on_step, py::handle overrides,
           bool frames, bool certify_steps) {
            if (output && output->empty()) throw SceneError("output", "is empty; None writes nothing");
            if (!on_step.is_none() && !PyCallable_Check(on_step.ptr())) throw SceneError("on_step", "cannot be called");
            const Scene checked = scene_from(scene, overrides);
            const auto run = run_with(checked, {.output = output ? output->string() : "",
                                                .on_step = on_step,
                                                .keep_frames = frames,
                                                .certify_steps = certify_steps});
            warn_of(*run, checked.file);
            return run;
        },
        py::arg("scene"), py::arg("output") = py::none(), py::arg("on_step") = py::none(), py::arg("overrides") = py::none(),
        py::arg("frames") = false, py::arg("certify_steps") = false,
        "Runs a scene (Scene, path or dict) to its end; other threads run meanwhile. output: a folder for frames, report.json "
        "and\n"
        "steps.csv, whole or absent; None: nothing is written. on_step(report, view): called after every step with a StepReport\n"
        "and a RunView; True stops the run. frames: keep the output frames in the result. certify_steps: certify every state.\n"
        "A run that crossed or was unsolved is a RuntimeWarning, too.");
}

}  // namespace

bool SceneRun::passed() const {
    const auto is_passed = [](const ExpectationResult& expectation) { return expectation.passed; };
    return scenes::verdict_of_run(result).well() && std::ranges::all_of(expectations, is_passed);
}

const BuiltScene& RunView::now() const {
    if (built == nullptr)
        throw SceneError("this view of a run was good during its call of on_step alone; copy what is to be kept");
    return *built;
}

std::shared_ptr<SceneRun> run_with(const Scene& scene, const RunWishes& wishes) {
    auto run = std::make_shared<SceneRun>();
    std::atomic<bool> cancel = false;
    interruptible(cancel, [&] {
        const ReleasedGil others_run;
        BuiltScene built = build_scene(scene, &cancel);
        run->cloth_names = names_of(built.scene.cloths);
        run->obstacle_names = names_of(built.scene.obstacles);
        Recorder(built, wishes, cancel, *run).record();
        run->state_hash = built.simulation.state_hash();
        run->warnings = finding_texts(run_findings(built, run->result));
    });
    return run;
}

Scene scene_from(py::handle source, py::handle overrides) {
    const std::vector<Override> changes = overrides_of(overrides);
    if (py::isinstance<py::dict>(source)) return scene_of_document(node_of(source, name_of_dict), name_of_dict, changes);
    if (py::isinstance<Scene>(source)) {
        if (!changes.empty()) throw SceneError("overrides", "a scene was checked when it was loaded; give them to load_scene");
        return source.cast<Scene>();
    }
    if (!py::isinstance<py::str>(source) && !py::hasattr(source, "__fspath__"))
        throw SceneError("scene", "must be a percale.Scene, the path of a scene file or a dict, not " + described(source));
    return load_scene(source.cast<std::filesystem::path>().string(), changes);
}

void bind_scene_runs(py::module_& module) {
    bind_scene(module);
    bind_view(module);
    bind_run(module);
}

}  // namespace percale::python
