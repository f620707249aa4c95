#pragma once

#include <array>
#include <atomic>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/expectations.h"
#include "format/scene.h"
#include "garment/seam_stitches.h"
#include "percale/certify.h"
#include "percale/simulation.h"

// What a run is judged by: collected over its steps and its output frames.
namespace percale::scenes {

/// What the certificates of one output frame say together, over all pairs of cloth and obstacle and cloth that meets cloth.
struct FrameCheck {
    int intersections = 0;  // intersecting triangle pairs
    int touching_pairs = 0;
    int at_seams = 0;                  // crossing pairs of triangles that a stitch joins; not among the intersections
    int vertices_inside = 0;           // of watertight obstacles
    double deepest_penetration = 0.0;  // m
    double smallest_distance = std::numeric_limits<double>::infinity();  // m; infinity if nothing was near

    bool clean() const { return intersections == 0 && vertices_inside == 0; }
};

void add_certificate(FrameCheck& check, const Certificate& certificate);
/// Distances between cloths are not measured.
void add_cloth_certificate(FrameCheck& check, const ClothCertificate& certificate);

/// Pairs of cloths by their numbers, of a cloth with itself, too: first <= second, in ascending order.
using PairsOfCloths = std::vector<std::array<int, 2>>;
PairsOfCloths all_pairs(int cloths);

/// The cloths that meet any, as one mesh, with what certify_cloth needs to know of it.
struct MeetingMesh {
    TriangleMesh mesh;
    std::vector<int> owner;  // the cloth of each triangle
    std::vector<Stitch> stitches;
    ClothPairs pairs;
};
MeetingMesh joined_meeting_cloth(std::span<const TriangleMesh> cloths, std::span<const ClothStitches> seams,
                                 std::span<const std::array<int, 2>> meeting);

/// What the certificates of all states say, one after each step and one of the start.
struct StepChecks {
    int states = 0;
    int intersections = 0;                                               // pairs, summed
    double deepest_penetration = 0.0;                                    // m
    double smallest_distance = std::numeric_limits<double>::infinity();  // m; infinity if nothing was near
    int worst_step = -1;      // after which the distance was smallest, 0 = the start; -1: nothing was near
    double worst_time = 0.0;  // s, of that state
    FrameCheck worst;         // of that state
};

/// `step`: 0 is the start. Of two states with equal distances (0 where both intersect) the one with more intersecting pairs is
/// the worse.
void add_state(StepChecks& checks, int step, double time, const FrameCheck& check);

/// A period in which obstacles gave way to cloth that had no room between them (ObstacleSettings::yields).
struct Pinch {
    std::array<int, 2> obstacles{-1, -1};  // the first one's number first; twice the same where one pinches alone
    double from = 0.0, to = 0.0;           // s
    double yielded = 0.0;                  // m, the largest distance of an obstacle's vertex from where it should have been
};

/// An accepted step: it makes the last pinch of these obstacles longer, or is a new one. A pinch lasts until its deflections are
/// gone.
void add_pinch(std::vector<Pinch>& pinches, const StepReport& report);

/// "'arm' and 'trunk' pinched cloth; the compliant obstacle (on_pinch) gave way by up to 0.012 m, from 1.2 s to 1.7 s".
Finding pinch_warning(const Pinch& pinch, const Scene& scene);

/// The measures of a run; the names of the fields are those of scene files and reports.
struct Measures {
    int intersections = 0;                                               // summed over the frames, the start included
    double deepest_penetration = 0.0;                                    // m, largest over the frames
    double smallest_distance = std::numeric_limits<double>::infinity();  // m, over steps and frames; infinity: never near
    int worst_frame = -1;                                                // frame with the smallest distance; -1: never near
    double largest_strain = 0.0;    // (l - l0)/l0 of structural springs, over what was measured; NaN: nothing
    double strain_time = 0.0;       // s, when it was reached
    int strained_cloth = -1;        // in which cloth, in the order of the scene; -1: nothing was strained
    double speed_at_end = 0.0;      // m/s, largest of a vertex
    double rms_speed_at_end = 0.0;  // m/s, over all vertices
    double energy_gain = 0.0;       // J, largest rise in a step beyond its work; NaN: not measured
    double lowest_vertex = std::numeric_limits<double>::infinity();  // m, height at the end
    std::optional<double> matches;                                   // m, largest distance from the reference at the end
    std::optional<double> largest_seam_gap;                          // m, of a stitch at the end; nothing without seams

    FrameCheck worst;  // of the frame `worst_frame`

    std::optional<StepChecks> steps;  // if every step was certified
};

/// How still all cloth of a scene that ends at rest was in the last step that was solved.
struct RestFigures {
    bool at_rest = false;        // proven: all cloth fell asleep, and nothing was to come
    double time = 0.0;           // s, of the state they are of
    double largest_speed = 0.0;  // m/s, of a vertex at its end, before falling asleep set it to zero
    double rms_speed = 0.0;      // m/s, over all vertices
    int fastest_cloth = -1;      // in the order of the scene
    /// Largest change of a vertex's velocity in that step over that of free fall; NaN without gravity. Net force over weight.
    double force_over_weight = 0.0;
};

/// Follows the cloth of a run from step to step.
class RestWatch {
public:
    explicit RestWatch(const RestFigures& from = {}) : figures_(from) {}

    const RestFigures& figures() const { return figures_; }

    /// To be called before a step.
    void begin(const Simulation& simulation, std::span<const ClothId> cloths);
    /// To be called after it. `over`: nothing is to come. A step in which all cloth slept keeps what is known of the last one
    /// that was solved, but for time and at_rest.
    void look(const Simulation& simulation, std::span<const ClothId> cloths, const StepReport& report, const Vec3& gravity,
              bool over);

private:
    RestFigures figures_;
    std::vector<Vec3> positions_, velocities_;  // before the step, of all cloths in turn
};

/// Why a run that was not at rest at its latest end failed. `cloth`: the name of the fastest.
std::string not_at_rest_text(const RestFigures& figures, const std::string& cloth);

/// Adds a frame. Of two frames with equal distances (0 where both intersect) the one with more intersecting pairs is the worse.
void add_frame(Measures& measures, int index, const FrameCheck& check);

/// By how much the total energy rose in a step beyond its work, J, < 0 where it fell. `energy_before`: at the start of the step.
double energy_gain(const StepReport& report, double energy_before);

void add_step(Measures& measures, const StepReport& report, double energy_before);

/// Which cloth has the largest strain, if that is of the step that was added last.
void find_strained_cloth(Measures& measures, const StepReport& report, const Simulation& simulation,
                         std::span<const ClothId> cloths);

/// Speeds and heights of all cloths as they are now.
void add_end(Measures& measures, const Simulation& simulation, std::span<const ClothId> cloths);

/// Largest distance between the cloths' vertices, taken in order, and the reference's, m. The counts must be equal.
double largest_vertex_distance(const Simulation& simulation, std::span<const ClothId> cloths, std::span<const Vec3> reference);

/// Judges all expectations of a run; where one failed that is of the whole run, its text says in which cloth and when, or in
/// which frame.
std::vector<ExpectationResult> judge_run(std::span<const Expectation> expectations, const Measures& measures,
                                         std::span<const double> timed, const Scene& scene);

/// The measures by name, as expectations use them; worst_frame included, without what was not measured.
std::map<std::string, double> measure_values(const Measures& measures);

}  // namespace percale::scenes
