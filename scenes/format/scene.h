#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/finding.h"
#include "common/source_place.h"
#include "frames/frame_formats.h"
#include "percale/fabric.h"
#include "percale/mesh.h"
#include "percale/settings.h"
#include "percale/stitch.h"
#include "shapes/primitives.h"

// What a scene file says, as plain data: nothing is read from disk or checked against meshes here.
namespace percale::scenes {

/// Largest coordinates and times of a scene.
inline constexpr double max_coordinate = 1e6;  // m
inline constexpr double max_time = 1e6;        // s

struct GridSpec {
    std::array<double, 2> size = {1.0, 1.0};  // m
    std::array<int, 2> vertices = {2, 2};     // columns, rows
};

/// Vertices of one cloth: by index, inside a box given in fractions of the rest shape's bounding box, or the whole boundary.
struct VertexIndices {
    std::vector<int> vertices;
};
struct VertexBox {
    Vec3 lowest = Vec3::Zero(), highest = Vec3::Ones();
    std::string to = {};  // obstacle on which pins keep their place; "": in the world
};
struct VertexBoundary {};
using VertexSelection = std::variant<VertexIndices, VertexBox, VertexBoundary>;

/// Direction of warp: in uv (two numbers, "u" or "v"), or in the axes of the mesh without strain.
struct Warp {
    Vec3 direction = Vec3::UnitX();
    bool in_uv = false;
};

struct ClothSpec {
    std::string name;
    std::string fabric;
    std::optional<GridSpec> grid;  // exactly one of grid, mesh and pattern
    std::string mesh;              // path relative to the scene file
    double unit = 1.0;             // m per unit of the mesh file
    std::string part;              // object or group of it that is taken alone; "": all
    double weld = 0.0;             // m, vertices of it so near become one
    std::string rest;              // path of a mesh without strain, or "uv": the mesh's vt; empty: as it starts
    double uv_scale = 1.0;         // m per unit of vt
    std::optional<Warp> warp;
    Pose pose;
    VertexSelection pin = VertexIndices{};
    std::string pattern;        // path of a sewing pattern
    double edge_length = 0.02;  // m, of its mesh
    double panel_offset = 0.0;  // m, by which its panels start farther out than their layer does
    int layer = 0;              // where it is worn, from the inside out
    SourcePlace pin_place;      // of `pin`; of the cloth where that is not said
    SourcePlace place;
};

/// Whether a vertex of it is pinned at the start.
inline bool has_pins(const ClothSpec& cloth) {
    const auto* indices = std::get_if<VertexIndices>(&cloth.pin);
    return indices == nullptr || !indices->vertices.empty();
}

/// Whether some of its pins stay where they are, and belong to no obstacle.
inline bool has_pins_in_world(const ClothSpec& cloth) {
    const auto* box = std::get_if<VertexBox>(&cloth.pin);
    return has_pins(cloth) && (box == nullptr || box->to.empty());
}

/// One keyframe; what it does not say stays as the previous one (the first: as the pose) has it.
struct Keyframe {
    double time = 0.0;  // s
    std::optional<Vec3> translation;
    std::optional<Rotation> rotation;
};

struct Spin {
    Vec3 axis = Vec3::UnitY();
    double turns_per_s = 0.0;
    double from = 0.0;  // s
};

struct ObstacleSpec {
    std::string name;
    std::string mesh;  // exactly one of mesh and shape
    Shape shape;
    double unit = 1.0;
    std::string part;
    double weld = 0.0;  // m
    double friction = default_friction;
    double restitution = 0.0;
    Pose pose;
    std::vector<Keyframe> motion;  // ascending times
    std::optional<Spin> spin;
    std::optional<std::array<int, 2>> frames;   // first and last number of the files that `mesh` names by %d
    std::string cache;                          // file with the vertices of `mesh` at many times
    std::optional<std::string> clip;            // animation of `mesh`
    std::optional<double> fps;                  // 1/s, of frames and of a cache without times; without 30
    std::string start_mesh;                     // what it is before it plays; "": see lead_in
    double lead_in = 0.0;                       // s, from its start to the first shape of what is played
    double play_from = 0.0, play_offset = 0.0;  // s, when it begins to play, and where in what is played
    bool loop = false;
    bool yields = false;  // on_pinch
    SourcePlace place;

