#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "common/text.h"
#include "common/whole_file.h"
#include "pattern/panel_mesh.h"
#include "pattern/pattern_file.h"
#include "pattern/pattern_mesh.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/exit_codes.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct SewOptions {
    std::string pattern, out;
    double edge_length = 0.02;  // m
    bool quiet = false;
};

double degrees(double angle) { return angle * 57.29577951308232; }

/// The smallest angle of all panels, rad, in the plane of the pattern.
double smallest_angle_of(const PatternMesh& garment) {
    return smallest_angle(PanelMesh{.vertices = garment.uv, .triangles = garment.mesh.triangles});
}

void print_garment(const SewOptions& options, const PatternMesh& garment) {
    for (const PanelPart& part : garment.panels) {
        std::printf("panel %s: %d vertices, %d triangles\n", part.name.c_str(), part.vertices, part.triangles);
    }
    double length = 0.0;
    for (const SewnSeam& seam : garment.seams) length += seam.length;
    std::printf("%s: %s, %zu vertices, %zu triangles, %s of %.3g m, %zu stitches, smallest angle %.1f degrees\n",
                options.out.c_str(), counted(static_cast<long>(garment.panels.size()), "panel").c_str(),
                garment.mesh.vertices.size(), garment.mesh.triangles.size(),
                counted(static_cast<long>(garment.seams.size()), "seam").c_str(), length, all_stitches(garment).size(),
                degrees(smallest_angle_of(garment)));
}

int sew_pattern(const SewOptions& options) {
    if (std::filesystem::path(options.out).extension() != ".obj")
        throw SceneError("-o " + options.out + ": its name must end in .obj, which is what is written");
    const PatternMesh garment = mesh_pattern(read_pattern(options.pattern), options.edge_length);
    write_whole_file(options.out, pattern_obj_text(garment));
    if (!options.quiet) print_garment(options, garment);
    return all_well;
}

}  // namespace

void add_sew_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<SewOptions>();
    CLI::App* command = program.add_subcommand("sew", "Mesh a sewing pattern: panels in place, with their stitches");
    command->footer("Example: percale sew data/patterns/skirt.toml -o skirt.obj --edge-length 0.015");
    command->add_option("PATTERN", options->pattern, "Sewing pattern (.toml, or .json of GarmentCode)")->required();
    command->add_option("-o", options->out, "Mesh (.obj) with vt, a group a panel and lines \"stitch i j k t\"")
        ->type_name("OUT")
        ->required();
    command->add_option("--edge-length", options->edge_length, "How long edges are, m (default 0.02)")->type_name("M");
    command->add_flag("--quiet", options->quiet, "Print nothing but errors");
    command->callback([options, &action] { action = [options] { return sew_pattern(*options); }; });
}

}  // namespace percale::program
