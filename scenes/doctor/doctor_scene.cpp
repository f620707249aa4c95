#include "doctor/doctor_scene.h"

#include <algorithm>
#include <cmath>

#include "bodies/body_shapes.h"
#include "common/scene_file_error.h"
#include "common/text.h"
#include "doctor/doctor_mesh.h"
#include "doctor/doctor_vertices.h"
#include "format/scene_file.h"
#include "frames/frame_formats.h"
#include "garment/cloth_shape.h"
#include "measures/references.h"
#include "percale/error.h"
#include "run/motion_parts.h"
#include "run/obstacle_motion.h"
#include "run/run_scene.h"
#include "run/scene_plan.h"
#include "run/start_fault.h"
#include "run/step_lengths.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

// From where on doctor warns. Smaller or larger: warnings of what is right, or none of what is wrong.

/// Parts of a step from which a fast obstacle is a warning.
constexpr double dear_motion_parts = 100.0;

/// Shapes of a body that doctor looks at. More: it takes minutes.
constexpr int max_shapes_looked_at = 20000;

/// s, between two that doctor looks at. Less: as above.
constexpr double min_time_between_shapes = 1e-4;

/// Thicknesses that a vertex of a body that bends goes in a step that is made whole, as the engine has it.
constexpr double bending_part_travel = 20.0;

/// Parts of a step from which a body that bends likely has a frame that jumps.
constexpr double bending_jump_parts = 8.0;

/// Fraction of the longest stable step that is advised.
constexpr double advised_stable_ratio = 0.8;

/// s, bytes, bytes: what a long run, much memory and much output are.
constexpr double much_time = 3600.0, much_memory = 8e9, much_disk = 1e10;

constexpr const char* see_keys = "correct it there; `percale explain` lists every key with unit, range and default";

bool has_errors(std::span<const Finding> found) { return count_of(found, Severity::error) > 0; }

/// The meshes of a scene that can be read, each with its number there.
struct Meshes {
    std::vector<ExaminedMesh> cloths, obstacles;
    std::vector<const ClothSpec*> cloth_specs;
    std::vector<const ObstacleSpec*> obstacle_specs;

    std::vector<ClothMesh> cloths_with_specs() const {
        std::vector<ClothMesh> list;
        for (std::size_t i = 0; i < cloths.size(); ++i) list.push_back({cloth_specs[i], &cloths[i].mesh});
        return list;
    }
};

std::string fix_of_mesh(const ClothSpec&) { return "name a mesh file that `percale doctor FILE` finds readable"; }
std::string fix_of_mesh(const ObstacleSpec& obstacle) {
    const bool bends = obstacle.bends() || obstacle.loop || obstacle.fps || obstacle.lead_in > 0.0;
    return bends ? "correct it there; `percale explain obstacle` lists what bodies that bend take"
                 : "name a mesh file that `percale doctor FILE` finds readable";
}

template <class Spec, class Read>
std::optional<ExaminedMesh> read_mesh(const Spec& spec, MeshRole role, std::vector<Finding>& found, Read read) {
    ExaminedMesh mesh{.role = role,
                      .name = std::string(role_word(role)) + " '" + spec.name + "'",
                      .place = place_text(spec.place),
                      .from_file = !spec.mesh.empty()};
    try {
        mesh.mesh = read();
        check_mesh(mesh.mesh, mesh.name, false);
    } catch (const SceneError& error) {
        found.push_back(finding("unreadable", spec.place, mesh.name + ": " + error.what(), fix_of_mesh(spec), Severity::error));
        found.back().role = role;
        return std::nullopt;
    }
    mesh.facts = facts_as(role, mesh.mesh);
    return mesh;
}

/// Whether a seam sews the cloth to itself, or it is a pattern, which is sewn.
bool is_sewn_to_itself(const Scene& scene, const ClothSpec& cloth) {
    const auto joins = [&](const SeamSpec& seam) {
        return !seam.cloths || ((*seam.cloths)[0] == cloth.name && (*seam.cloths)[1] == cloth.name);
    };
    return !cloth.pattern.empty() || std::ranges::any_of(scene.seams, joins);
}

