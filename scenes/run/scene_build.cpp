#include "run/scene_build.h"

#include <algorithm>
#include <limits>
#include <span>

#include "common/scene_file_error.h"
#include "common/text.h"
#include "format/expectations.h"
#include "format/rest_check.h"
#include "garment/cloth_shape.h"
#include "garment/cloth_warnings.h"
#include "garment/meeting_warnings.h"
#include "garment/vertex_selection.h"
#include "meshes/mesh_import.h"
#include "percale/detectors.h"
#include "percale/error.h"
#include "percale/fabric_presets.h"
#include "run/attached_pins.h"
#include "run/event_script.h"
#include "run/obstacle_motion.h"
#include "run/start_fault.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

/// Fraction by which a step may be longer than a frame without passing one by. 0: rounding warns.
constexpr double frame_rounding = 1e-9;

/// Thicknesses of cloth, and fraction of an obstacle's area: where more of it has edges so long, it hardly gives way.
constexpr double coarse_edge_thicknesses = 12.0, reported_coarse_ratio = 0.05;

/// Strain from which a run and drape warn that a garment is tight. Smaller: it warns of knits made to stretch.
constexpr double tight_strain = 0.25;

/// Fraction of a strain limit by which cloth may exceed it without a warning.
constexpr double passed_limit_ratio = 0.1;

/// How messages name a cloth and an obstacle.
std::string reported(const ClothSpec& cloth) { return "cloth '" + cloth.name + "'"; }
std::string reported(const ObstacleSpec& obstacle) { return "obstacle '" + obstacle.name + "'"; }

/// What an error says of a cloth or an obstacle, with its name once. Where a mesh is its own place, its file is not named again.
template <class Spec>
std::string reported_of(const Spec& spec, const SceneError& error) {
    if (error.subject() == reported(spec)) return error.what();
    const bool known = error.subject() == spec.name || error.subject() == spec.place.file;
    return "'" + spec.name + "': " + (known ? error.reason() : error.what());
}

/// Builds a cloth or an obstacle; errors and warnings name its place in the scene file.
template <class Spec, class Work>
void at_place_of(const Spec& spec, std::vector<Finding>& warnings, Work work) {
    const std::size_t before = warnings.size();
    try {
        work();
    } catch (const SceneError& error) {
        // A file that is all there is to say of the place, and in which a place was found.
        if (spec.place.line == 0 && error.subject().starts_with(spec.place.file + ":")) throw;
        fail_at(spec.place, reported_of(spec, error));
    }
    for (Finding& warning : std::span(warnings).subspan(before)) warning.place = place_text(spec.place);
}

std::unique_ptr<ContactDetector> detector_for(const Scene& scene) {
    if (!scene.has_contact() && (scene.step.skip || scene.detector == Detector::none)) return nullptr;
    if (scene.detector != Detector::none) return make_detector(scene.detector);
    std::vector<std::string> valid(detector_words.begin(), detector_words.end());
    std::erase(valid, word_of(Detector::none));
    const std::string lacks = " needs a detector, but step.detector is none; valid: " + joined(valid);
    const ClothSpec* cloth = scene.cloth_that_meets_cloth();
    if (!scene.obstacles.empty()) fail_at(scene.obstacles[0].place, reported(scene.obstacles[0]) + lacks);
    fail_at(cloth->place, reported(*cloth) + ": self_contact" + lacks);
}

const Fabric& fabric_of(const Scene& scene, const ClothSpec& cloth) {
    const auto found = scene.fabrics.find(cloth.fabric);
    if (found == scene.fabrics.end()) throw SceneError("no fabric '" + cloth.fabric + "'");
    return found->second;
}

void check_shear(const ClothSpec& cloth, const TriangleMesh& mesh, double shear) {
    if (mesh.is_grid() || shear == 0.0) return;
    throw SceneError(reported(cloth), "fabric." + cloth.fabric + ".springs.shear = " + number_text(shear) +
                                          " N/m, but a free mesh has no shear springs; it must be 0");
}

