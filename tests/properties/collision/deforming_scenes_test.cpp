#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "percale/certify.h"
#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/shapes.h"

// Scenes drawn at random: obstacles whose vertices move one by one, in twists, bends, swells and waves, under one or two sheets.
// The exact certificate checks each step. PERCALE_DEFORMING_SCENES is their number (200), PERCALE_DEFORMING_FIRST the first.
namespace percale::test::deforming_scenes_test {
namespace {

/// Numbers from a seed that are the same with every standard library.
class Draws {
public:
    explicit Draws(unsigned long long seed) : engine_(seed) {}

    double number(double low, double high) { return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53); }
    double decades(double low, double high) { return std::exp(number(std::log(low), std::log(high))); }
    int index(int count) { return static_cast<int>(number(0.0, count)); }
    bool chance(double share) { return number(0.0, 1.0) < share; }
    Vec3 unit() {
        for (;;) {
            const double x = number(-1.0, 1.0), y = number(-1.0, 1.0), z = number(-1.0, 1.0);
            const Vec3 way(x, y, z);
            if (way.norm() > 0.1 && way.norm() < 1.0) return way.normalized();
        }
    }

private:
    std::mt19937_64 engine_;
};

Rotation turn_about(const Vec3& axis, double angle) {
    const Vec3 part = std::sin(0.5 * angle) * axis;
    return {std::cos(0.5 * angle), part.x(), part.y(), part.z()};
}

enum class ModeKind { twist, bend, swell, wave };

/// One smooth change of all space near the origin. None folds it: gradients of displacements stay well below 1.
struct Mode {
    ModeKind kind = ModeKind::twist;
    Vec3 along = Vec3::UnitX(), across = Vec3::UnitY();  // unit, square to each other
    double size = 0.2;                                   // m, of the body
    double amplitude = 0.0, rate = 1.0, phase = 0.0;     // rate: rad/s

    Vec3 apply(const Vec3& x, double time) const {
        const double now = amplitude * (std::sin(rate * time + phase) - std::sin(phase)), s = x.dot(along) / size;
        switch (kind) {
            case ModeKind::twist:
                return transform({.rotation = turn_about(along, 3.0 * now * s)}, x);
            case ModeKind::bend:
                return x + now * size * s * s * across;
            case ModeKind::swell:
                return (1.0 + now * std::cos(2.0 * s + phase)) * x;
            default: {
                const double there = 3.0 * s + phase;
                return x + 0.5 * amplitude * size * (std::sin(there - rate * time) - std::sin(there)) * across;
            }
        }
    }
};

/// Everything drawn for a scene.
struct Drawn {
    std::string obstacle;
    TriangleMesh body;  // undeformed, before its pose
    std::vector<Mode> modes;
    Pose pose;
    Vec3 velocity = Vec3::Zero(), axis = Vec3::UnitY();  // of the pose, m/s
    double spin = 0.0;                                   // rad/s
    ObstacleSettings settings;
    StepSettings step;
    struct Sheet {
        TriangleMesh mesh;
        Fabric fabric;
        Pose pose;
        Vec3 velocity = Vec3::Zero();
        int pins = 0;
    };
    std::vector<Sheet> sheets;