Meshes read_meshes(const Scene& scene, std::vector<Finding>& found) {
    Meshes meshes;
    for (const ClothSpec& cloth : scene.cloths) {
        auto mesh = read_mesh(cloth, MeshRole::cloth, found, [&] { return start_mesh(scene, cloth); });
        if (!mesh) continue;
        mesh->sewn = is_sewn_to_itself(scene, cloth);
        mesh->filled = scene.is_filled(cloth);
        mesh->scale = cloth.pose.scale;
        meshes.cloths.push_back(std::move(*mesh));
        meshes.cloth_specs.push_back(&cloth);
    }
    for (const ObstacleSpec& obstacle : scene.obstacles) {
        auto mesh = read_mesh(obstacle, MeshRole::obstacle, found, [&] {
            TriangleMesh placed = obstacle_mesh(scene, obstacle);
            placed.vertices = transform(obstacle_pose_at(obstacle, 0.0), std::span<const Vec3>(placed.vertices));
            return placed;
        });
        if (!mesh) continue;
        mesh->scale = obstacle.pose.scale;
        meshes.obstacles.push_back(std::move(*mesh));
        meshes.obstacle_specs.push_back(&obstacle);
    }
    return meshes;
}

void examine_meshes(const Scene& scene, const Meshes& meshes, std::vector<Finding>& found) {
    for (std::size_t i = 0; i < meshes.cloths.size(); ++i) {
        const auto fabric = scene.fabrics.find(meshes.cloth_specs[i]->fabric);
        append_findings(examine_cloth(meshes.cloths[i], fabric == scene.fabrics.end() ? Fabric{} : fabric->second), found);
    }
    for (const ExaminedMesh& obstacle : meshes.obstacles) append_findings(examine_obstacle(obstacle), found);
    for (const ExaminedMesh& cloth : meshes.cloths) {
        for (std::size_t k = 0; k < meshes.obstacles.size(); ++k) {
            const bool plane = std::holds_alternative<PlaneShape>(meshes.obstacle_specs[k]->shape);
            if (!plane) append_findings(examine_pair(cloth, meshes.obstacles[k]), found);
        }
    }
}

void find_unused_fabrics(const Scene& scene, std::vector<Finding>& found) {
    for (const auto& [name, fabric] : scene.fabrics) {
        if (std::ranges::find(scene.cloths, name, &ClothSpec::fabric) != scene.cloths.end()) continue;
        found.push_back(finding("unused_fabric", {scene.file}, "no cloth is made of fabric '" + name + "'",
                                "remove [fabric." + name + "], or say fabric = \"" + name + "\" at a cloth", Severity::note));
    }
}

bool pulls(const Scene& scene) {
    return scene.step.gravity != Vec3::Zero() ||
           std::any_of(scene.events.begin(), scene.events.end(), [](const EventSpec& event) {
               const auto* gravity = std::get_if<GravityEvent>(&event.what);
               return gravity != nullptr && gravity->gravity != Vec3::Zero();
           });
}

void find_free_fall(const Scene& scene, std::vector<Finding>& found) {
    const bool pinned = std::any_of(scene.events.begin(), scene.events.end(),
                                    [](const EventSpec& event) { return std::holds_alternative<PinEvent>(event.what); });
    if (!scene.obstacles.empty() || !scene.seams.empty() || pinned || !pulls(scene)) return;
    for (const ClothSpec& cloth : scene.cloths) {
        if (has_pins(cloth)) continue;
        found.push_back(finding("free_fall", cloth.place,
                                "cloth '" + cloth.name + "' has no pin and the scene no obstacle: it falls for ever",
                                "pin vertices (pin = [0]), add an [[obstacle]], or set gravity = [0, 0, 0]",
                                scene.until_rest ? Severity::error : Severity::warning));
    }
}

/// The air that blows at the end of a scene that ends at rest may keep cloth fluttering.
void find_flutter(const Scene& scene, std::vector<Finding>& found) {
    const EventSpec* last = nullptr;
    for (const EventSpec& event : scene.events)
        if (std::holds_alternative<WindEvent>(event.what)) last = &event;
    if (!scene.until_rest || last == nullptr || std::get<WindEvent>(last->what).wind == Vec3::Zero()) return;
    found.push_back(
        finding("flutter", last->place,
                "duration is \"rest\" and this wind never ends: cloth that flutters is not at rest within max_duration = " +
                    short_number(scene.max_duration) + " s, and the run fails",
                "end it by an event with wind = [0, 0, 0], or say a duration in s"));
}