/// A preset has a direction of warp. On a mesh without one the fabric is made isotropic, with a warning.
Fabric fabric_on(BuiltScene& built, const ClothSpec& cloth, const TriangleMesh& mesh, const RestShape& rest) {
    const Fabric& fabric = fabric_of(built.scene, cloth);
    if (mesh.is_grid() || rest.warp != Vec3::Zero() || !built.scene.preset_moduli.contains(cloth.fabric)) return fabric;
    const Fabric result = isotropic(fabric);
    const auto [warp, weft] = *fabric.stretch_stiffness;
    built.warnings.push_back(finding(
        "isotropic_fabric", {},
        reported(cloth) + ": its mesh does not say where warp is (key warp, or rest = \"uv\"); instead of stretch_stiffness = [" +
            number_text(warp) + ", " + number_text(weft) + "] N/m, fabric." + cloth.fabric + " has " +
            number_text(result.stretch_stiffness->front()) +
            " N/m in every direction there, what belongs to its shear_stiffness"));
    return result;
}

void add_cloth(BuiltScene& built, const ClothSpec& cloth) {
    ClothShape shape = cloth_shape(built.scene, cloth, built.warnings);
    const Fabric fabric = fabric_on(built, cloth, shape.start, shape.rest);
    check_shear(cloth, shape.start, fabric.springs.shear);
    const ClothId id = built.simulation.add_cloth(shape.start, fabric, {}, cloth.name, shape.rest);
    if (cloth.layer != 0 && built.scene.meets_cloth(cloth)) built.simulation.set_layer(id, cloth.layer);
    built.cloths.push_back(id);
    built.cloth_meshes.push_back(std::move(shape.start));
    built.rest_shapes.push_back(std::move(shape.rest));
    built.pattern_seams.push_back(std::move(shape.seams));
}

void pin_cloth(BuiltScene& built, const ClothSpec& cloth) {
    at_place(cloth.pin_place, "pin: ", [&] {
        for (const int vertex : select_vertices(cloth.pin, built.cloth_meshes.back(), cloth.name))
            built.simulation.pin(built.cloths.back(), vertex);
    });
}

/// Warns of steps longer than a frame, which pass by frames.
void warn_of_passed_frames(BuiltScene& built, const ObstacleSpec& obstacle, const BodyShapes& shapes) {
    const double step = built.scene.step.time_step;
    if (obstacle.clip || built.scene.step.adaptive || step <= (1.0 + frame_rounding) * shapes.frame_time()) return;
    built.warnings.push_back(
        finding("passed_frames", {},
                reported(obstacle) + ": its frames are " + short_number(shapes.frame_time()) +
                    " s apart, step.time_step = " + short_number(step) + " s passes some by",
                "take step.time_step = " + short_number(shapes.frame_time()) + " or less where none is to be missed"));
}

/// The fraction of a mesh's area in triangles with an edge above a length.
double coarse_share(const TriangleMesh& mesh, double longest) {
    double coarse = 0.0, whole = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 u = mesh.vertices[b] - mesh.vertices[a], v = mesh.vertices[c] - mesh.vertices[a];
        const double area = u.cross(v).norm();
        whole += area;
        if (std::max({u.norm(), v.norm(), (u - v).norm()}) > longest) coarse += area;
    }
    return whole > 0.0 ? coarse / whole : 0.0;
}

/// Warns of long edges, as a surface gives way at its vertices alone.
void warn_of_coarse_compliant(BuiltScene& built, const ObstacleSpec& obstacle, const TriangleMesh& mesh) {
    double thickness = std::numeric_limits<double>::infinity();
    for (const ClothSpec& cloth : built.scene.cloths) thickness = std::min(thickness, fabric_of(built.scene, cloth).thickness);
    const double longest = coarse_edge_thicknesses * thickness, share = coarse_share(mesh, longest / obstacle.pose.scale);
    if (share <= reported_coarse_ratio) return;
    built.warnings.push_back(finding("coarse_compliant", {},
                                     reported(obstacle) + ": on_pinch = \"yield\", but " + percent_text(share) +
                                         " of its surface has edges above " + short_number(longest) +
                                         " m, and it gives way at vertices alone",
                                     "refine its mesh"));
}

void add_obstacle(BuiltScene& built, const ObstacleSpec& obstacle) {
    std::shared_ptr<BodyShapes> shapes;
    if (obstacle.bends()) shapes = std::make_shared<BodyShapes>(built.scene, obstacle, &built.warnings);
    TriangleMesh mesh = shapes ? shapes->first() : obstacle_mesh(built.scene, obstacle, &built.warnings);
    check_mesh(mesh, reported(obstacle), false);
    const ObstacleSettings settings{.friction = obstacle.friction,
                                    .restitution = obstacle.restitution,
                                    .name = obstacle.name,
                                    .deforming = shapes != nullptr,
                                    .yields = obstacle.yields};
    if (shapes) warn_of_passed_frames(built, obstacle, *shapes);
    if (obstacle.yields) warn_of_coarse_compliant(built, obstacle, mesh);
    built.shapes.push_back(std::move(shapes));
    built.obstacles.push_back(built.simulation.add_obstacle(mesh, obstacle_pose_at(obstacle, 0.0), settings));
    built.obstacle_meshes.push_back(std::move(mesh));
}