    std::vector<Vec3> shape_at(double time) const {
        std::vector<Vec3> shape = body.vertices;
        for (Vec3& x : shape) {
            for (const Mode& mode : modes) x = mode.apply(x, time);
        }
        return shape;
    }
    Pose pose_at(double time) const {
        Pose there = pose;
        there.translation += time * velocity;
        there.rotation = product(turn_about(axis, spin * time), pose.rotation);
        return there;
    }
};

void draw_body(Draws& draws, Drawn& drawn) {
    const double size = draws.number(0.08, 0.15);
    switch (draws.index(6)) {
        case 0:
            drawn.obstacle = "sphere";
            drawn.body = make_sphere(size, 2);
            break;
        case 1:
            drawn.obstacle = "box";
            drawn.body = make_box({2.0 * size, size, 1.5 * size});
            break;
        case 2:
            drawn.obstacle = "block";  // a box whose faces are divided
            drawn.body = make_sphere(size, 2);
            for (Vec3& x : drawn.body.vertices) x *= size / x.cwiseAbs().maxCoeff();
            break;
        case 3:
            drawn.obstacle = "capsule";
            drawn.body = make_capsule(0.5 * size, size, 12);
            break;
        case 4:
            drawn.obstacle = "frame";
            drawn.body = make_frame(1.3 * size, draws.decades(0.003, 0.02), 24);
            break;
        default:
            drawn.obstacle = "sheet";
            drawn.body = make_grid(3.0 * size, 3.0 * size, 9, 9);
    }
    for (int left = 1 + draws.index(3); left > 0; --left) {
        Mode mode{.kind = static_cast<ModeKind>(draws.index(4)), .along = draws.unit(), .size = size};
        mode.across = mode.along.unitOrthogonal();
        mode.amplitude = draws.number(0.05, 0.3);
        mode.rate = draws.decades(3.0, 40.0);
        mode.phase = draws.number(0.0, 2.0 * std::numbers::pi);
        drawn.modes.push_back(mode);
    }
}

Fabric draw_fabric(Draws& draws) {
    Fabric fabric;
    fabric.area_density = draws.decades(0.05, 1.0);
    fabric.thickness = draws.decades(0.002, 0.01);
    fabric.friction = draws.number(0.0, 1.0);
    fabric.springs.structural = draws.decades(50.0, 5e3);
    fabric.springs.shear = draws.number(0.0, 0.5) * fabric.springs.structural;
    fabric.springs.bend = draws.decades(1e-3, 1e-1) * fabric.springs.structural;
    fabric.self_contact = draws.chance(0.3);
    return fabric;
}

/// A sheet of 8 x 8 to 15 x 15 vertices beside the body, above it in the axes of the body's pose, somewhat within contact or
/// just out.
void draw_sheet(Draws& draws, const Fabric& fabric, double& height, Drawn& drawn) {
    const int columns = 8 + draws.index(8), rows = std::clamp(columns + draws.index(5) - 2, 8, 15);
    const double width = draws.number(0.2, 0.4);
    Drawn::Sheet sheet{.mesh = make_grid(width, width * rows / columns, columns, rows), .fabric = fabric, .pose = {}};
    height += fabric.thickness * draws.number(0.6, 1.5);
    sheet.pose = {.translation = transform(drawn.pose, Vec3(draws.number(-0.05, 0.05), height, draws.number(-0.05, 0.05))),
                  .rotation = product(drawn.pose.rotation, turn_about(Vec3::UnitY(), draws.number(0.0, 3.0)))};
    const Vec3 down = transform({.rotation = drawn.pose.rotation}, Vec3(0, -1, 0));
    sheet.velocity = draws.number(0.0, 1.0) * down + drawn.velocity;
    sheet.pins = draws.chance(0.25) ? 1 + draws.index(2) : 0;
    drawn.sheets.push_back(sheet);
}

Drawn draw_scene(int index) {
    Draws draws(0x9e3779b97f4a7c15ULL + static_cast<unsigned long long>(index));
    Drawn drawn;
    draw_body(draws, drawn);
    if (draws.chance(0.5)) {
        const double x = draws.number(-1.0, 1.0), y = draws.number(-1.0, 1.0), z = draws.number(-1.0, 1.0);
        drawn.pose.translation = Vec3(x, y, z);
        drawn.pose.rotation = turn_about(draws.unit(), draws.number(0.0, draws.chance(0.5) ? 0.4 : std::numbers::pi));
    }
    if (draws.chance(0.4)) {
        drawn.velocity = draws.number(0.0, 1.0) * draws.unit();
        drawn.axis = draws.unit();
        drawn.spin = draws.number(-3.0, 3.0);
    }
    drawn.settings = {.friction = draws.chance(0.2) ? 0.0 : draws.number(0.0, 1.0),
                      .restitution = draws.chance(0.5) ? 0.3 : 0.0,
                      .name = drawn.obstacle,
                      .deforming = true};
    drawn.step.time_step = 1.0 / draws.decades(30.0, 240.0);
    drawn.step.contact_response = draws.chance(0.5) ? ContactResponse::projection : ContactResponse::penalty;
    const Fabric fabric = draw_fabric(draws);
    double height = 0.0;
    for (const Vec3& x : drawn.body.vertices) height = std::max(height, x.y());
    draw_sheet(draws, fabric, height, drawn);
    if (draws.chance(0.3)) draw_sheet(draws, fabric, height, drawn);
    if (draws.chance(0.3)) {  // everything else of a scaled body stays
        const double scale = draws.decades(0.5, 2.0);
        drawn.pose.scale = scale;
        for (Vec3& x : drawn.body.vertices) x /= scale;
        for (Mode& mode : drawn.modes) mode.size /= scale;
    }
    return drawn;
}

bool finite(std::span<const Vec3> places) {
    return std::ranges::all_of(places, [](const Vec3& x) { return x.allFinite(); });
}

/// Results over all scenes.
struct Tally {
    int scenes = 0, stopped = 0, stopped_free = 0, touched = 0, pressed = 0, steps = 0, divided = 0, bad = 0;
    double nearest = 1.0;  // of its thickness
    std::map<std::string, int> reasons;
};

/// A drawn scene as it runs.
class Running {
public:
    Running(const Drawn& drawn, const Backend& backend, Tally& tally)
        : drawn_(drawn), tally_(tally), simulation_(drawn.step, backend.make_detector()) {
        for (const Drawn::Sheet& sheet : drawn.sheets) {
            const ClothId cloth = simulation_.add_cloth(sheet.mesh, sheet.fabric, sheet.pose);
            simulation_.set_velocities(cloth, std::vector<Vec3>(sheet.mesh.vertices.size(), sheet.velocity));
            if (sheet.pins > 0) simulation_.pin(cloth, 0);
            if (sheet.pins > 1) simulation_.pin(cloth, sheet.mesh.grid_columns - 1);
            cloths_.push_back(cloth);
        }
        body_ = simulation_.add_obstacle(drawn.body, drawn.pose, drawn.settings);
    }

