#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

#include "common/nearest_name.h"
#include "common/text.h"
#include "common/whole_file.h"
#include "meshes/mesh_import.h"
#include "meshes/obj_file.h"
#include "percale/certify.h"
#include "percale/error.h"
#include "percale/fabric_presets.h"
#include "program/commands.h"
#include "program/exit_codes.h"
#include "program/progress_bar.h"
#include "program/stop_signals.h"
#include "run/frame_fields.h"
#include "run/measures.h"
#include "run/scene_build.h"
#include "run/start_fault.h"
#include "tolerances.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct DrapeOptions {
    std::vector<std::string> files;  // garments from the inside out, then the body
    std::vector<std::string> outs;   // one a garment
    std::string garment_unit = "m", body_unit = "m";
    std::array<double, 3> move = {0.0, 0.0, 0.0};  // m
    // A felt with enough bending springs and damping that free hems come to rest within the limit.
    Fabric fabric{.springs = {.structural = 1000.0, .bend = 5.0}, .spring_damping = 2.0};
    std::string preset;  // "" for the felt
    double friction = 0.4;
    double seconds = 20.0;      // s, limit
    double still = 2e-4;        // m/s, what rest is
    double edge_length = 0.02;  // m, of a pattern's mesh
    bool until_rest = true;     // there is nothing else
    bool no_self_contact = false;
    bool quiet = false;
    bool damps_patterns = false;  // a preset whose damping nothing else is said of

    std::span<const std::string> garments() const { return std::span(files).first(files.size() - 1); }
    const std::string& body() const { return files.back(); }
};

enum class DrapeEnd { settled, time_up, failed, stopped };

struct Drape {
    DrapeEnd end = DrapeEnd::time_up;
    StepReport last;
    std::string failure = {};
    double speed = 0.0;  // m/s, of the fastest vertex
    bool met = false;    // whether the garment ever had contact with the body
};

/// How a pattern is sewn, and from when on it has weight.
constexpr double sewing_time = 0.6;          // s
constexpr double sewing_stiffness = 3000.0;  // N/m
/// Of a preset, so that hems come to rest within seconds.
constexpr double sewing_damping = 0.02;  // s
/// A preset's moduli hold on patterns; on meshes that do not say where warp is they are made isotropic, which is warned of.
constexpr const char *mesh_fabric = "mesh", *pattern_fabric = "pattern";

bool is_pattern(const std::string& garment) {
    const std::string extension = extension_of(garment);
    return extension == ".toml" || extension == ".json";
}

double metres(const std::string& option, const std::string& unit) {
    if (unit == "m") return 1.0;
    if (unit == "cm") return 0.01;
    if (unit == "mm") return 0.001;
    throw SceneError(option + " " + unit + ": must be mm, cm or m");
}

void check_options(const DrapeOptions& options) {
    if (!(options.seconds > 0.0 && options.seconds <= 3600.0))
        throw SceneError("--seconds: is outside the allowed range 0 ... 3600 s (0 excluded)");
    if (!(options.still >= 1e-9 && options.still <= 1.0))
        throw SceneError("--still: is outside the allowed range 1e-9 ... 1 m/s");
    if (options.outs.size() != options.garments().size())
        throw SceneError("-o: " + std::to_string(options.garments().size()) + " garments and a body are given, but " +
                         std::to_string(options.outs.size()) + " files to write; it takes one for each garment");
    for (const std::string& out : options.outs) {
        if (std::filesystem::path(out).extension() != ".obj")
            throw SceneError("-o " + out + ": its name must end in .obj, which is what is written");
        const auto same = [&](const std::string& other) {
            return std::filesystem::path(other).lexically_normal() == std::filesystem::path(out).lexically_normal();
        };
        if (std::ranges::count_if(options.outs, same) > 1) throw SceneError("-o " + out + ": is said twice");
        const WholeFile probe(out);  // an output that cannot be written is found before the work, not after it
    }
}

/// The pattern of a garment is sewn when those of the garments below it are.
void add_pattern(const DrapeOptions& options, ClothSpec& cloth, Scene& scene) {
    if (cloth.unit != 1.0) throw SceneError("--garment-unit: a pattern says its own unit");
    cloth.pattern = cloth.place.file;
    cloth.edge_length = options.edge_length;
    cloth.panel_offset = layer_offset * static_cast<double>(scene.seams.size());
    scene.step.gravity = Vec3::Zero();
    SeamSpec seam;
    seam.cloths = {cloth.name, cloth.name};
    seam.file = "mesh";
    seam.from = sewing_time * static_cast<double>(scene.seams.size());
    seam.over = sewing_time;
    seam.stiffness = sewing_stiffness;
    seam.contact_while_closing = false;
    seam.place = cloth.place;
    scene.seams.push_back(seam);
}