void sew(BuiltScene& built, const SeamSpec& seam, BuiltSeam made) {
    const auto [first, second] = made.sewn.cloths;
    made.closed_at = seam.start_time + seam.duration;
    made.id = built.simulation.add_seam(built.cloths[first], built.cloths[second], made.sewn.stitches,
                                        {.after = seam.start_time,
                                         .over = seam.duration,
                                         .stiffness = seam.stiffness,
                                         .contact_while_closing = seam.contact_while_closing,
                                         .weld = seam.weld,
                                         .name = made.name});
    built.seams.push_back(std::move(made));
}

/// Sews all seams of a pattern, each with its name there.
void sew_pattern(BuiltScene& built, int cloth, const SeamSpec& seam) {
    for (const SewnSeam& own : built.pattern_seams[cloth]) {
        if (own.stitches.empty()) continue;
        sew(built, seam, {.name = own.name, .sewn = {{cloth, cloth}, own.stitches}});
    }
}

void add_seam(BuiltScene& built, const SeamSpec& seam) {
    at_place(seam.place, "", [&] {
        const auto [first, second] = seam_cloths(built.scene, seam);
        const bool of_pattern = seam.file == "mesh" && first == second && !built.scene.cloths[first].pattern.empty();
        if (of_pattern) sew_pattern(built, first, seam);
        SeamSpec rest = seam;
        if (of_pattern) rest.file.clear();
        const std::string number = "seam " + std::to_string(built.seams.size());
        BuiltSeam made{.name = seam.name.empty() ? number : seam.name,
                       .sewn = {{first, second}, seam_stitches(built.scene, rest)}};
        if (!of_pattern || !made.sewn.stitches.empty()) sew(built, seam, std::move(made));
    });
}

/// Sews the patterns of which no [[seam]] says how they are sewn.
void sew_other_patterns(BuiltScene& built) {
    for (int cloth = 0; cloth < static_cast<int>(built.cloths.size()); ++cloth) {
        const auto says = [&](const SeamSpec& seam) {
            return seam.file == "mesh" && seam_cloths(built.scene, seam) == std::array{cloth, cloth};
        };
        if (std::ranges::none_of(built.scene.seams, says)) sew_pattern(built, cloth, {});
    }
}

void set_pair(BuiltScene& built, const PairSpec& pair) {
    const std::string names = "'" + pair.cloths[0] + "' and '" + pair.cloths[1] + "'";
    const auto key = [](const PairSpec& p) { return std::minmax(p.cloths[0], p.cloths[1]); };
    const auto first = std::ranges::find_if(built.scene.pairs, [&](const PairSpec& other) { return key(other) == key(pair); });
    if (&*first != &pair) throw SceneError("pair: " + names + " are a pair above already");
    if (pair.contact && !pair.thickness)
        throw SceneError("pair: " + names + ": contact = true alone says nothing, cloths meet without it");
    const auto id = [&](const std::string& name) { return built.cloths[cloth_number(built.scene, name)]; };
    built.simulation.set_pair(id(pair.cloths[0]), id(pair.cloths[1]), {.contact = pair.contact, .thickness = pair.thickness});
}

// Cloths have the same numbers in the scene and in the simulation; triangles are counted through all of them.
const SourcePlace& place_of_triangle(const BuiltScene& built, int triangle) {
    std::size_t cloth = 0, end = built.cloth_meshes[0].triangles.size();
    while (static_cast<std::size_t>(triangle) >= end) end += built.cloth_meshes[++cloth].triangles.size();
    return built.scene.cloths[cloth].place;
}

// Obstacles have the same numbers there, too.
[[noreturn]] void refuse_start(const BuiltScene& built, const StartError& error) {
    if (error.fault().between_cloths())
        throw StartRefused(place_of_triangle(built, error.fault().cloth_triangle), error.what(), {});
    const auto number = static_cast<std::size_t>(error.fault().obstacle);
    throw StartRefused(built.scene.obstacles.at(number).place, error.what(),
                       offending_triangles(built.cloth_meshes, obstacle_now(built, number)));
}

