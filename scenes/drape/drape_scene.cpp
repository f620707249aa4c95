#include "drape/drape_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "common/bounds.h"
#include "common/length_unit.h"
#include "common/text.h"
#include "common/whole_file.h"
#include "doctor/doctor_scene.h"
#include "meshes/mesh_import.h"
#include "meshes/stitch_file.h"
#include "pattern/pattern_parts.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

/// A body that is by this factor taller along z than along y stands along z. Smaller: spheres and beds do. Larger: people do not.
/// A flat thing, less deep along y than this fraction of its size, lies there and does not stand.
constexpr double standing_ratio = 1.5, min_standing_depth = 0.05;

/// A garment of more m (`min_huge_garment`) and of more times the body's size (`huge_garment_ratio`) is in another unit than
/// m: in the one that makes it nearest to `garment_ratio` of the body. Smaller: tablecloths over cups are taken for centimetres.
/// Larger: a hat in centimetres is not.
constexpr double min_huge_garment = 8.0, huge_garment_ratio = 5.0, garment_ratio = 0.6;

/// How a pattern is sewn.
constexpr double sewing_stiffness = 3000.0;  // N/m
/// The damping of a preset, with which hems come to rest within seconds.
constexpr double sewing_damping = 0.02;  // s
/// A preset's moduli hold on patterns; on meshes without a direction of warp they are made isotropic, with a warning.
constexpr const char *mesh_fabric = "mesh", *sewn_mesh_fabric = "sewn mesh", *pattern_fabric = "pattern";

bool is_pattern(const std::string& garment) {
    const std::string extension = extension_of(garment);
    return extension == ".toml" || extension == ".json";
}

/// The name of its file, with a number if another garment has that name.
std::string garment_name(const std::string& file, const Scene& scene) {
    const std::string stem = std::filesystem::path(file).stem().string();
    std::string name = stem;
    for (int number = 2; std::ranges::find(scene.cloths, name, &ClothSpec::name) != scene.cloths.end(); ++number)
        name = stem + " " + std::to_string(number);
    return name;
}

/// Largest edges of a mesh's bounding box, in its unit; 0 where it cannot be read, which building the scene refuses.
Vec3 extent_of(const std::string& file, const std::string& part) {
    try {
        return Bounds(import_mesh(file, 1.0, nullptr, part).vertices).extent();
    } catch (const SceneError&) {
        return Vec3::Zero();
    }
}

class DrapeScenes {
public:
    explicit DrapeScenes(const DrapeOptions& options) : options_(options) {}

    DrapeScene make() {
        set_up();
        add_fabrics();
        const Vec3 body = extent_of(options_.body(), options_.body_part);
        guess_up(body);
        body_unit_ = unit_of(options_.body(), options_.body_unit, "--body-unit", extent_of(options_.body(), "").maxCoeff(), 0.0);
        body_size_ = body_unit_ * body.maxCoeff();
        for (const std::string& file : options_.garments()) add_garment(file);
        refuse_short_time();
        add_body();
        ask_doctor();
        return std::move(made_);
    }

private:
    void note(const std::string& kind, const std::string& file, const std::string& what) {
        made_.findings.push_back(finding(kind, {file}, file + what, {}, Severity::note));
    }

    void set_up() {
        Scene& scene = made_.scene;
        scene.file = "drape";
        scene.until_rest = true;
        scene.max_duration = options_.seconds;
        scene.step.kinetic_damping = true;
        scene.step.rest_speed = options_.still;
    }

    void add_fabrics() {
        Fabric fabric = options_.fabric;
        fabric.self_contact = !options_.no_self_contact;
        made_.scene.fabrics[mesh_fabric] = fabric;
        if (options_.damps_patterns) {
            fabric.damping_time = sewing_damping;
            fabric.spring_damping = 0.0;
        }
        made_.scene.fabrics[pattern_fabric] = made_.scene.fabrics[sewn_mesh_fabric] = fabric;
        if (!options_.preset.empty()) made_.scene.preset_moduli = {mesh_fabric, sewn_mesh_fabric};
    }

    void refuse_short_time() const {
        const double sewn = sewing_end(made_.scene);
        if (options_.seconds > sewn) return;
        throw SceneError("--seconds " + short_number(options_.seconds) + ": sewing alone takes " + short_number(sewn) + " s, " +
                         short_number(options_.sewing_time) + " s for each garment; it must be more");
    }