/// Why a measure of [expect] says nothing in this scene, and what does; two empty texts where it does.
std::pair<std::string, std::string> idle_measure(const Scene& scene, const Meshes& meshes, const std::string& measure) {
    const auto closed = [](const ExaminedMesh& obstacle) { return mesh_facts(joined_by_place(obstacle.mesh).mesh).watertight(); };
    const bool contact = measure == "intersections" || measure == "smallest_distance";
    if (contact && !scene.has_contact())
        return {"nothing can meet: there is no obstacle and no fabric with self_contact", "add an [[obstacle]] or remove it"};
    const bool inside = std::any_of(meshes.obstacles.begin(), meshes.obstacles.end(), closed);
    if (measure == "deepest_penetration" && !inside)
        return {
            "no obstacle is watertight, so it is 0 whatever happens",
            "expect intersections = 0 instead, or close the mesh (`percale doctor FILE --as obstacle` says where it is open)"};
    const bool of_steps = measure == "largest_strain" || measure == "energy_gain";
    if (of_steps && scene.step.measure == StepMeasures::none)
        return {"steps measure nothing, so it is not known and fails", "set step.measure = \"all\""};
    return {};
}

void find_idle_expectations(const Scene& scene, const Meshes& meshes, std::vector<Finding>& found) {
    for (const Expectation& expectation : scene.expectations) {
        const auto [why, fix] = idle_measure(scene, meshes, expectation.measure);
        if (why.empty()) continue;
        found.push_back(finding("idle_expectation", expectation.place,
                                "expect." + expectation.measure + " can never be measured: " + why, fix));
    }
}

double min_thickness(const Scene& scene) {
    double thickness = 1.0;
    for (const ClothSpec& cloth : scene.cloths) {
        const auto fabric = scene.fabrics.find(cloth.fabric);
        if (fabric != scene.fabrics.end()) thickness = std::min(thickness, fabric->second.thickness);
    }
    return thickness;
}

/// Largest number of parts that a step asks for: turns of 15 degrees, or four thicknesses of still cloth.
double max_parts(const Scene& scene, const ObstacleSpec& obstacle) {
    const double thickness = min_thickness(scene);
    const double dt = scene.step.time_step;
    std::vector<double> starts = {0.0, obstacle.spin ? obstacle.spin->from : 0.0};
    for (std::size_t i = 1; i < obstacle.motion.size(); ++i)
        starts.push_back(
            std::max(obstacle.motion[i - 1].time, 0.5 * (obstacle.motion[i - 1].time + obstacle.motion[i].time - dt)));
    double parts = 1.0;
    for (const double start : starts) {
        if (start >= scene.latest_end()) continue;
        const MotionAmount amount = motion_between(obstacle, start, start + dt);
        parts = std::max({parts, amount.angle / largest_part_turn, amount.path / (largest_part_displacement * thickness)});
    }
    return std::ceil(parts - part_rounding);
}

void find_fast_motion(const Scene& scene, std::vector<Finding>& found) {
    for (const ObstacleSpec& obstacle : scene.obstacles) {
        const double parts = max_parts(scene, obstacle);
        if (parts <= 1.0) continue;
        found.push_back(finding("fast_obstacle", obstacle.place,
                                "obstacle '" + obstacle.name + "' moves so fast that near cloth a step is made in up to " +
                                    short_number(parts) + " parts",
                                "slow its motion or spin down, or take step.time_step = " +
                                    short_number(scene.step.time_step / parts) + " where every step is to be one",
                                parts > dear_motion_parts ? Severity::warning : Severity::note));
    }
}

/// The largest displacement of a vertex of a body in a step, m, and its time.
struct FastestShape {
    double displacement = 0.0, time = 0.0;
};