void check_start(BuiltScene& built) {
    const Scene& scene = built.scene;
    try {
        built.simulation.prepare();
    } catch (const StartError& error) {
        refuse_start(built, error);
    } catch (const SceneError& error) {
        fail_at(scene.scheme_place, std::string("step.scheme: ") + error.what());
    }
}

/// Adds warnings of what is likely a mistake.
void add_doubts(BuiltScene& built) {
    std::vector<TriangleMesh> obstacles;
    for (std::size_t k = 0; k < built.obstacles.size(); ++k) obstacles.push_back(obstacle_now(built, k));
    append_findings(cloth_warnings(built.scene, built.cloth_meshes), built.warnings);
    append_findings(meeting_warnings(built.scene, built.cloth_meshes, obstacles), built.warnings);
}

/// The warning of cloth that would have torn, with the frequent cause.
Finding torn_warning(const Scene& scene, double strain) {
    Finding warning = finding("torn", {scene.file}, "the largest strain is " + percent_text(strain) + ": cloth would have torn");
    const auto moving = std::ranges::find_if(scene.obstacles, [](const ObstacleSpec& o) { return obstacle_moves(o); });
    const auto held = std::ranges::find_if(scene.cloths, [](const ClothSpec& cloth) { return has_pins_in_world(cloth); });
    if (moving != scene.obstacles.end() && held != scene.cloths.end())
        warning.fix = "the pins of " + held->name + " stay in the world, pin = { box = ..., to = \"" + moving->name +
                      "\" } holds them to a body";
    return warning;
}

/// When each obstacle keeps its shape, s.
std::vector<double> ends_of_shapes(const BuiltScene& built) {
    std::vector<double> ends;
    for (const auto& shapes : built.shapes) ends.push_back(shapes ? shapes->end() : 0.0);
    return ends;
}

WidestGap gap_of(const BuiltScene& built, const BuiltSeam& seam) {
    const std::vector<double> gaps = built.simulation.seam_gaps(seam.id);
    const auto widest = std::max_element(gaps.begin(), gaps.end());
    const ClothId cloth = built.cloths[seam.sewn.cloths[0]];
    const int vertex = seam.sewn.stitches[static_cast<std::size_t>(widest - gaps.begin())].vertex;
    return {.stitches = gaps.size(),
            .width = *widest,
            .seam = seam.name,
            .garment = built.scene.cloths[seam.sewn.cloths[0]].name,
            .place = built.simulation.positions(cloth)[vertex]};
}

}  // namespace

std::unique_ptr<ContactDetector> make_detector(Detector detector) {
    switch (detector) {
        case Detector::fcl:
            return make_fcl_detector();
        case Detector::bullet:
            return make_bullet_detector();
        case Detector::brute_force:
            return make_brute_force_detector();
        case Detector::none:
            break;
    }
    return nullptr;
}

TriangleMesh obstacle_now(const BuiltScene& built, std::size_t obstacle) {
    TriangleMesh mesh = built.obstacle_meshes[obstacle];
    const std::span<const Vec3> shape = built.simulation.obstacle_shape(built.obstacles[obstacle]);
    mesh.vertices = transform(built.simulation.obstacle_pose(built.obstacles[obstacle]),
                              shape.empty() ? std::span<const Vec3>(mesh.vertices) : shape);
    return mesh;
}

std::vector<Finding> strain_warnings(const BuiltScene& built, double largest_strain) {
    std::vector<Finding> warnings;
    if (largest_strain > torn_strain) warnings.push_back(torn_warning(built.scene, largest_strain));
    for (std::size_t k = 0; k < built.cloths.size(); ++k) {
        const ClothSpec& cloth = built.scene.cloths[k];
        const std::optional<double> limit = built.scene.fabrics.at(cloth.fabric).strain_limit;
        if (!limit) continue;
        const double strain = built.simulation.largest_strain(built.cloths[k]);
        if (strain <= (1.0 + passed_limit_ratio) * *limit) continue;
        warnings.push_back(
            finding("passed_strain_limit", cloth.place,
                    "an edge of '" + cloth.name + "' is strained by " + percent_text(strain) + ", beyond its strain_limit of " +
                        percent_text(*limit) +
                        "; a sudden load passes it for some steps, one of more than twice the edge's stiffness for good"));
    }
    return warnings;
}