/// Its file's name, with a number where another garment has it.
std::string garment_name(const std::string& file, const Scene& scene) {
    const std::string stem = std::filesystem::path(file).stem().string();
    const auto known = [&](const std::string& name) {
        return std::ranges::any_of(scene.cloths, [&](const ClothSpec& cloth) { return cloth.name == name; });
    };
    std::string name = stem;
    for (int number = 2; known(name); ++number) name = stem + " " + std::to_string(number);
    return name;
}

/// The scene that the command line describes: meshes where they are, garments moved as asked.
Scene drape_scene(const DrapeOptions& options) {
    Scene scene;
    scene.file = "drape";
    scene.until_rest = true;
    scene.longest = options.seconds;
    scene.step.kinetic_damping = true;
    scene.step.rest_speed = options.still;
    Fabric fabric = options.fabric;
    fabric.self_contact = !options.no_self_contact;
    scene.fabrics[mesh_fabric] = fabric;
    if (options.damps_patterns) {
        fabric.damping_time = sewing_damping;
        fabric.spring_damping = 0.0;
    }
    scene.fabrics[pattern_fabric] = fabric;
    if (!options.preset.empty()) scene.preset_moduli = {mesh_fabric};
    for (const std::string& file : options.garments()) {
        ClothSpec cloth;
        cloth.name = garment_name(file, scene);
        cloth.fabric = is_pattern(file) ? pattern_fabric : mesh_fabric;
        cloth.place = {.file = file};
        cloth.unit = metres("--garment-unit", options.garment_unit);
        cloth.pose.translation = Vec3(options.move[0], options.move[1], options.move[2]);
        if (is_pattern(file))
            add_pattern(options, cloth, scene);
        else
            cloth.mesh = file;
        scene.cloths.push_back(cloth);
    }
    ObstacleSpec body;
    body.name = "body";
    body.mesh = options.body();
    body.unit = metres("--body-unit", options.body_unit);
    body.friction = options.friction;
    body.place = {.file = options.body()};
    scene.obstacles.push_back(body);
    return scene;
}

Drape settle(BuiltScene& built, const DrapeOptions& options) {
    const StopSignals signals;
    ProgressBar bar(!options.quiet, options.seconds);
    Drape drape;
    RestWatch watch;
    const double all_sewn = sewing_time * static_cast<double>(built.scene.seams.size());
    bool sewn = built.scene.seams.empty();
    while (built.simulation.time() < options.seconds - 1e-9) {
        if (!sewn && built.simulation.time() >= all_sewn - 1e-9) {
            built.scene.step.gravity = StepSettings{}.gravity;
            built.simulation.set_gravity(built.scene.step.gravity);
            sewn = true;
        }
        watch.begin(built.simulation, built.cloths);
        try {
            drape.last = built.simulation.step();
        } catch (const StartError& error) {
            drape.end = DrapeEnd::failed;
            drape.failure = std::string(error.what()) + " (--no-self-contact: as if it did not)";
            return drape;
        }
        if (!drape.last.ok()) {
            drape.end = DrapeEnd::failed;
            drape.failure = drape.last.explanation();
            return drape;
        }
        watch.look(built.simulation, built.cloths, drape.last, built.scene.step.gravity, sewn);
        drape.speed = watch.figures().largest_speed;
        bar.show(built.simulation.time());
        drape.met = drape.met || drape.last.contacts > 0;
        const bool settled = watch.figures().at_rest;
        if (!settled && !signals.asked()) continue;
        drape.end = settled ? DrapeEnd::settled : DrapeEnd::stopped;
        return drape;
    }
    return drape;
}

FrameCheck write_and_certify(const BuiltScene& built, const DrapeOptions& options) {
    std::vector<TriangleMesh> cloths = built.cloth_meshes;
    TriangleMesh body = built.obstacle_meshes[0];
    place_shapes(built, cloths, {&body, 1});
    FrameCheck check;
    for (std::size_t k = 0; k < cloths.size(); ++k) {
        write_obj(options.outs[k], cloths[k].vertices, cloths[k].triangles);
        add_certificate(check, certify(cloths[k], body, 4.0 * options.fabric.thickness));
    }
    FrameCheck own;
    add_cloth_certificate(own, cloths, sewn_stitches(built), all_pairs(static_cast<int>(cloths.size())));
    check.at_seams = own.at_seams;
    if (!options.no_self_contact)
        check.intersections += own.intersections;
    else if (own.intersections > 0 && !options.quiet)
        std::printf("without self-contact: cloth crosses cloth in %d triangle pairs\n", own.intersections);
    return check;
}

