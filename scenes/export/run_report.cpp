#include "export/run_report.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "common/finding_json.h"
#include "common/input_file.h"
#include "common/text.h"
#include "export/run_settings.h"
#include "percale/error.h"
#include "run/frame_fields.h"
#include "run/run_verdict.h"
#include "run/scene_plan.h"

namespace percale::scenes {

using nlohmann::ordered_json;

namespace {

constexpr const char* version = PERCALE_VERSION;

/// Largest resident set of this process so far, bytes.
double peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

void put_counts(ordered_json& json, const RunTotals& totals) {
    json["simulated_s"] = totals.simulated_s;
    json["steps"] = totals.steps;
    json["rejected_steps"] = totals.rejected_steps;
    json["halvings"] = {{"not_converged", totals.dropped.not_converged},
                        {"blocked", totals.dropped.blocked},
                        {"not_finite", totals.dropped.not_finite},
                        {"inexact", totals.dropped.inexact}};
    json["unsolved_steps"] = totals.unsolved_steps;
    json["sleeping_steps"] = totals.sleeping_steps;
    json["smallest_step_s"] = totals.smallest_step_s;
    json["largest_step_s"] = totals.largest_step_s;
    json["newton_iterations"] = totals.newton_iterations;
    json["linear_iterations"] = totals.linear_iterations;
    json["largest_residual"] = totals.largest_residual;
    json["linear_solver"] = solver_word(totals.linear_solver);
}

void put_costs(ordered_json& json, const RunTotals& totals) {
    const StageTimes& t = totals.stages;
    json["cpu_s"] = totals.cpu_s;
    json["wall_s"] = totals.wall_s;
    json["certificate_s"] = totals.certificate_s;
    json["peak_memory_bytes"] = static_cast<long long>(peak_memory_bytes());
    json["stages"] = {{"refresh", t.refresh}, {"evaluate", t.evaluate}, {"force", t.force},    {"setup", t.setup},
                      {"solve", t.solve},     {"cut", t.cut},           {"measure", t.measure}};
}

void put_contact_and_energy(ordered_json& json, const RunTotals& totals) {
    const StepEnergy& e = totals.energy;
    json["contacts_most"] = totals.contacts_most;
    json["contact_stiffness"] = totals.contact_stiffness;
    json["energy"] = {{"kinetic", e.kinetic},
                      {"gravity", e.gravity},
                      {"elastic", e.elastic},
                      {"contact", e.contact},
                      {"dissipated_material", e.dissipated_material},
                      {"dissipated_friction", e.dissipated_friction},
                      {"dissipated_contact", e.dissipated_contact},
                      {"dissipated_integrator", e.dissipated_integrator},
                      {"residual_work", e.residual_work},
                      {"work", e.work},
                      {"closure", e.closure()}};
}

void put_measures(ordered_json& json, const Measures& m) {
    json["intersections"] = m.intersections;
    json["deepest_penetration"] = m.deepest_penetration;
    json["smallest_distance"] = m.smallest_distance;
    json["worst_frame"] = m.worst_frame < 0 ? ordered_json(nullptr) : ordered_json(m.worst_frame);
    json["largest_strain"] = m.largest_strain;
    json["speed_at_end"] = m.speed_at_end;
    json["rms_speed_at_end"] = m.rms_speed_at_end;
    json["energy_gain"] = m.energy_gain;
    json["lowest_vertex"] = m.lowest_vertex;
    if (m.largest_seam_gap) json["largest_seam_gap"] = *m.largest_seam_gap;
    if (m.matches) json["matches"] = *m.matches;
}

ordered_json rest_figures(const Scene& scene, const RestFigures& rest) {
    const bool known = rest.fastest_cloth >= 0;
    return {{"at_rest", rest.at_rest},
            {"time_s", rest.time},
            {"largest_speed", rest.largest_speed},
            {"rms_speed", rest.rms_speed},
            {"fastest_cloth", known ? ordered_json(scene.cloths[static_cast<std::size_t>(rest.fastest_cloth)].name) : nullptr},
            {"force_over_weight", rest.force_over_weight}};
}

ordered_json step_certificate(const Measures& measures) {
    if (!measures.steps) return nullptr;
    const StepChecks& checks = *measures.steps;
    const bool near = checks.worst_step >= 0;
    return {{"states", checks.states},
            {"intersections", checks.intersections},
            {"deepest_penetration", checks.deepest_penetration},
            {"smallest_distance", checks.smallest_distance},
            {"worst_step", near ? ordered_json(checks.worst_step) : ordered_json(nullptr)},
            {"worst_time_s", near ? ordered_json(checks.worst_time) : ordered_json(nullptr)}};
}

ordered_json expectation_list(std::span<const ExpectationResult> results) {
    ordered_json list = ordered_json::array();
    for (const ExpectationResult& result : results) {
        ordered_json entry = {{"measure", result.expectation.measure},
                              {"value", result.value ? ordered_json(*result.value) : ordered_json(nullptr)},
                              {"limit", limit_text(result.expectation)},
                              {"passed", result.passed},
                              {"text", result.text}};
        if (result.expectation.at) entry["at"] = *result.expectation.at;
        if (result.expectation.during) entry["during"] = *result.expectation.during;
        list.push_back(entry);
    }
    return list;
}

ordered_json frame_list(std::span<const FrameRecord> frames) {
    ordered_json list = ordered_json::array();
    for (const FrameRecord& frame : frames)
        list.push_back({{"index", frame.index},
                        {"time", frame.time},
                        {"cloths", frame.cloths},
                        {"obstacles", frame.obstacles},
                        {"others", frame.others},
                        {"intersections", frame.check.intersections},
                        {"crossings_at_seams", frame.check.at_seams},
                        {"deepest_penetration", frame.check.deepest_penetration},
                        {"smallest_distance", frame.check.smallest_distance},
                        {"self_contact", frame.meeting}});
    return list;
}

ordered_json obstacle_list(const BuiltScene& built) {
    ordered_json list = ordered_json::array();
    const std::vector<CleaningReport> reports = cleaning_of(built);
    for (std::size_t i = 0; i < built.obstacle_meshes.size(); ++i) {
        const CleaningReport& cleaning = reports[i];
        const Vec3 force = built.simulation.force_on(built.obstacles[i]);
        list.push_back({{"name", built.scene.obstacles[i].name},
                        {"contact_force", {force.x(), force.y(), force.z()}},
                        {"triangles", cleaning.triangles},
                        {"merged_vertices", cleaning.merged_vertices},
                        {"degenerate_triangles", cleaning.degenerate_triangles},
                        {"duplicate_triangles", cleaning.duplicate_triangles},
                        {"unreferenced_vertices", cleaning.unreferenced_vertices},
                        {"internal_triangles", cleaning.internal_triangles}});
    }
    return list;
}

/// How each cloth sits at the end, by its name.
ordered_json fit_list(const BuiltScene& built) {
    ordered_json list = ordered_json::object();
    const auto fits = fit_now(built);
    for (std::size_t i = 0; i < fits.size(); ++i) {
        ordered_json& cloth = list[built.scene.cloths[i].name];
        for (const auto& [name, spread] : fits[i])
            cloth[name] = {{"smallest", spread.smallest},
                           {"median", spread.median},
                           {"of_95_percent", spread.of_95_percent},
                           {"largest", spread.largest}};
    }
    return list;
}

/// How far apart the stitches of a seam are at the end, in the order of their gaps: median, 95 %, largest.
ordered_json seam_list(const BuiltScene& built) {
    ordered_json list = ordered_json::array();
    for (const BuiltSeam& seam : built.seams) {
        std::vector<double> gaps = built.simulation.seam_gaps(seam.id);
        const auto worst = std::max_element(gaps.begin(), gaps.end()) - gaps.begin();
        ordered_json stitches = ordered_json::array();
        for (const auto& [vertex, from, to, share] : seam.sewn.stitches) stitches.push_back({vertex, from, to, share});
        std::sort(gaps.begin(), gaps.end());
        const auto [first, second] = seam.sewn.cloths;
        list.push_back({{"name", seam.name},
                        {"cloths", {first, second}},
                        {"median_gap", gaps[gaps.size() / 2]},
                        {"gap_of_95_percent", gaps[(95 * (gaps.size() - 1)) / 100]},
                        {"largest_gap", gaps.back()},
                        {"widest_stitch", worst},
                        {"stitches", std::move(stitches)}});
    }
    return list;
}

ordered_json start_move_list(const Simulation& simulation) {
    ordered_json list = ordered_json::array();
    for (const StartMove& move : simulation.start_repair())
        list.push_back({{"cloth", move.cloth_name},
                        {"obstacle", move.obstacle_name},
                        {"vertices_moved", move.vertices_moved},
                        {"largest_move", move.largest_move}});
    return list;
}

ordered_json pinch_list(const BuiltScene& built, std::span<const Pinch> pinches) {
    ordered_json list = ordered_json::array();
    const auto name = [&](int number) { return built.scene.obstacles[static_cast<std::size_t>(number)].name; };
    for (const Pinch& pinch : pinches)
        list.push_back({{"obstacles", {name(pinch.obstacles[0]), name(pinch.obstacles[1])}},
                        {"from", pinch.from},
                        {"to", pinch.to},
                        {"yielded", pinch.yielded}});
    return list;
}

}  // namespace

std::vector<Finding> end_warnings(const BuiltScene& built, const RunResult& result) {
    std::vector<Finding> warnings = strain_warnings(built, result.measures.largest_strain);
    const bool on_body = std::ranges::any_of(built.scene.obstacles, [](const ObstacleSpec& o) { return !o.mesh.empty(); });
    if (result.status == RunStatus::finished && on_body && result.totals.contacts_most > 0)
        append_findings(tight_warnings(built, "pose.scale"), warnings);
    append_findings(seam_warnings(built), warnings);
    return warnings;
}

std::vector<Finding> run_findings(const BuiltScene& built, const RunResult& result) {
    std::vector<Finding> found = start_findings(built);
    append_findings(plan_findings(built, result.plan), found);
    for (const Pinch& pinch : result.totals.pinches) found.push_back(pinch_warning(pinch, built.scene));
    append_findings(end_warnings(built, result), found);
    return found;
}

std::string run_report_text(const BuiltScene& built, const RunResult& result, std::span<const FrameRecord> frames,
                            std::span<const ExpectationResult> expectations) {
    ordered_json json;
    const RunVerdict verdict = verdict_of_run(result);
    json["status"] = verdict.word;
    if (!verdict.well()) json["reason"] = verdict.reason;
    if (!result.resumed_at.empty()) json["resumed_at_s"] = result.resumed_at;
    json["title"] = built.scene.title;
    json["scene"] = built.scene.file;
    if (result.rest) json["rest"] = rest_figures(built.scene, *result.rest);
    put_counts(json, result.totals);
    put_costs(json, result.totals);
    json["obstacles"] = obstacle_list(built);
    json["seams"] = seam_list(built);
    const bool fits = !built.scene.output.fields.empty() && result.status != RunStatus::stopped;  // a signal is not kept waiting
    if (fits) json["fit"] = fit_list(built);
    json["start_repair"] = start_move_list(built.simulation);
    json["pinched"] = pinch_list(built, result.totals.pinches);
    json["scheme"] = result.plan.scheme_word;
    if (!result.plan.scheme_reason.empty()) json["scheme_reason"] = result.plan.scheme_reason;
    const std::vector<Finding> findings = run_findings(built, result);
    // What the start moved is in start_repair.
    json["warnings"] = finding_texts(std::span(findings).subspan(built.simulation.start_repair().size()));
    json["findings"] = findings;
    json["skipped"] = result.plan.skipped;
    put_contact_and_energy(json, result.totals);
    put_measures(json, result.measures);
    json["step_certificate"] = step_certificate(result.measures);
    json["expectations"] = expectation_list(expectations);
    json["settings"] = ordered_json::parse(settings_text(built.scene));
    json["version"] = version;
    json["frames"] = frame_list(frames);
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

namespace {

double number_or_infinity(const ordered_json& value) {
    return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

FrameRecord frame_record(const ordered_json& json) {
    FrameRecord record;
    record.index = json.at("index").get<int>();
    record.time = json.at("time").get<double>();
    record.cloths = json.at("cloths").get<std::vector<std::string>>();
    record.obstacles = json.at("obstacles").get<std::vector<std::string>>();
    record.check.intersections = json.at("intersections").get<int>();
    record.check.deepest_penetration = json.at("deepest_penetration").get<double>();
    record.check.smallest_distance = number_or_infinity(json.at("smallest_distance"));
    // Reports of builds with one format of frames, or without contact between cloths, lack them.
    if (json.contains("others")) record.others = json.at("others").get<std::vector<std::string>>();
    if (json.contains("self_contact")) record.meeting = json.at("self_contact").get<PairsOfCloths>();
    return record;
}

ClothStitches seam_record(const ordered_json& json) {
    ClothStitches seam;
    seam.cloths = json.at("cloths").get<std::array<int, 2>>();
    for (const ordered_json& stitch : json.at("stitches")) {
        seam.stitches.push_back(
            {stitch.at(0).get<int>(), stitch.at(1).get<int>(), stitch.at(2).get<int>(), stitch.at(3).get<double>()});
    }
    return seam;
}

/// What `read` makes of the report in a run's folder.
template <class Read>
auto read_report(const std::string& folder, Read read) {
    const std::string file = folder + "/report.json";
    std::ifstream in = open_input(file);
    if (!in) throw SceneError(file + ": cannot be read; a folder written by `percale run` holds it");
    try {
        return read(ordered_json::parse(in));
    } catch (const ordered_json::parse_error& error) {
        throw SceneError(file + ": is not the report of a run: it is no JSON from its byte " + std::to_string(error.byte) +
                         " on");
    } catch (const ordered_json::exception&) {
        throw SceneError(file + ": is not the report of a run: its 'frames' are not those that `percale run` lists");
    }
}

}  // namespace

std::vector<FrameRecord> read_frame_records(const std::string& folder) {
    return read_report(folder, [](const ordered_json& json) {
        std::vector<FrameRecord> records;
        for (const ordered_json& frame : json.at("frames")) records.push_back(frame_record(frame));
        return records;
    });
}

std::vector<ClothStitches> read_seam_records(const std::string& folder) {
    return read_report(folder, [](const ordered_json& json) {
        std::vector<ClothStitches> seams;
        // Reports of earlier builds lack it.
        if (!json.contains("seams")) return seams;
        for (const ordered_json& seam : json.at("seams")) seams.push_back(seam_record(seam));
        return seams;
    });
}

std::string read_report_text(const std::string& folder) {
    return read_report(folder, [](const ordered_json& json) {
        for (const ordered_json& frame : json.at("frames")) frame_record(frame);
        return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    });
}

}  // namespace percale::scenes
