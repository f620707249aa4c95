#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "common/nearest_name.h"
#include "common/text.h"
#include "drape/drape_run.h"
#include "drape/drape_scene.h"
#include "drape/drape_verdict.h"
#include "percale/error.h"
#include "percale/fabric_presets.h"
#include "program/commands.h"
#include "program/exit_codes.h"
#include "program/progress_bar.h"
#include "program/stop_signals.h"
#include "run/start_fault.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

/// What else the command line says.
struct DrapeCommand {
    DrapeOptions drape;
    bool until_rest = true;  // there is nothing else
    bool quiet = false;
};

int finish(const BuiltScene& built, const DrapeCommand& command, const Drape& drape, const DrapeScene& made) {
    const DrapeVerdict verdict =
        verdict_of(built, command.drape, drape, write_draped(built, command.drape, made.z_up), made.comes_apart);
    if (!command.quiet) {
        for (const Finding& finding : verdict.findings) print_finding(finding);
    }
    if (verdict.wrong.empty()) return all_well;
    std::fprintf(stderr, "percale: %s\n", verdict.wrong.c_str());
    return drape.end == DrapeEnd::stopped ? stopped_by_signal : not_as_expected;
}

std::size_t print_start(const DrapeOptions& options, const DrapeScene& made, const BuiltScene& built) {
    std::printf("%s onto %s\n", joined(options.garments()).c_str(), options.body().c_str());
    for (const Finding& finding : made.findings) print_finding(finding);
    for (const Finding& warning : built.warnings)  // swapped meshes are among what was made
        if (std::ranges::find(made.findings, warning.what, &Finding::what) == made.findings.end()) print_finding(warning);
    const std::size_t moves = print_start_moves(built.simulation);
    std::fflush(stdout);
    return moves;
}

/// Drapes with options.sewing_time; nothing where the garment could not be sewn in it and is to be tried `again`.
std::optional<int> drape_once(const DrapeCommand& command, const StopSignals& signals, bool again) {
    const DrapeOptions& options = command.drape;
    const DrapeScene made = signals.prepare([&] { return drape_scene(options); });
    BuiltScene built = signals.prepare([&] { return build_scene(made.scene); });
    built.simulation.set_cancel(&signals.overdue());
    const std::size_t start_moves = command.quiet ? 0 : print_start(options, made, built);
    ProgressBar bar(!command.quiet, options.seconds);
    const auto stop = [&](double time) {
        bar.show(time);
        return signals.asked();
    };
    const Drape drape = settle(built, options, stop, again);
    bar.clear();
    if (!command.quiet) print_start_moves(built.simulation, start_moves, when_sewn);
    const std::string garments = joined(options.garments());
    if (drape.end == DrapeEnd::unsewn) {
        if (!command.quiet)
            std::printf("%s: sewn in %s s: %s\n", garments.c_str(), short_number(options.sewing_time).c_str(),
                        drape.failure.c_str());
        return std::nullopt;
    }
    if (drape.end != DrapeEnd::failed) return finish(built, command, drape, made);
    std::fprintf(stderr, "percale: %s: nothing was written: %s\n", garments.c_str(), drape.failure.c_str());
    return not_as_expected;
}

int drape_garments(DrapeCommand command) {
    DrapeOptions& options = command.drape;
    if (options.files.size() < 2)
        throw SceneError(options.files.front() + ": is the only file; name the garments, the innermost first, and then the BODY");
    check_drape(options);
    const StopSignals signals;
    const std::vector<double> times = sewing_times(options);
    for (std::size_t k = 0;; ++k) {
        options.sewing_time = times[k];
        if (const auto end = drape_once(command, signals, k + 1 < times.size())) return *end;
    }
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
    if (given("--strain-limit")) fabric.strain_limit = options.fabric.strain_limit;
    if (given("--area-density")) fabric.area_density = options.fabric.area_density;
    if (!given("--damping")) return fabric;
    fabric.damping_time.reset();
    fabric.spring_damping = options.fabric.spring_damping;
    return fabric;
}