/// Looks at every shape once, from where it begins to move.
FastestShape fastest_shape(BodyShapes& shapes, const ObstacleSpec& obstacle, double end, double dt) {
    FastestShape fastest;
    const double interval = std::max(std::min(shapes.frame_time(), dt), min_time_between_shapes), from = obstacle.play_from;
    const double last = std::min({end, shapes.once(), from + max_shapes_looked_at * interval});
    std::vector<Vec3> before = shapes.at(from);
    for (int k = 1; from + (k - 1) * interval < last; ++k) {
        std::vector<Vec3> now = shapes.at(from + k * interval);
        const double displacement = largest_displacement(before, now) * dt / interval;
        if (displacement > fastest.displacement) fastest = {displacement, from + k * interval};
        before = std::move(now);
    }
    return fastest;
}

/// Finds frames that cannot be read, and frames in which a vertex moves far in a step.
void examine_shapes(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>& found) {
    try {
        BodyShapes shapes(scene, obstacle);
        const FastestShape fastest = fastest_shape(shapes, obstacle, scene.latest_end(), scene.step.time_step);
        const double parts = obstacle.pose.scale * fastest.displacement / (bending_part_travel * min_thickness(scene));
        if (parts <= 1.0) return;
        found.push_back(finding("fast_obstacle", obstacle.place,
                                "obstacle '" + obstacle.name + "' bends so fast that near cloth a step is made in up to " +
                                    short_number(std::ceil(parts)) + " parts: a vertex goes " +
                                    short_number(obstacle.pose.scale * fastest.displacement) + " m in a step at " +
                                    short_number(fastest.time) + " s",
                                "play it slower, or mend the frame if it jumps there: bodies that bend are not teleported",
                                parts > bending_jump_parts ? Severity::warning : Severity::note));
    } catch (const SceneError& error) {
        found.push_back(finding("bad_frame", obstacle.place, "obstacle '" + obstacle.name + "': " + error.what(),
                                "mend that frame, or end before it", Severity::error));
    }
}

void find_bad_shapes(const Scene& scene, std::vector<Finding>& found) {
    if (has_errors(found)) return;  // its mesh may be what is wrong
    for (const ObstacleSpec& obstacle : scene.obstacles) {
        if (obstacle.bends()) examine_shapes(scene, obstacle, found);
    }
}

/// Adds the warnings of the plan. Cloth that will fly apart is an error, whose fix names a step.
void find_plan_warnings(const BuiltScene& built, const ScenePlan& plan, std::vector<Finding>& found) {
    for (Finding& finding : plan_findings(built, plan)) {
        if (std::ranges::find(found, finding.what, &Finding::what) != found.end()) continue;  // swapped meshes
        if (finding.kind == "unstable_step") {
            finding.severity = Severity::error;
            finding.fix = "set step.time_step = " + short_number(advised_stable_ratio * plan.stable_step) +
                          " or below, or step.scheme = \"backward_euler\"";
        }
        found.push_back(std::move(finding));
    }
}

/// Finds pins in the world that a body will leave behind; what events do to pins is taken as intended.
void find_left_pins(const BuiltScene& built, std::vector<Finding>& found) {
    const Scene& scene = built.scene;
    for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
        if (!has_pins_in_world(scene.cloths[i]) || scene.pins_have_events(scene.cloths[i])) continue;
        const double size = mesh_facts(built.cloth_meshes[i]).extent();
        for (const ObstacleSpec& obstacle : scene.obstacles) {
            const double displacement =
                (obstacle_pose_at(obstacle, scene.latest_end()).translation - obstacle_pose_at(obstacle, 0.0).translation).norm();
            if (displacement < size) continue;
            found.push_back(finding("pins_stay", scene.cloths[i].pin_place,
                                    "the pins of cloth '" + scene.cloths[i].name + "' stay in the world, and obstacle '" +
                                        obstacle.name + "' goes " + short_number(displacement) + " m away",
                                    "pin = { box = ..., to = \"" + obstacle.name + "\" } if they belong to it", Severity::note));
        }
    }
}

std::string duration_text(double seconds) {
    return seconds < 2.0 * 86400.0 ? short_number(seconds / 3600.0) + " hours" : short_number(seconds / 86400.0) + " days";
}