    bool bends() const { return frames || !cache.empty() || clip; }
    static constexpr double usual_fps = 30.0;
};

/// Vertices sewn to vertices, or to points between two.
struct SeamSpec {
    std::string name;                                         // for messages; "" = its number
    std::optional<std::array<std::string, 2>> cloths;         // without, the only one with itself
    std::optional<std::vector<std::array<int, 2>>> vertices;  // of the first and of the second cloth
    std::optional<std::vector<Stitch>> points;                // likewise
    std::string file;                                         // of more, relative to the scene file; "mesh": that of the cloth
    double start_time = 0.0;                                  // s, when closing begins
    double duration = 1.0;                                    // s, of closing
    double stiffness = 1000.0;                                // N/m
    bool contact_while_closing = true;
    bool weld = false;
    SourcePlace place;
};

/// What two cloths, or a cloth with itself, are to each other.
struct PairSpec {
    std::array<std::string, 2> cloths;
    bool contact = true;
    std::optional<double> thickness;  // m
    SourcePlace place;
};

struct PinEvent {
    std::string cloth;
    VertexSelection vertices;
};
struct UnpinEvent {
    std::string cloth;
    VertexSelection vertices;
};
struct MoveEvent {
    std::string cloth;
    VertexSelection vertices;
    Vec3 to = Vec3::Zero();  // m, displacement
    double over = 0.0;       // s, > 0
};
struct GravityEvent {
    Vec3 gravity = Vec3::Zero();
};
struct WindEvent {
    Vec3 wind = Vec3::Zero();  // m/s
};
struct EventSpec {
    double time = 0.0;  // s
    std::variant<PinEvent, UnpinEvent, MoveEvent, GravityEvent, WindEvent> what;
    SourcePlace place;
};

/// One line of [expect]: the measure must lie in [lowest, highest]; `matches` carries a file, too.
struct Expectation {
    std::string measure;
    double lowest = 0.0, highest = 0.0;
    bool lowest_included = true, highest_included = true;
    std::string file;  // matches: path relative to the scene file
    SourcePlace place;
    std::optional<double> at = {};                     // s, looked at then alone
    std::optional<std::array<double, 2>> during = {};  // s, looked at from then to then
};

struct OutputSpec {
    std::vector<std::string> frames = {"obj"};  // words of frame_words(); no_frames alone
    double fps = 30.0;
    std::vector<std::string> fields = {};  // some of fit_words: what frames hold of cloth besides its shape

    bool writes_frames() const { return frames != std::vector<std::string>{no_frames}; }
};

enum class Detector { fcl, bullet, brute_force, none };
/// How a scene file writes each Detector, in the order of the enumeration.
inline constexpr std::array<std::string_view, 4> detector_words = {"fcl", "bullet", "brute_force", "none"};
inline constexpr std::string_view word_of(Detector detector) { return detector_words[static_cast<std::size_t>(detector)]; }

struct Scene {
    std::string file;  // as given; "" for a scene made in memory
    std::string title;
    double duration = 1.0;            // s; idle if it ends at rest
    bool until_rest = false;          // ends when all cloth is proven at rest
    double max_duration = 20.0;       // s, if it ends at rest: by then, or it has failed
    SourcePlace duration_place;       // of `duration`; of the whole file where that is not said
    StepSettings step{.threads = 0};  // gravity included; as many threads as pay
    SourcePlace scheme_place;         // of step.scheme; of the whole file where that is not said
    Detector detector = Detector::fcl;
    std::map<std::string, Fabric> fabrics;
    std::set<std::string> preset_moduli;  // names of fabrics whose stretch and shear stiffness are those of their preset
    std::vector<ClothSpec> cloths;
    std::vector<ObstacleSpec> obstacles;
    std::vector<SeamSpec> seams;
    std::vector<PairSpec> pairs;
    std::vector<EventSpec> events;  // ascending times
    std::vector<Expectation> expectations;
    OutputSpec output;
    std::vector<Finding> warnings;  // what has to be changed in its file

    /// The latest time at which it ends, s.
    double latest_end() const { return until_rest ? max_duration : duration; }
    /// Whether this cloth meets itself and other such cloth.
    bool meets_cloth(const ClothSpec& cloth) const {
        const auto found = fabrics.find(cloth.fabric);
        return found != fabrics.end() && found->second.self_contact;
    }
    /// Whether events pin, let go or move vertices of it.
    bool pins_have_events(const ClothSpec& cloth) const {
        const auto names = [&](const auto& what) {
            if constexpr (requires { what.cloth; }) return what.cloth == cloth.name;
            return false;
        };
        return std::ranges::any_of(events, [&](const EventSpec& event) { return std::visit(names, event.what); });
    }
    /// Whether the cloth has a pressure or holds gas.
    bool is_filled(const ClothSpec& cloth) const {
        const auto found = fabrics.find(cloth.fabric);
        return found != fabrics.end() && (found->second.pressure || found->second.gas_volume);
    }
    /// The first cloth that meets itself and other such cloth; null: none.
    const ClothSpec* cloth_that_meets_cloth() const {
        for (const ClothSpec& cloth : cloths)
            if (meets_cloth(cloth)) return &cloth;
        return nullptr;
    }
    /// Whether anything can come into contact at all.
    bool has_contact() const { return !obstacles.empty() || cloth_that_meets_cloth() != nullptr; }
};

}  // namespace percale::scenes