void add_fabric_options(CLI::App& command, DrapeOptions& options) {
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
    command
        .add_option_function<double>(
            "--strain-limit", [&options](double strain) { options.fabric.strain_limit = strain; },
            "Strain beyond which edges hold back, 0.001 ... 1 (default: none)")
        ->type_name("E");
    command.add_option("--friction", options.friction, "Coulomb coefficient (default 0.4)")->type_name("MU");
}

void add_options(CLI::App& command, DrapeCommand& all) {
    DrapeOptions& options = all.drape;
    command
        .add_option("FILE", options.files,
                    "Garments from the innermost to the outermost, each a mesh outside the body, a mesh with lines \"stitch\" or "
                    "a sewing pattern around it (.toml, .json), then the body's mesh")
        ->type_name("GARMENT... BODY")
        ->expected(1, 100)
        ->required();
    command
        .add_option("-o", options.outs, "Draped mesh (.obj), in m whatever the unit of garment and body, once for each garment")
        ->type_name("OUT")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->required();
    command
        .add_option("--garment-unit", options.garment_unit,
                    "Unit of the garments' meshes: mm, cm, dm, m, inch (default: m, or what fits the body's size)")
        ->type_name("UNIT");
    command
        .add_option("--body-unit", options.body_unit,
                    "Unit of the body's mesh: mm, cm, dm, m, inch (default: m, or what makes it 0.1 to some 10 m large)")
        ->type_name("UNIT");
    command
        .add_option("--garment-part", options.garment_part, "Object or group of the garments' meshes, taken alone (default: all)")
        ->type_name("NAME");
    command.add_option("--body-part", options.body_part, "Object or group of the body's mesh (default: all)")->type_name("NAME");
    command.add_option("--weld", options.weld, "Vertices of the meshes that are as near as that become one, m (default 0, none)")
        ->type_name("M");
    command
        .add_option("--up", options.up, "Axis of the meshes that points up: y, z (default: y, or z if the body stands along it)")
        ->type_name("AXIS");
    command.add_option("--scale,--size", options.scale, "Factor on the size of garments (default 1)")->type_name("F");
    command
        .add_option("--rotate", options.rotate,
                    "Turn garments about the x, then the y, then the z axis of the meshes before they are moved, degrees")
        ->type_name("X Y Z")
        ->delimiter(',')
        ->allow_extra_args(false);
    command.add_option("--move", options.move, "Move garments before they start, m, in the axes of the meshes")
        ->type_name("X Y Z")
        ->delimiter(',')
        ->allow_extra_args(false);
    add_fabric_options(command, options);
    command.add_option("--edge-length", options.edge_length, "How long the edges of a pattern's mesh are, m (default 0.02)")
        ->type_name("M");
    command.add_option("--seconds", options.seconds, "Simulated time at most, s (default 20)")->type_name("S");
    command
        .add_option("--still", options.still,
                    "At rest is what for half a second keeps within half a second times this of one place, m/s (default 0.0002)")
        ->type_name("V");
    command.add_flag("--until-rest", all.until_rest, "Go on until all garments are proven at rest, as it does anyway");
    command.add_flag_callback(
        "--no-weld", [&options] { options.weld_seams = false; },
        "Leave what gaps springs leave at the seams of patterns (default: no gap)");
    command.add_flag("--no-self-contact", options.no_self_contact,
                     "Let garments pass through themselves and each other, which costs less");
    command.add_flag("--quiet", all.quiet, "Print nothing but errors");
}

}  // namespace

void add_drape_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<DrapeCommand>();
    CLI::App* command = program.add_subcommand("drape", "Let garments settle on a body until they are at rest");
    command->footer("Example: percale drape data/meshes/poncho.obj data/meshes/mannequin.obj --move 0 1.53 0 -o draped.obj");
    add_options(*command, *options);
    command->callback([options, command, &action] {
        action = [options, command] {
            DrapeOptions& drape = options->drape;
            drape.damps_patterns = !drape.preset.empty() && command->get_option("--damping")->count() == 0;
            if (!drape.preset.empty()) drape.fabric = fabric_from_preset(*command, drape);
            return drape_garments(*options);
        };
    });
}

}  // namespace percale::program
