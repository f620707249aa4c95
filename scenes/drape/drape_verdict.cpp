#include "drape/drape_verdict.h"

#include <algorithm>
#include <cmath>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "meshes/obj_file.h"
#include "percale/certify.h"
#include "run/frame_fields.h"
#include "run/run_verdict.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

/// m. A garment from a pattern that hangs lower than this since it was sewn, in the mean, has slid down. Smaller: it is reported
/// how far cloth gives by its own weight.
constexpr double far_slid = 0.1;

std::string unclean_text(const FrameCheck& check) {
    return "not clean: " + std::to_string(check.intersections) +
           " intersecting pairs (with the body, themselves or each other), " + std::to_string(check.vertices_inside) +
           " vertices inside the body, deepest " + short_number(check.deepest_penetration) + " m";
}

std::string restless_text(const Drape& drape) {
    return std::string("not at rest when ") + (drape.end == DrapeEnd::stopped ? "stopped" : "the time was up") + " after " +
           short_number(drape.last.time) + " s: the fastest vertex moves at " + short_number(drape.rest.largest_speed) +
           " m/s, all at " + short_number(drape.rest.rms_speed) + " m/s rms" +
           (drape.end == DrapeEnd::stopped ? "" : "; --seconds gives it longer, a larger --still is content with less");
}

std::string fault_of(const Drape& drape, const FrameCheck& check, const WidestGap& gap, bool comes_apart) {
    if (!check.clean()) return unclean_text(check);
    if (gap.width > widest_sewn_gap) return unsewn_text(gap);
    if (drape.end == DrapeEnd::settled) return unsolved_text(drape.unsolved_steps);
    const bool away = drape.end == DrapeEnd::time_up && std::isinf(check.smallest_distance);
    if (drape.end == DrapeEnd::fell || away) {
        return std::string(drape.met ? "fell off the body" : "never met the body") +
               (comes_apart
                    ? "; rims of it are joined by nothing where they meet, merge their vertices by distance in the mesh; or "
                    : "; ") +
               "use --move to start it where it can catch, or a size that holds";
    }
    return restless_text(drape);
}

std::string seam_text(const WidestGap& gap, const FrameCheck& check) {
    std::string text = std::to_string(gap.stitches) + " stitches, largest gap " + short_number(gap.width) + " m";
    if (check.at_seams > 0) {
        text += "; " + std::to_string(check.at_seams) + " pairs of triangles at one stitch overlap by its gap, as they may";
    }
    return text;
}

Finding note(const std::string& kind, const std::string& what) { return finding(kind, {}, what, {}, Severity::note); }

/// Patterns are drawn where they are worn: one that hangs much lower at the end did not hold.
void report_sliding_of(const BuiltScene& built, const Drape& drape, std::vector<Finding>& found) {
    for (std::size_t k = 0; k < built.cloths.size(); ++k) {
        if (built.pattern_seams[k].empty()) continue;
        const double drop = drape.height[k] - mean_height(built.simulation, built.cloths[k]);
        if (drop < far_slid) continue;
        const ClothSpec& cloth = built.scene.cloths[k];
        found.push_back(finding("slid", cloth.place,
                                "'" + cloth.name + "' slid down by " + short_number(drop) +
                                    " m in the mean since it was sewn: it does not hold where it was drawn"));
    }
}

}  // namespace

DrapedFiles write_draped(const BuiltScene& built, const DrapeOptions& options, bool z_up) {
    std::vector<TriangleMesh> cloths = built.cloth_meshes;
    TriangleMesh body = built.obstacle_meshes[0];
    place_shapes(built, cloths, {&body, 1});
    DrapedFiles files;
    for (std::size_t k = 0; k < cloths.size(); ++k) {
        std::vector<Vec3> own_axes = cloths[k].vertices;
        if (z_up) {
            for (Vec3& x : own_axes) x = Vec3(x.x(), -x.z(), x.y());
        }
        write_obj(options.outs[k], own_axes, cloths[k].triangles);
        add_certificate(files.check, certify(cloths[k], body, 4.0 * options.fabric.thickness));
    }
    const MeetingMesh joined = joined_meeting_cloth(cloths, sewn_stitches(built), all_pairs(static_cast<int>(cloths.size())));
    FrameCheck own;
    add_cloth_certificate(own, certify_cloth(joined.mesh, joined.stitches, {joined.owner, &joined.pairs}));
    files.check.at_seams = own.at_seams;
    files.own_crossings = own.intersections;
    if (!options.no_self_contact) files.check.intersections += own.intersections;
    return files;
}

DrapeVerdict verdict_of(const BuiltScene& built, const DrapeOptions& options, const Drape& drape, const DrapedFiles& files,
                        bool comes_apart) {
    DrapeVerdict verdict;
    std::vector<Finding>& found = verdict.findings;
    const FrameCheck& check = files.check;
    if (options.no_self_contact && files.own_crossings > 0)
        found.push_back(note("own_crossings", "without self-contact: cloth crosses cloth in " +
                                                  std::to_string(files.own_crossings) + " triangle pairs"));
    found.push_back(note("draped", joined(options.outs) + ": " + (drape.end == DrapeEnd::settled ? "at rest, " : "") +
                                       short_number(drape.last.time) + " s simulated, fastest vertex " +
                                       short_number(drape.rest.largest_speed) + " m/s, " + std::to_string(check.intersections) +
                                       " intersecting pairs" + (options.no_self_contact ? " with the body, " : ", ") +
                                       nearness_text(check.smallest_distance) + ", largest strain " +
                                       percent_text(built.simulation.largest_strain())));
    append_findings(strain_warnings(built, built.simulation.largest_strain()), found);
    const WidestGap gap = widest_gap(built);
    if (gap.stitches > 0) found.push_back(note("sewn", seam_text(gap, check)));
    report_sliding_of(built, drape, found);
    append_findings(tight_warnings(built, "--scale"), found);
    const std::string fault = fault_of(drape, check, gap, comes_apart);
    const std::string outs = joined(options.outs);
    if (!fault.empty())
        verdict.wrong = outs + ": " + fault + "; " + outs + (options.outs.size() > 1 ? " hold" : " holds") + " how it was then";
    return verdict;
}

}  // namespace percale::scenes