    void guess_up(const Vec3& body) {
        made_.z_up = options_.up.empty() ? stands_along_z(body) : options_.up == "z";
        if (made_.z_up && options_.up.empty())
            note("guessed_up", options_.body(), " stands along z, so z is taken as up in the meshes (--up y, if y is)");
        // From z up to y up: a quarter turn about x.
        if (made_.z_up) turn_ = {.w = std::sqrt(0.5), .x = -std::sqrt(0.5)};
    }

    /// The unit of a file, m. A `body` of 0 m says nothing about the size.
    double unit_of(const std::string& file, const std::string& said, const char* option, double extent, double body) {
        if (!said.empty()) return metres_of_unit(said).value();
        const std::string unit = guessed_unit(extent, body);
        if (unit != "m")
            note("guessed_unit", file,
                 " is " + short_number(extent) + " units large" +
                     (body > 0.0 ? " and the body " + short_number(body) + " m" : "") + ", so its unit is taken as " + unit +
                     ", which makes it " + short_number(*metres_of_unit(unit) * extent) + " m (" + option +
                     " m, if it is m); what is written is in m");
        return *metres_of_unit(unit);
    }

    void add_garment(const std::string& file) {
        ClothSpec cloth;
        cloth.name = garment_name(file, made_.scene);
        cloth.place = {.file = file};
        const auto& [x, y, z] = options_.move;
        cloth.pose.translation = made_.z_up ? Vec3(x, z, -y) : Vec3(x, y, z);
        cloth.pose.scale = options_.scale;
        const Rotation back{turn_.w, -turn_.x, -turn_.y, -turn_.z};
        cloth.pose.rotation = product(product(turn_, turned(options_.rotate)), back);  // about the meshes' axes
        cloth.layer = static_cast<int>(made_.scene.cloths.size());
        if (is_pattern(file)) {
            add_pattern(cloth);
        } else {
            add_mesh(cloth);
        }
    }

    void add_mesh(ClothSpec& cloth) {
        const std::string& file = cloth.place.file;
        cloth.mesh = file;
        cloth.part = options_.garment_part;
        cloth.unit = unit_of(file, options_.garment_unit, "--garment-unit", extent_of(file, "").maxCoeff(), body_size_);
        cloth.pose.rotation = product(cloth.pose.rotation, turn_);
        std::size_t stitches = extension_of(file) == ".obj" ? find_obj_stitches(file).size() : 0;
        if (stitches > 0 && !cloth.part.empty()) {
            note("unsewn_part", file, " has stitches, which count all its vertices: with --garment-part it is not sewn");
            stitches = 0;
        }
        cloth.fabric = stitches > 0 ? sewn_mesh_fabric : mesh_fabric;
        if (stitches == 0)
            cloth.weld = options_.weld;
        else if (options_.weld > 0.0)
            note("not_welded", file, " has stitches, which count all its vertices: --weld leaves it as it is");
        if (stitches > 0) {
            note("stitches", file, " has " + std::to_string(stitches) + " stitches, by which it is sewn");
            add_seam(cloth, false);  // gathers of others are sewn at every vertex, and a weld would press their edges together
        }
        made_.scene.cloths.push_back(cloth);
    }

    void add_pattern(ClothSpec& cloth) {
        if (!options_.garment_unit.empty()) throw SceneError("--garment-unit: a pattern says its own unit");
        if (!options_.garment_part.empty()) throw SceneError("--garment-part: a pattern has no objects or groups");
        cloth.fabric = pattern_fabric;
        cloth.pattern = cloth.place.file;
        cloth.edge_length = options_.edge_length;
        add_seam(cloth, options_.weld_seams);
        made_.scene.cloths.push_back(cloth);
    }

    /// A garment is sewn after those below it, without gravity.
    void add_seam(const ClothSpec& cloth, bool weld) {
        Scene& scene = made_.scene;
        scene.step.gravity = Vec3::Zero();
        SeamSpec seam;
        seam.cloths = {cloth.name, cloth.name};
        seam.file = "mesh";
        seam.start_time = options_.sewing_time * static_cast<double>(scene.seams.size());
        seam.duration = options_.sewing_time;
        seam.stiffness = sewing_stiffness;
        seam.contact_while_closing = false;
        seam.weld = weld;
        seam.place = cloth.place;
        scene.seams.push_back(seam);
    }