    /// Steps until the first that is not ok.
    void run(int steps) {
        ++tally_.scenes;
        for (int n = 1; n <= steps && !stopped_; ++n) {
            simulation_.deform_obstacle(body_, drawn_.shape_at(n * drawn_.step.time_step));
            simulation_.move_obstacle(body_, drawn_.pose_at(n * drawn_.step.time_step));
            step();
        }
        tally_.touched += touched_;
        tally_.pressed += pressed_;
        if (stopped_) check_halt();
    }

private:
    void step() {
        const std::uint64_t before = simulation_.state_hash();
        const StepReport report = simulation_.step();
        ++tally_.steps;
        tally_.divided += report.parts > 1 || report.halvings > 0;
        CAPTURE(report.time, report.explanation());
        if (!report.ok()) {
            stopped_ = true;
            ++tally_.stopped;
            tally_.stopped_free += !report.blocked_by_pin;
            ++tally_.reasons[std::string(status_word(report.status))];
            expect(!report.explanation().empty() && report.status != StepStatus::not_finite);
            expect(simulation_.state_hash() == before);
            std::printf("  scene %d: %s\n", tally_.scenes - 1, report.explanation().c_str());
        }
        pressed_ = pressed_ || simulation_.force_on(body_).norm() > 0.0;
        check_state();
    }