std::vector<Finding> tight_warnings(const BuiltScene& built, const std::string& scale) {
    std::vector<Finding> warnings;
    for (std::size_t k = 0; k < built.cloths.size(); ++k) {
        const double strain = built.simulation.largest_strain(built.cloths[k]);
        const ClothSpec& cloth = built.scene.cloths[k];
        const bool held = has_pins(cloth) || built.scene.pins_have_events(cloth) || built.scene.is_filled(cloth);
        if (held || cloth.grid || strain < tight_strain || strain > torn_strain) continue;
        warnings.push_back(finding(
            "tight", cloth.place,
            "'" + cloth.name + "' is stretched by " + percent_text(strain) + " at its tightest: it may be too small for the body",
            scale + " makes it larger"));
    }
    return warnings;
}

WidestGap widest_gap(const BuiltScene& built) {
    WidestGap widest;
    for (const BuiltSeam& seam : built.seams) {
        widest.stitches += seam.sewn.stitches.size();
        const WidestGap gap = gap_of(built, seam);
        if (gap.width < widest.width) continue;
        widest = {widest.stitches, gap.width, gap.seam, gap.garment, gap.place};
    }
    return widest;
}

std::optional<double> largest_seam_gap(const BuiltScene& built) {
    if (built.seams.empty()) return std::nullopt;
    return widest_gap(built).width;
}

std::string unsewn_text(const WidestGap& gap) {
    const Vec3& x = gap.place;
    const std::string place = "(" + short_number(x.x()) + ", " + short_number(x.y()) + ", " + short_number(x.z()) + ")";
    return "not sewn: seam '" + gap.seam + "' of '" + gap.garment + "' is open by " + short_number(gap.width) + " m at " + place +
           "; does its way lie around or through the body?";
}

std::vector<Finding> seam_warnings(const BuiltScene& built) {
    std::vector<Finding> warnings;
    for (const BuiltSeam& seam : built.seams) {
        if (built.simulation.time() < seam.closed_at) continue;
        const WidestGap gap = gap_of(built, seam);
        if (gap.width > widest_sewn_gap)
            warnings.push_back(finding("unsewn", built.scene.cloths[seam.sewn.cloths[0]].place, unsewn_text(gap)));
    }
    return warnings;
}

std::vector<ClothStitches> sewn_stitches(const BuiltScene& built) {
    std::vector<ClothStitches> sewn;
    for (const BuiltSeam& seam : built.seams) sewn.push_back(seam.sewn);
    return sewn;
}

TriangleMesh obstacle_mesh(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>* warnings) {
    if (obstacle.mesh.empty()) return shape_mesh(obstacle.shape);
    if (obstacle.bends()) return BodyShapes(scene, obstacle, warnings).first();
    check_still(scene, obstacle);
    return import_mesh(path_beside(scene, obstacle.mesh), obstacle.unit, warnings, obstacle.part, obstacle.weld);
}

BuiltScene build_scene(const Scene& given, const std::atomic<bool>* cancel) {
    Scene scene = given;
    const bool open = scene.step.measure == StepMeasures::automatic;
    if (open && read_step_measures(scene.expectations)) scene.step.measure = StepMeasures::all;
    std::unique_ptr<ContactDetector> detector = detector_for(scene);
    BuiltScene built{.scene = scene,
                     .simulation = Simulation(scene.step, std::move(detector)),
                     .cloths = {},
                     .cloth_meshes = {},
                     .rest_shapes = {},
                     .obstacles = {},
                     .obstacle_meshes = {},
                     .shapes = {},
                     .pattern_seams = {},
                     .seams = {},
                     .warnings = scene.warnings};
    for (const ClothSpec& cloth : scene.cloths) {
        at_place_of(cloth, built.warnings, [&] { add_cloth(built, cloth); });
        pin_cloth(built, cloth);
    }
    for (const ObstacleSpec& obstacle : scene.obstacles)
        at_place_of(obstacle, built.warnings, [&] { add_obstacle(built, obstacle); });
    add_doubts(built);
    for (const SeamSpec& seam : scene.seams) add_seam(built, seam);
    sew_other_patterns(built);
    for (const PairSpec& pair : built.scene.pairs) at_place(pair.place, "", [&] { set_pair(built, pair); });
    script_events(scene, built.cloth_meshes);
    attached_pins(scene, built.cloth_meshes, built.obstacle_meshes);
    built.simulation.set_cancel(cancel);
    check_start(built);
    built.simulation.set_cancel(nullptr);
    if (scene.until_rest) {
        check_can_rest(scene, built.simulation.plan());
        check_shapes_end(scene, ends_of_shapes(built));
    }
    return built;
}

}  // namespace percale::scenes