/// The stitch that is farthest open.
struct WidestGap {
    std::size_t stitches = 0;  // of all seams
    double width = 0.0;        // m
    std::string seam = {}, garment = {};
    Vec3 place = Vec3::Zero();  // m, of its vertex
};

WidestGap widest_gap(const BuiltScene& built) {
    WidestGap widest;
    for (const BuiltSeam& seam : built.seams) {
        const std::vector<double> gaps = built.simulation.seam_gaps(seam.id);
        widest.stitches += gaps.size();
        const auto found = std::max_element(gaps.begin(), gaps.end());
        if (*found < widest.width) continue;
        widest.width = *found;
        widest.seam = seam.name;
        widest.garment = built.scene.cloths[seam.sewn.cloths[0]].name;
        const int vertex = seam.sewn.stitches[static_cast<std::size_t>(found - gaps.begin())].vertex;
        widest.place = built.simulation.positions(built.cloths[seam.sewn.cloths[0]])[vertex];
    }
    return widest;
}

int verdict(const DrapeOptions& options, const Drape& drape, const FrameCheck& check, const WidestGap& gap) {
    const std::string files = joined(options.outs);
    const char* out = files.c_str();
    if (!check.clean()) {
        std::fprintf(stderr,
                     "percale: %s: not clean: %d intersecting pairs (with the body, themselves or each other), %d vertices "
                     "inside the body, deepest %.3g m\n",
                     out, check.intersections, check.vertices_inside, check.deepest_penetration);
        return not_as_expected;
    }
    if (gap.width > widest_sewn_gap) {
        std::fprintf(
            stderr,
            "percale: %s: not sewn: seam '%s' of '%s' is open by %.3g m at (%.3g, %.3g, %.3g); does its way lie around or "
            "through the body?\n",
            out, gap.seam.c_str(), gap.garment.c_str(), gap.width, gap.place.x(), gap.place.y(), gap.place.z());
        return not_as_expected;
    }
    if (drape.end == DrapeEnd::settled) return all_well;
    if (drape.end == DrapeEnd::time_up && std::isinf(check.smallest_distance)) {
        std::fprintf(stderr, "percale: %s: the garment %s the body; use --move to start it where it can catch\n", out,
                     drape.met ? "fell off" : "never met");
        return not_as_expected;
    }
    const bool stopped = drape.end == DrapeEnd::stopped;
    std::fprintf(stderr, "percale: %s: not at rest when %s after %.3g s: the fastest vertex moves at %.3g m/s\n", out,
                 stopped ? "stopped" : "the time was up", drape.last.time, drape.speed);
    return stopped ? stopped_by_signal : not_as_expected;
}

void print_seams(const WidestGap& gap, const FrameCheck& check) {
    if (gap.stitches == 0) return;
    std::printf("%zu stitches, largest gap %.3g m", gap.stitches, gap.width);
    if (check.at_seams > 0) std::printf("; %d pairs of triangles at one stitch cross within it", check.at_seams);
    std::printf("\n");
}

int drape_garment(const DrapeOptions& options) {
    if (options.files.size() < 2)
        throw SceneError(options.files.front() + ": is the only file; name the garments, the innermost first, and then the BODY");
    const Scene scene = drape_scene(options);
    check_options(options);
    BuiltScene built = build_scene(scene);
    std::size_t start_moves = 0;
    if (!options.quiet) {
        std::printf("%s onto %s\n", joined(options.garments()).c_str(), options.body().c_str());
        for (const std::string& warning : built.warnings) std::printf("warning: %s\n", warning.c_str());
        start_moves = print_start_moves(built.simulation);
    }
    std::fflush(stdout);
    const Drape drape = settle(built, options);
    if (!options.quiet) print_moves_after(start_moves, built.simulation);
    if (drape.end == DrapeEnd::failed) {
        std::fprintf(stderr, "percale: %s: nothing was written: %s\n", joined(options.garments()).c_str(), drape.failure.c_str());
        return not_as_expected;
    }
    const FrameCheck check = write_and_certify(built, options);
    if (!options.quiet)
        std::printf("%s: %s%.3g s simulated, fastest vertex %.3g m/s, %d intersecting pairs, %s\n", joined(options.outs).c_str(),
                    drape.end == DrapeEnd::settled ? "at rest, " : "", drape.last.time, drape.speed, check.intersections,
                    nearness_text(check.smallest_distance).c_str());
    const WidestGap gap = widest_gap(built);
    if (!options.quiet) print_seams(gap, check);
    return verdict(options, drape, check, gap);
}