void examine_built(const Scene& scene, std::vector<Finding>& found) {
    const BuiltScene built = build_scene(scene);
    std::size_t vertices = 0;
    for (const TriangleMesh& mesh : built.cloth_meshes) vertices += mesh.vertices.size();
    read_references(built.scene, vertices);
    const ScenePlan plan = plan_of(built);
    find_plan_warnings(built, plan, found);
    append_findings(start_findings(built), found);
    find_left_pins(built, found);
    append_findings(examine_cost(built, plan), found);
}

void try_to_build(const Scene& scene, std::vector<Finding>& found) {
    try {
        examine_built(scene, found);
    } catch (const StartRefused& error) {
        found.push_back(
            refusal("start", error, scene.file,
                    "move what is named apart by pose.translation, or in the mesh; `percale run` leaves the triangles "
                    "concerned in OUTPUT_start.obj"));
    } catch (const SceneError& error) {
        found.push_back(refusal("refused", error, scene.file, see_keys));
    }
}

Finding not_looked_at(const std::string& file, const std::string& parts) {
    return finding("not_built", {file}, parts + " were not looked at, because of the errors",
                   "mend these and run `percale doctor` once more", Severity::note);
}

std::vector<Finding> examine_scene(const Scene& scene) {
    std::vector<Finding> found;
    const Meshes meshes = read_meshes(scene, found);
    examine_meshes(scene, meshes, found);
    append_findings(missing_vertices(scene, meshes.cloths_with_specs()), found);
    find_unused_fabrics(scene, found);
    find_free_fall(scene, found);
    find_flutter(scene, found);
    find_idle_expectations(scene, meshes, found);
    find_fast_motion(scene, found);
    find_bad_shapes(scene, found);
    if (!has_errors(found)) {
        try_to_build(scene, found);
    } else {
        found.push_back(not_looked_at(scene.file, "what events say together, start, scheme and cost"));
    }
    return found;
}

}  // namespace

std::vector<Finding> examine_scene_meshes(const Scene& scene) {
    std::vector<Finding> found;
    examine_meshes(scene, read_meshes(scene, found), found);
    return found;
}

std::vector<Finding> examine_cost(const BuiltScene& built, const ScenePlan& plan) {
    std::vector<Finding> found;
    constexpr double seconds_a_spring = 5e-9;
    const Scene& scene = built.scene;
    const auto warn = [&](const std::string& kind, const std::string& what, const std::string& fix) {
        found.push_back(finding(kind, {scene.file}, what, fix));
    };
    const double steps = static_cast<double>(count_steps(scene.latest_end(), scene.step.time_step).steps);
    const double springs = plan.springs.total() + plan.springs.triangle;
    const double seconds = steps * plan.evaluations_a_step * springs * seconds_a_spring;
    if (seconds > much_time)
        warn("long_run", short_number(steps) + " steps will take about " + duration_text(seconds) + ", without contact",
             (scene.until_rest ? "lower max_duration" : "shorten duration") +
                 std::string(", take a larger step.time_step, or fewer vertices"));
    if (plan.memory_bytes > much_memory)
        warn("much_memory", "it will take about " + short_number(1e-9 * plan.memory_bytes) + " GB of memory",
             "take fewer vertices (grid.vertices) or simpler obstacle meshes");
    const double disk = output_size_of(built).bytes;
    if (disk > much_disk)
        warn("much_output", "its frames will take about " + short_number(1e-9 * disk) + " GB on disk",
             "lower output.fps, or set output.frames = \"none\"");
    return found;
}

std::vector<Finding> examine_scene_file(const std::string& file, std::span<const Override> overrides) {
    std::vector<Finding> found;
    for (const SceneFileError& fault : scene_faults(file, overrides)) {
        if (fault.place().file != file) throw fault;  // an override, which is not the file's fault
        found.push_back(refusal("refused", fault, file, see_keys));
    }
    if (found.empty()) return examine_scene(load_scene(file, overrides));
    found.push_back(not_looked_at(file, "what tables say together, names, meshes, start, scheme and cost"));
    return found;
}

}  // namespace percale::scenes
