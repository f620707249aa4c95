#include "percale/certify.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/text.h"
#include "export/run_report.h"
#include "frames/frame_formats.h"
#include "garment/seam_stitches.h"
#include "measures/frame_certifier.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"
#include "program/commands.h"
#include "program/exit_codes.h"

namespace percale::program {

namespace {

using namespace percale::scenes;

struct CertifyOptions {
    std::vector<std::string> paths;  // DIR, or OBSTACLE FRAME...
    double distance_limit = 0.1;     // m
    bool self = false;
    bool json = false;
};

/// One time: every cloth file against every obstacle file, and those that meet each other.
struct CertifiedFrame {
    std::string label;
    std::vector<std::string> cloths, obstacles;
    PairsOfCloths meeting;  // of the cloths by number
    FrameCheck check;
    std::vector<ClothStitches> seams = {};  // between the cloths by number
};

struct Verdict {
    std::vector<CertifiedFrame> frames;
    Measures measures;
    bool clean = true;
};

/// Throws SceneError for a file of single precision or of many frames, which cannot be certified.
void check_exact(const std::string& folder, const std::string& file) {
    const std::string ending = extension_of(file);
    std::vector<std::string> exact;
    for (const FrameFormat& format : frame_formats()) {
        if (format.exact && ending == format.endings.front()) return;
        if (format.exact) exact.push_back(format.word);
    }
    throw SceneError(folder + "/" + file + ": holds no frames that can be certified, bit for bit; write one of " + joined(exact) +
                     " too, as by --frames " + exact.front() + (ending.empty() ? "" : "," + ending.substr(1)));
}

/// What a run wrote, from its report; no other word of the report is believed.
std::vector<CertifiedFrame> frames_of_run(const std::string& folder) {
    std::vector<CertifiedFrame> frames;
    for (const FrameRecord& record : read_frame_records(folder)) {
        if (record.cloths.empty()) throw SceneError(folder + ": the run wrote no frames (--frames none), so none can be checked");
        CertifiedFrame frame{"frame " + std::to_string(record.index), {}, {}, {}, {}};
        for (const std::string& file : record.cloths) check_exact(folder, file);
        for (const std::string& file : record.cloths) frame.cloths.push_back(folder + "/" + file);
        for (const std::string& file : record.obstacles) frame.obstacles.push_back(folder + "/" + file);
        frame.meeting = record.meeting;
        frames.push_back(frame);
    }
    if (frames.empty()) throw SceneError(folder + ": the report lists no frames");
    const std::vector<ClothStitches> seams = read_seam_records(folder);
    for (CertifiedFrame& frame : frames) {
        const auto there = [&](int cloth) { return cloth >= 0 && static_cast<std::size_t>(cloth) < frame.cloths.size(); };
        for (const auto& pair : frame.meeting) {
            if (!std::ranges::all_of(pair, there)) throw SceneError(folder + ": the report has contact of no cloth");
        }
        for (const ClothStitches& seam : seams) {
            if (!std::ranges::all_of(seam.cloths, there)) throw SceneError(folder + ": the report has a seam of no cloth");
        }
        frame.seams = seams;
    }
    return frames;
}

std::vector<CertifiedFrame> frames_of_files(const std::vector<std::string>& paths) {
    std::vector<CertifiedFrame> frames;
    for (std::size_t i = 1; i < paths.size(); ++i) frames.push_back({paths[i], {paths[i]}, {paths[0]}, {}, {}});
    return frames;
}

std::vector<CertifiedFrame> frames_to_check(const CertifyOptions& options) {
    if (std::filesystem::is_directory(options.paths[0])) {
        if (options.paths.size() == 1) return frames_of_run(options.paths[0]);
        throw SceneError(options.paths[0] + ": is a folder; name either one folder, or an obstacle and frames");
    }
    if (options.paths.size() == 1)
        throw SceneError(options.paths[0] + ": is not the folder of a run; name a folder, or an obstacle and frames");
    return frames_of_files(options.paths);
}

/// Obstacle meshes by file: a resting one is read once.
using MeshCache = std::map<std::string, TriangleMesh>;

const TriangleMesh& cached_mesh(MeshCache& cache, const std::string& file) {
    const auto found = cache.find(file);
    return found != cache.end() ? found->second : cache.emplace(file, import_mesh(file)).first->second;
}

void check_frame(CertifiedFrame& frame, FrameCertifier& certifier, MeshCache& cache) {
    for (auto entry = cache.begin(); entry != cache.end();) {
        const bool needed = std::find(frame.obstacles.begin(), frame.obstacles.end(), entry->first) != frame.obstacles.end();
        entry = needed ? std::next(entry) : cache.erase(entry);
    }
    std::vector<TriangleMesh> cloths, obstacles;
    for (const std::string& file : frame.cloths) cloths.push_back(import_mesh(file));
    for (const std::string& file : frame.obstacles) obstacles.push_back(cached_mesh(cache, file));
    frame.check = certifier.check({cloths, obstacles, frame.seams, frame.meeting});
}

Verdict check_frames(std::vector<CertifiedFrame> frames, double distance_limit) {
    Verdict verdict;
    verdict.frames = std::move(frames);
    MeshCache obstacles;
    std::size_t cloths = 0;
    for (const CertifiedFrame& frame : verdict.frames) cloths = std::max(cloths, frame.cloths.size());
    FrameCertifier certifier(std::vector<double>(cloths, distance_limit));
    for (std::size_t i = 0; i < verdict.frames.size(); ++i) {
        CertifiedFrame& frame = verdict.frames[i];
        check_frame(frame, certifier, obstacles);
        add_frame(verdict.measures, static_cast<int>(i), frame.check);
        verdict.clean = verdict.clean && frame.check.clean();
    }
    return verdict;
}

std::string distance_text(double distance, double limit) {
    return (std::isinf(distance) ? "beyond " + short_number(limit, 6) : short_number(distance, 6)) + " m";
}

bool has_cloth_that_meets(const Verdict& verdict) {
    return std::any_of(verdict.frames.begin(), verdict.frames.end(),
                       [](const CertifiedFrame& frame) { return !frame.meeting.empty(); });
}

bool has_obstacles(const Verdict& verdict) {
    return std::any_of(verdict.frames.begin(), verdict.frames.end(),
                       [](const CertifiedFrame& frame) { return !frame.obstacles.empty(); });
}

void print_verdict(const Verdict& verdict, double limit) {
    if (!has_obstacles(verdict) && !has_cloth_that_meets(verdict)) {
        std::printf("%zu frames and no obstacle: there is nothing to check against\n", verdict.frames.size());
        return;
    }
    for (const CertifiedFrame& frame : verdict.frames)
        std::printf("%s: %d intersecting pairs, %d vertices inside, deepest %.6g m, smallest distance %s\n", frame.label.c_str(),
                    frame.check.intersections, frame.check.vertices_inside, frame.check.deepest_penetration,
                    distance_text(frame.check.smallest_distance, limit).c_str());
    const Measures& m = verdict.measures;
    const std::string where = m.worst_frame < 0 ? "" : " (" + verdict.frames[static_cast<std::size_t>(m.worst_frame)].label + ")";
    std::printf("%s: %zu frames, %d intersecting pairs, deepest penetration %.6g m, smallest distance %s%s\n",
                verdict.clean ? "clean" : "NOT clean", verdict.frames.size(), m.intersections, m.deepest_penetration,
                distance_text(m.smallest_distance, limit).c_str(), where.c_str());
}

nlohmann::ordered_json check_object(const FrameCheck& check) {
    return {{"intersections", check.intersections},
            {"touching_pairs", check.touching_pairs},
            {"crossings_at_seams", check.at_seams},
            {"vertices_inside", check.vertices_inside},
            {"deepest_penetration", check.deepest_penetration},
            {"smallest_distance", check.smallest_distance}};
}

void print_json(const Verdict& verdict, double limit) {
    const Measures& m = verdict.measures;
    nlohmann::ordered_json json = {{"clean", verdict.clean},
                                   {"has_obstacles", has_obstacles(verdict)},
                                   {"self_contact", has_cloth_that_meets(verdict)},
                                   {"intersections", m.intersections},
                                   {"deepest_penetration", m.deepest_penetration},
                                   {"smallest_distance", m.smallest_distance},
                                   {"distance_limit", limit}};
    json["worst_frame"] = m.worst_frame < 0 ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(m.worst_frame);
    json["frames"] = nlohmann::ordered_json::array();
    for (const CertifiedFrame& frame : verdict.frames) {
        nlohmann::ordered_json entry = {{"cloths", frame.cloths}, {"obstacles", frame.obstacles}};
        entry.update(check_object(frame.check));
        json["frames"].push_back(entry);
    }
    std::printf("%s\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

int certify_files(const CertifyOptions& options) {
    if (!(options.distance_limit >= 0.0)) throw SceneError("--distance-limit: must be at least 0 m");
    std::vector<CertifiedFrame> frames = frames_to_check(options);
    for (CertifiedFrame& frame : frames)
        if (options.self) frame.meeting = all_pairs(static_cast<int>(frame.cloths.size()));
    const Verdict verdict = check_frames(std::move(frames), options.distance_limit);
    if (options.json)
        print_json(verdict, options.distance_limit);
    else
        print_verdict(verdict, options.distance_limit);
    return verdict.clean ? all_well : not_as_expected;
}

}  // namespace

void add_certify_command(CLI::App& program, Action& action) {
    auto options = std::make_shared<CertifyOptions>();
    CLI::App* command = program.add_subcommand("certify", "Check frames for intersecting triangles and depth");
    command->footer("Examples: percale certify out\n          percale certify body.obj shirt_00000.obj shirt_00001.obj");
    command->add_option("PATH", options->paths, "The folder of a run, or an obstacle and frames")->required();
    command
        ->add_option("--distance-limit", options->distance_limit, "How far to search for the smallest distance, m (default 0.1)")
        ->type_name("M");
    command->add_flag("--self", options->self,
                      "Check all cloth against itself, too; in a folder cloth with self_contact always is, once it meets cloth");
    command->add_flag("--json", options->json, "Print JSON");
    command->callback([options, &action] { action = [options] { return certify_files(*options); }; });
}

}  // namespace percale::program