    void add_body() {
        ObstacleSpec body;
        body.name = "body";
        body.mesh = options_.body();
        body.part = options_.body_part;
        body.weld = options_.weld;
        body.unit = body_unit_;
        body.pose.rotation = turn_;
        body.friction = options_.friction;
        body.place = {.file = options_.body()};
        made_.scene.obstacles.push_back(body);
    }

    /// Takes over the warnings of the doctor; errors are refused when the scene is built. Where the mesh itself has to be mended,
    /// they say how.
    void ask_doctor() {
        const auto among = [](const Finding& finding, std::initializer_list<std::string_view> kinds) {
            return std::ranges::find(kinds, finding.kind) != kinds.end();
        };
        for (Finding& finding : examine_scene_meshes(made_.scene)) {
            const bool of_cloth = finding.role == MeshRole::cloth, sewn = !made_.scene.seams.empty();
            const bool open = of_cloth && !sewn && among(finding, {"repeated_places", "near_rims"});
            made_.comes_apart = made_.comes_apart || open;
            const bool parts = of_cloth && finding.kind == "parts";
            if (!parts && finding.severity != Severity::warning) continue;
            if (parts)
                finding.fix = "--garment-part takes one object or group of a file alone";
            else if (!among(finding, {"repeated_places", "near_rims", "pinched_vertices", "slivers", "edge_lengths"}))
                finding.fix.clear();
            made_.findings.push_back(std::move(finding));
        }
    }

    const DrapeOptions& options_;
    DrapeScene made_;
    Rotation turn_ = {};
    double body_unit_ = 1.0, body_size_ = 0.0;  // m
};

}  // namespace

void check_drape(const DrapeOptions& options) {
    for (const auto& [option, unit] : {std::pair("--garment-unit", options.garment_unit), {"--body-unit", options.body_unit}}) {
        if (!unit.empty() && !metres_of_unit(unit))
            throw SceneError(std::string(option) + " " + unit + ": must be mm, cm, dm, m or inch");
    }
    if (!options.up.empty() && options.up != "y" && options.up != "z")
        throw SceneError("--up " + options.up + ": must be y or z");
    if (!(options.weld >= 0.0 && options.weld <= max_weld))
        throw SceneError("--weld: is outside the allowed range 0 ... " + short_number(max_weld) + " m");
    if (!(options.scale >= 0.01 && options.scale <= 100.0))
        throw SceneError("--scale: is outside the allowed range 0.01 ... 100");
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
        for (const std::string& file : options.files) {
            std::error_code missing;
            if (std::filesystem::equivalent(file, out, missing))
                throw SceneError("-o " + out + ": would overwrite " + file + ", which is read");
        }
        const WholeFile probe(out);  // an output that cannot be written is found before the work, not after it
    }
}

std::string guessed_unit(double extent, double body) {
    if (body <= 0.0) {
        if (extent >= millimetre_extent) return "mm";
        return extent >= centimetre_extent ? "cm" : "m";
    }
    if (extent < min_huge_garment || extent < huge_garment_ratio * body) return "m";
    const auto misfit = [&](const char* unit) {
        return std::abs(std::log(*metres_of_unit(unit) * extent / (garment_ratio * body)));
    };
    return misfit("cm") <= misfit("mm") ? "cm" : "mm";
}

bool stands_along_z(const Vec3& extent) {
    return extent.z() > standing_ratio * extent.y() && extent.y() > min_standing_depth * extent.maxCoeff();
}

DrapeScene drape_scene(const DrapeOptions& options) { return DrapeScenes(options).make(); }

double sewing_end(const Scene& scene) {
    return scene.seams.empty() ? 0.0 : scene.seams.back().start_time + scene.seams.back().duration;
}

std::vector<double> sewing_times(const DrapeOptions& options) {
    std::vector<double> times = {options.sewing_time};
    for (const double other : {2.0 * options.sewing_time, 0.6 * options.sewing_time}) {
        if (other * static_cast<double>(options.garments().size()) < options.seconds) times.push_back(other);
    }
    return times;
}

}  // namespace percale::scenes
