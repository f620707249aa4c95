#include "tests/support/collision/random_scenes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "data/generators/spikes.h"
#include "percale/error.h"
#include "scenes/meshes/mesh_import.h"
#include "scenes/run/obstacle_motion.h"
#include "tests/support/bench_meshes.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/real_meshes.h"

namespace percale::test {
namespace {

using scenes::Keyframe;
using scenes::ObstacleSpec;
using scenes::Spin;

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

/// Small body scans, those that are installed.
const std::vector<NamedMesh>& scans() {
    static const std::vector<NamedMesh> loaded = [] {
        std::vector<NamedMesh> meshes;
        for (const char* name : {"cactus.off", "hand.off", "knot1.off"}) {
            const std::filesystem::path file = real_mesh_folder() / name;
            if (std::filesystem::exists(file)) meshes.push_back({name, unit_size(scenes::import_mesh(file.string()))});
        }
        return meshes;
    }();
    return loaded;
}

TriangleMesh triangle(Random& random) {
    TriangleMesh mesh{.vertices = {}, .triangles = {{0, 1, 2}}};
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(random.point(0.25));
    return mesh;
}

/// A wavy sheet, open at its border.
TriangleMesh open_sheet(Random& random) {
    TriangleMesh mesh = make_grid(0.5, 0.5, 6, 6);
    for (Vec3& x : mesh.vertices) x.y() += random.number(-0.06, 0.06);
    return mesh;
}

/// A sheet folded back over itself once or twice, its layers millimetres apart, open.
TriangleMesh folded_sheet(Random& random) {
    TriangleMesh mesh = make_grid(0.9, 0.4, 13, 5);
    const double gap = random.decades(5e-4, 1e-2);
    for (Vec3& x : mesh.vertices) {
        const double along = x.x() + 0.45, fold = std::floor(along / 0.31);
        const double in_fold = along - 0.31 * fold;
        x = Vec3(std::fmod(fold, 2.0) == 0.0 ? in_fold : 0.31 - in_fold, gap * fold + gap * in_fold / 0.31, x.z());
    }
    return mesh;
}

/// m, of each of two that close to a millimetre.
constexpr double jaw_height = 0.05, jaws_apart = 0.001;

NamedMesh random_obstacle(Random& random) {
    const double size = random.number(0.08, 0.3), other = random.number(0.08, 0.3);
    const auto seed = static_cast<unsigned>(random.index(100000));
    switch (random.index(20)) {
        case 0:
            return {"sphere", make_sphere(size, 2)};
        case 1:
            return {"box", make_box({size, other, 0.2})};
        case 2:
            return {"capsule", make_capsule(0.5 * size, other, 12)};
        case 3:
            return {"cylinder", make_cylinder(0.7 * size, other, 12)};
        case 4:
            return {"plane", make_plane(2.0 * size)};
        case 5:
            return {"spikes", scenes::make_spikes({.width = 0.4, .count = 4, .height = 0.12, .base = 0.04})};
        case 6:
            return {"needle", scenes::make_spikes({.width = 0.02, .count = 1, .height = 0.4, .base = 0.01, .thickness = 0.005})};
        case 7:
            return {"triangle", triangle(random)};
        case 8:
            return {"open sheet", open_sheet(random)};
        case 9:
            return {"star", spiky_ball(size, 1, 0.5, static_cast<unsigned>(random.index(1000)))};
        case 10:
            return {"blade", make_box({2.0 * size, 0.002, 0.05})};
        case 11:
            return {"tangled ball", tangled_ball(size, 1 + random.index(2), random.number(0.05, 0.25), seed)};
        case 12:
            return {"pierced ball", pierced_ball(size, random)};
        case 13:
            return {"bent tube", bent_tube(random)};
        case 14:
            return {"touching boxes", touching_boxes(random)};
        case 15:
            return {"inside out", inside_out(spiky_ball(size, 1, 0.5, seed))};
        case 16:
            return {"doubled", joined(spiky_ball(size, 1, 0.4, seed), spiky_ball(size, 1, 0.4, seed))};
        case 17:
            return {"folded sheet", folded_sheet(random)};
        case 18:
            return {"jaws", make_box({0.4, jaw_height, 0.4})};
        default:
            // Without scans only these scenes differ.
            if (scans().empty()) return {"sphere", make_sphere(size, 3)};
            return scans()[static_cast<std::size_t>(random.index(static_cast<int>(scans().size())))];
    }
}

/// Moves it straight from where it is, at a speed in m/s, from t = 0 on.
void translate(ObstacleSpec& spec, const Vec3& velocity) {
    spec.motion = {Keyframe{.time = 0.0, .translation = spec.pose.translation, .rotation = {}},
                   Keyframe{.time = 10.0, .translation = spec.pose.translation + 10.0 * velocity, .rotation = {}}};
}

/// Gives the obstacle a motion, rather towards the cloth at the origin, and names it.
std::string set_random_motion(ObstacleSpec& spec, Random& random) {
    const Vec3 aim = (0.3 * random.unit() - spec.pose.translation).normalized(), axis = random.unit();
    const double speed = random.decades(0.1, 3.0), turns = random.decades(0.1, 5.0);
    switch (random.index(6)) {
        case 0:
            return "still";
        case 1:
            translate(spec, speed * aim);
            return "translating";
        case 2:
            spec.spin = Spin{axis, turns, 0.0};
            return "spinning";
        case 3:
            translate(spec, speed * aim);
            spec.spin = Spin{axis, turns, 0.0};
            return "both";
        case 4:
            translate(spec, 20.0 * speed * aim);
            return "fast";
        default:
            spec.spin = Spin{axis, 10.0 * turns, 0.0};
            return "fast spin";
    }
}

Fabric random_fabric(Random& random) {
    Fabric fabric;
    fabric.area_density = random.decades(0.02, 2.0);
    fabric.thickness = random.decades(0.002, 0.01);
    fabric.springs.structural = random.decades(10.0, 1e5);
    fabric.springs.shear = random.number(0.0, 0.5) * fabric.springs.structural;
    fabric.springs.bend = random.decades(1e-4, 1e-1) * fabric.springs.structural;
    fabric.spring_damping = random.decades(0.01, 1.0);
    return fabric;
}

NamedMesh random_cloth(Random& random) {
    const bool fine = random.index(8) == 0;
    const int columns = fine ? 30 : 3 + random.index(11), rows = fine ? 30 : 3 + random.index(11);
    const double width = random.number(0.2, 0.6), depth = random.number(0.2, 0.6);
    if (random.index(3) > 0) return {"grid", make_grid(width, depth, columns, rows)};
    return {"free mesh", irregular_sheet(width, random.index(2) == 0 ? 60 : 300)};
}

/// Pins nothing, a corner, or the vertices of one edge of the bounding box.
std::string pin_some(scenes::BuiltScene& built, Random& random) {
    const int kind = random.index(3);
    if (kind == 0) return "free";
    const std::vector<Vec3>& vertices = built.cloth_meshes[0].vertices;
    built.simulation.pin(built.cloths[0], 0);
    if (kind == 1) return "one pin";
    // The rest mesh before its pose lies in a plane; vertices are distinguished by their distance from the first edge's middle.
    const Vec3 first = vertices[0];
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        if ((vertices[i] - first).norm() < 0.1) built.simulation.pin(built.cloths[0], static_cast<int>(i));
    }
    return "a pinned corner";
}

/// Everything of a scene except the place of the obstacle.
struct Draw {
    NamedMesh cloth, obstacle;
    std::optional<TriangleMesh> other_cloth;  // of the same fabric
    Fabric fabric;
    StepSettings settings;
    scenes::Detector detector = scenes::Detector::fcl;
    ObstacleSpec spec;
    std::optional<ObstacleSpec> jaw;  // of the same mesh, closing on it
};

scenes::BuiltScene build(const Draw& draw) {
    scenes::BuiltScene built{.scene = {},
                             .simulation = Simulation(draw.settings, scenes::make_detector(draw.detector)),
                             .cloths = {},
                             .cloth_meshes = {draw.cloth.mesh},
                             .rest_shapes = {{}},
                             .obstacles = {},
                             .obstacle_meshes = {draw.obstacle.mesh},
                             .shapes = {nullptr},
                             .pattern_seams = {},
                             .seams = {},
                             .warnings = {}};
    built.scene.step = draw.settings;
    built.scene.detector = draw.detector;
    built.scene.fabrics["fabric"] = draw.fabric;
    built.scene.cloths.resize(1);
    built.scene.cloths[0].name = "cloth";
    built.scene.cloths[0].fabric = "fabric";
    built.scene.obstacles = {draw.spec};
    built.cloths = {built.simulation.add_cloth(draw.cloth.mesh, draw.fabric)};
    if (draw.other_cloth) {
        built.scene.cloths.push_back(built.scene.cloths[0]);
        built.scene.cloths.back().name = "other";
        built.cloths.push_back(built.simulation.add_cloth(*draw.other_cloth, draw.fabric));
        built.cloth_meshes.push_back(*draw.other_cloth);
        built.rest_shapes.emplace_back();
    }
    built.obstacles = {built.simulation.add_obstacle(draw.obstacle.mesh, scenes::obstacle_pose_at(draw.spec, 0.0),
                                                     {.friction = draw.spec.friction, .name = draw.obstacle.name})};
    if (draw.jaw) {
        built.scene.obstacles.push_back(*draw.jaw);
        built.obstacle_meshes.push_back(draw.obstacle.mesh);
        built.shapes.push_back(nullptr);
        built.obstacles.push_back(built.simulation.add_obstacle(draw.obstacle.mesh, scenes::obstacle_pose_at(*draw.jaw, 0.0),
                                                                {.friction = draw.jaw->friction, .name = "jaw"}));
    }
    built.simulation.prepare();
    return built;
}

Draw draw_scene(Random& random, int index) {
    Draw draw;
    draw.cloth = random_cloth(random);
    draw.obstacle = random_obstacle(random);
    draw.fabric = random_fabric(random);
    if (draw.cloth.name != "grid") draw.fabric.springs.shear = 0.0;
    draw.settings.time_step = 1.0 / random.decades(30.0, 240.0);
    const auto turn = static_cast<std::size_t>(index);
    draw.detector = random_detectors[turn % random_detectors.size()];
    draw.settings.contact_response = random_responses[turn / random_detectors.size() % random_responses.size()];
    draw.settings.measure = StepMeasures::none;
    draw.settings.start = StartRule::refuse;  // cloth is placed farther away, not untangled
    const TriangleMesh flat = draw.cloth.mesh;
    const Pose pose = random.pose(0.0);
    draw.cloth.mesh = placed(flat, pose);
    draw.spec.name = draw.obstacle.name;
    draw.spec.friction = random.index(4) == 0 ? 0.0 : random.number(0.05, 2.0);
    draw.fabric.self_contact = random.index(4) == 0;
    Random of_other = random;  // later draws are the same without it
    if (draw.fabric.self_contact && of_other.index(2) == 0)
        draw.other_cloth = placed(moved(flat, {0.0, draw.fabric.thickness * of_other.number(1.0, 8.0), 0.0}), pose);
    draw.settings.gravity = {0.0, -(random.index(3) == 0 ? random.number(0.0, 40.0) : 9.81), 0.0};
    // Projection supports only backward Euler with steps of one length.
    if (draw.settings.contact_response == ContactResponse::penalty) {
        if (random.index(3) == 0) draw.settings.scheme = Scheme::tr_bdf2;
        draw.settings.adaptive = random.index(6) == 0;
    }
    return draw;
}

/// Another obstacle above it, in its axes, that comes down on it within the scene.
ObstacleSpec closing_jaw(const ObstacleSpec& below, Random& random) {
    ObstacleSpec jaw = below;
    jaw.name = "jaw";
    const Vec3 up = transform({.rotation = below.pose.rotation}, Vec3::UnitY());
    const double gap = random.number(0.02, 0.2), time = random.number(0.05, 0.25);
    const auto at = [&](double apart) { return Vec3(below.pose.translation + (jaw_height + apart) * up); };
    jaw.pose.translation = at(gap);
    jaw.motion = {Keyframe{.time = 0.0, .translation = at(gap), .rotation = below.pose.rotation},
                  Keyframe{.time = time, .translation = at(jaws_apart), .rotation = below.pose.rotation}};
    return jaw;
}

/// Places the obstacle as near as it may start, at a random place around the cloth.
scenes::BuiltScene build_clear(Draw& draw, std::string& motion, Random& random) {
    for (double reach = 0.05;; reach += 0.02) {
        const Vec3 way = random.unit();
        draw.spec.pose = {.translation = reach * way, .rotation = random.rotation(), .scale = 1.0};
        draw.spec.motion.clear();
        draw.spec.spin.reset();
        motion = draw.obstacle.name == "jaws" ? "closing" : set_random_motion(draw.spec, random);
        if (draw.obstacle.name == "jaws") draw.jaw = closing_jaw(draw.spec, random);
        try {
            return build(draw);
        } catch (const StartError&) {
            if (reach > 10.0) throw;
        }
    }
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string describe(const Draw& draw, const RandomScene& scene, const std::string& pins) {
    const std::string_view detector = scenes::word_of(draw.detector);
    return scene.obstacle + " " + scene.motion + ", " + scene.cloth + " of " + std::to_string(draw.cloth.mesh.vertices.size()) +
           " vertices, " + pins + ", " + number(draw.fabric.area_density) + " kg/m2, " + number(draw.fabric.springs.structural) +
           " N/m, thickness " + number(1e3 * draw.fabric.thickness) + " mm, mu " + number(draw.spec.friction) + ", dt 1/" +
           number(1.0 / draw.settings.time_step) + " s, g " + number(-draw.settings.gravity.y()) +
           (draw.settings.scheme == Scheme::tr_bdf2 ? ", tr_bdf2" : "") + (draw.settings.adaptive ? ", adaptive" : "") +
           (draw.settings.contact_response == ContactResponse::projection ? ", projection, " : ", penalty, ") +
           (draw.fabric.self_contact ? "self-contact, " : "") + (draw.other_cloth ? "two cloths, " : "") + std::string(detector);
}

bool all_finite(const Simulation& simulation, ClothId cloth) {
    const auto finite = [](const Vec3& x) { return x.allFinite(); };
    const auto positions = simulation.positions(cloth), velocities = simulation.velocities(cloth);
    return std::all_of(positions.begin(), positions.end(), finite) && std::all_of(velocities.begin(), velocities.end(), finite);
}

}  // namespace

RandomScene make_random_scene(unsigned seed, int index) {
    Random random(seed + 7919u * static_cast<unsigned>(index));
    Draw draw = draw_scene(random, index);
    std::string motion;
    RandomScene scene{.obstacle = draw.obstacle.name,
                      .motion = {},
                      .cloth = draw.cloth.name,
                      .pinned = false,
                      .description = {},
                      .built = build_clear(draw, motion, random)};
    scene.motion = motion;
    const std::string pins = pin_some(scene.built, random);
    scene.pinned = pins != "free";
    const Vec3 towards = draw.spec.pose.translation.normalized();
    const double speed = random.number(0.0, 3.0);
    scene.built.simulation.set_velocities(scene.built.cloths[0],
                                          std::vector<Vec3>(draw.cloth.mesh.vertices.size(), speed * towards));
    scene.built.scene.duration = 0.25;
    scene.built.scene.output.fps = 10.0;
    scene.description = describe(draw, scene, pins);
    return scene;
}

RandomOutcome run_random_scene(RandomScene& scene, const SecondChecker& second) {
    RandomOutcome outcome;
    scenes::RunHooks hooks;
    hooks.step = [&](const StepReport& report, const Simulation& simulation) {
        outcome.last = report.status;
        for (const ClothId cloth : scene.built.cloths) outcome.not_finite += all_finite(simulation, cloth) ? 0 : 1;
    };
    if (second) {
        hooks.frame = [&](const scenes::Frame& frame) {
            outcome.second_crossings += second(frame);
            ++outcome.second_frames;
        };
    }
    outcome.result = scenes::run_scene(scene.built, hooks, {.certify_steps = true});
    outcome.crossings = outcome.result.measures.steps->intersections;
    outcome.deepest = outcome.result.measures.steps->deepest_penetration;
    return outcome;
}

}  // namespace percale::test