/// The preset, with what else the command line says.
Fabric fabric_from_preset(const CLI::App& command, const DrapeOptions& options) {
    std::vector<std::string> names;
    for (const FabricPreset& preset : fabric_presets()) names.emplace_back(preset.name);
    if (std::find(names.begin(), names.end(), options.preset) == names.end())
        throw SceneError("--fabric: no fabric preset '" + options.preset + "'" + suggestion(options.preset, names));
    Fabric fabric = fabric_preset(options.preset);
    const auto given = [&](const std::string& option) { return command.get_option(option)->count() > 0; };
    if (given("--thickness")) fabric.thickness = options.fabric.thickness;
    if (given("--area-density")) fabric.area_density = options.fabric.area_density;
    if (!given("--damping")) return fabric;
    fabric.damping_time.reset();
    fabric.spring_damping = options.fabric.spring_damping;
    return fabric;
}

void add_options(CLI::App& command, DrapeOptions& options) {
    command
        .add_option("FILE", options.files,
                    "Garments from the innermost to the outermost, each a mesh outside the body or a sewing pattern around it "
                    "(.toml, .json), then the body's mesh")
        ->type_name("GARMENT... BODY")
        ->expected(1, 100)
        ->required();
    command.add_option("-o", options.outs, "Draped mesh (.obj), once for each garment")
        ->type_name("OUT")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->required();
    command.add_option("--garment-unit", options.garment_unit, "Unit of the garment's file: mm, cm, m (default m)")
        ->type_name("UNIT");
    command.add_option("--body-unit", options.body_unit, "Unit of the body's file: mm, cm, m (default m)")->type_name("UNIT");
    command.add_option("--move", options.move, "Move garments before they start, m")
        ->type_name("X Y Z")
        ->delimiter(',')
        ->allow_extra_args(false);
    CLI::Option* preset = command
                              .add_option("--fabric", options.preset,
                                          "Fabric preset, its moduli the same in all directions on meshes (percale explain "
                                          "presets; default: a felt of springs)")
                              ->type_name("NAME");
    command.add_option("--thickness", options.fabric.thickness, "Gap kept from the body, m (default 0.005)")->type_name("M");
    command.add_option("--area-density", options.fabric.area_density, "kg/m^2 (default 0.2)")->type_name("D");
    command.add_option("--structural", options.fabric.springs.structural, "Spring constant of edges, N/m (default 1000)")
        ->type_name("K")
        ->excludes(preset);
    command.add_option("--bend", options.fabric.springs.bend, "Spring constant across edges, N/m (default 5)")
        ->type_name("K")
        ->excludes(preset);
    command.add_option("--damping", options.fabric.spring_damping, "Damping of each spring, N s/m (default 2)")->type_name("C");
    command.add_option("--friction", options.friction, "Coulomb coefficient (default 0.4)")->type_name("MU");
    command.add_option("--edge-length", options.edge_length, "How long the edges of a pattern's mesh are, m (default 0.02)")
        ->type_name("M");
    command.add_option("--seconds", options.seconds, "Simulated time at most, s (default 20)")->type_name("S");
    command
        .add_option("--still", options.still,
                    "At rest is what for half a second keeps within half a second times this of one place, m/s (default 0.0002)")
        ->type_name("V");
    command.add_flag("--until-rest", options.until_rest,
                     "Go on until all garments are proven at rest; so it does without this, too");
    command.add_flag("--no-self-contact", options.no_self_contact,
                     "Let garments pass through themselves and each other, which costs less");
    command.add_flag("--quiet", options.quiet, "Print nothing but errors");
}

}  // namespace

void add_drape_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<DrapeOptions>();
    CLI::App* command = program.add_subcommand("drape", "Let garments settle on a body until they are at rest");
    command->footer("Example: percale drape data/meshes/poncho.obj data/meshes/mannequin.obj --move 0 1.53 0 -o draped.obj");
    add_options(*command, *options);
    command->callback([options, command, &action] {
        action = [options, command] {
            options->damps_patterns = !options->preset.empty() && command->get_option("--damping")->count() == 0;
            if (!options->preset.empty()) options->fabric = fabric_from_preset(*command, *options);
            return drape_garment(*options);
        };
    });
}

}  // namespace percale::program