    /// After a step that failed the body may stay where it is: the cloth continues from there, clear of it.
    void check_halt() {
        simulation_.deform_obstacle(
            body_, std::vector<Vec3>(simulation_.obstacle_shape(body_).begin(), simulation_.obstacle_shape(body_).end()));
        simulation_.move_obstacle(body_, simulation_.obstacle_pose(body_));
        const StepReport report = simulation_.step();
        CAPTURE(report.explanation());
        expect(report.ok());
        check_state();
    }

    /// The state is finite, without crossings of the body or vertices inside it; cloth that meets cloth does not cross it
    /// either.
    void check_state() {
        TriangleMesh body = drawn_.body, all;
        body.vertices = transform(simulation_.obstacle_pose(body_), simulation_.obstacle_shape(body_));
        for (std::size_t c = 0; c < cloths_.size(); ++c) {
            const auto x = simulation_.positions(cloths_[c]);
            expect(finite(x) && finite(simulation_.velocities(cloths_[c])));
            if (!finite(x)) return;
            const TriangleMesh cloth{.vertices = {x.begin(), x.end()}, .triangles = drawn_.sheets[c].mesh.triangles};
            const double thickness = drawn_.sheets[c].fabric.thickness;
            const Certificate certificate = certify(cloth, body, thickness);
            CAPTURE(c, certificate.pairs.size(), certificate.vertices_inside, certificate.smallest_distance);
            expect(certificate.clean() && certificate.smallest_distance > 0.0);
            tally_.nearest = std::min(tally_.nearest, certificate.smallest_distance / thickness);
            touched_ = touched_ || certificate.smallest_distance < thickness;
            all = joined(all, cloth);
        }
        if (drawn_.sheets[0].fabric.self_contact) expect(certify_cloth(all).crossing.empty());
    }

    void expect(bool holds) {
        CHECK(holds);
        tally_.bad += !holds;
    }

    const Drawn& drawn_;
    Tally& tally_;
    Simulation simulation_;
    std::vector<ClothId> cloths_;
    ObstacleId body_;
    bool stopped_ = false, touched_ = false, pressed_ = false;
};

int number_from(const char* variable, int otherwise) {
    const char* text = std::getenv(variable);
    return text ? std::atoi(text) : otherwise;
}

}  // namespace

TEST_CASE("Random scenes with bodies that deform: nothing crosses, and every stop has a reason", "[law]") {
    constexpr int steps = 12;
    const int first = number_from("PERCALE_DEFORMING_FIRST", 0), count = number_from("PERCALE_DEFORMING_SCENES", 200);
    const std::vector<Backend> trees = backends();
    Tally tally;
    for (int index = first; index < first + count; ++index) {
        const Drawn drawn = draw_scene(index);
        const int bad = tally.bad;
        CAPTURE(index, drawn.obstacle, drawn.modes.size(), drawn.sheets.size(), 1.0 / drawn.step.time_step,
                static_cast<int>(drawn.step.contact_response), drawn.sheets[0].fabric.self_contact);
        Running(drawn, trees[static_cast<std::size_t>(index) % trees.size()], tally).run(steps);
        if (tally.bad > bad) std::printf("scene %d is bad\n", index);
    }
    std::printf(
        "deforming scenes: %d, %d steps (%d divided), touched in %d, pressed in %d, stopped %d (%d not by pins), nearest %.2g "
        "of h\n",
        tally.scenes, tally.steps, tally.divided, tally.touched, tally.pressed, tally.stopped, tally.stopped_free, tally.nearest);
    for (const auto& [reason, times] : tally.reasons) std::printf("  %s: %d\n", reason.c_str(), times);
    CHECK(tally.bad == 0);
    CHECK(tally.stopped <= std::max(1, 6 * tally.scenes / 100));
    // Where no pin is in the way there is nearly always a way out.
    CHECK(tally.stopped_free <= std::max(1, tally.scenes / 200));
    CHECK(tally.touched >= 90 * tally.scenes / 100);
    CHECK(tally.pressed >= 90 * tally.scenes / 100);
    CHECK(tally.steps >= 11 * tally.scenes);
}

}  // namespace percale::test::deforming_scenes_test
