#include "saved_world.h"

#include <algorithm>
#include <cmath>

#include "compliant/compliant_obstacle.h"
#include "percale/error.h"
#include "percale/options.h"
#include "plan/planning.h"
#include "plan/scheme_choice.h"
#include "saved_identity.h"
#include "saved_parts.h"
#include "state_seal.h"
#include "support/hash.h"
#include "tolerances.h"

namespace percale {

namespace {

/// Capacity for the next state: states of one simulation have much the same size.
std::size_t with_room(std::size_t bytes) { return bytes + bytes / 32 + 64; }

SavedWorld state_of(const World& world, SavedSize& size) {
    const StepScene& scene = world.scene;
    SavedWorld saved;
    saved.changed = world.changed;
    saved.plan_outdated = world.plan_outdated;
    saved.waiting = world.waiting;
    saved.settings = scene.settings;
    saved.state = world.state;
    const ContactWarmStart& contact = world.state.contact;
    saved.contact = {contact.last.all(), contact.lasting.all(), contact.cloth_anchors, contact.energy, contact.min_distance};
    saved.free = scene.script.free;
    saved.pin_targets = scene.script.pin_targets;
    for (const ObstacleState& o : scene.script.obstacles) {
        saved.obstacles.push_back({o.start, o.end, o.settled, {}, {}, o.compliance.deflection, {}});
        if (o.compliance.aim) saved.obstacles.back().aim = *o.compliance.aim;
        if (o.start_shape) saved.obstacles.back().start_shape = *o.start_shape;
        if (o.deforms()) saved.obstacles.back().end_shape = *o.end_shape;
    }
    saved.seams = scene.script.seams;
    for (const SewnPoint& point : scene.model.sewn_points) saved.sewn_directions.push_back(point.direction);
    copy_holds(scene.model, saved.holds);
    for (const Hinge& hinge : scene.model.hinges.all) saved.clamps.push_back(hinge.clamp);
    saved.loads = {world.load_source != LoadSource::nowhere, contact_loads(world)};
    saved.plan = scene.plan;
    saved.rest = world.rest;
    saved.solver_is_set = world.work.newton.system.solver.is_for(scene.model);
    saved.solver = world.work.newton.system.solver.choice();
    if (!scene.detector) return saved;
    StateWriter writer(with_room(size.detector));
    scene.detector->save(writer);
    saved.detector = writer.take();
    size.detector = saved.detector.size();
    return saved;
}

/// The checks of a state that was read: whatever its bytes are, no later step may access anything out of range.
class StateCheck {
public:
    StateCheck(const SavedWorld& saved, const World& world, const StateReader& reader)
        : saved_(saved), world_(world), reader_(reader) {}

    void run() const {
        check_settings();
        check_vectors();
        const int vertices = world_.scene.model.vertex_count(),
                  obstacles = static_cast<int>(world_.scene.script.obstacles.size());
        reader_.demand(are_loads_of(saved_.loads, vertices, obstacles), "a contact force on nothing");
        check_script();
        check_plan();
        check_rest();
        check_past();
    }

private:
    void check_settings() const {
        StepSettings settings = world_.scene.settings;
        settings.time_step = saved_.settings.time_step;
        settings.gravity = saved_.settings.gravity;
        settings.wind = saved_.settings.wind;
        check_options(settings, "saved state");
        const StepState& state = saved_.state;
        for (const double number : {state.time, state.time_error, state.contact_energy, saved_.contact.energy}) {
            reader_.demand(std::isfinite(number), "a time or energy that is not finite");
        }
    }

    bool fits(const Vec3Arrays& vectors) const {
        const std::size_t padded = world_.state.cloth.positions.padded_size();
        return vectors.x.size() == padded && vectors.y.size() == padded && vectors.z.size() == padded;
    }
    bool fits_or_empty(const Vec3Arrays& vectors) const {
        return fits(vectors) || (vectors.x.empty() && vectors.y.empty() && vectors.z.empty());
    }

    void check_vectors() const {
        for (const Vec3Arrays* vectors : {&saved_.state.cloth.positions, &saved_.state.cloth.velocities, &saved_.pin_targets}) {
            reader_.demand(fits(*vectors), "a wrong number of vertices");
            for (const auto* axis : {&vectors->x, &vectors->y, &vectors->z}) {
                reader_.demand(std::all_of(axis->begin(), axis->end(), [](double value) { return std::isfinite(value); }),
                               "a position or velocity that is not finite");
            }
        }
        const auto there = [](int index, std::size_t count) { return index >= 0 && static_cast<std::size_t>(index) < count; };
        const std::size_t obstacles = world_.scene.script.obstacles.size();
        for (const StickAnchor& stick_anchor : saved_.state.cloth.stick_anchors) {
            const bool known =
                there(stick_anchor.vertex, world_.scene.model.mass.size()) && there(stick_anchor.obstacle, obstacles);
            reader_.demand(known && stick_anchor.stretch.allFinite(), "a stick anchor on nothing");
        }
        for (const ClothAnchor& anchor : saved_.contact.cloth_anchors) {
            bool known = anchor.vertex[0] >= 0 && anchor.vertex[1] >= 0;
            for (const int vertex : anchor.vertex)
                known = known && (vertex == -1 || there(vertex, world_.scene.model.mass.size()));
            for (const double weight : anchor.weight) known = known && std::isfinite(weight);
            reader_.demand(known && anchor.normal.allFinite() && anchor.stretch.allFinite(),
                           "an anchor between cloths on nothing");
        }
        for (const Impact& impact : saved_.state.cloth.impacts) {
            const bool known = there(impact.vertex, world_.scene.model.mass.size()) &&
                               (impact.obstacle == -1 || there(impact.obstacle, obstacles));
            reader_.demand(known && std::isfinite(impact.speed), "an impact on nothing");
        }
        for (const StartMove& move : saved_.start_moves) {
            reader_.demand(
                there(move.cloth, world_.scene.model.cloths.size()) && (move.obstacle == -1 || there(move.obstacle, obstacles)),
                "a move of nothing");
        }
    }

    void check_script() const {
        const AlignedVector<double>& free = saved_.free;
        reader_.demand(free.size() == world_.scene.script.free.size(), "a wrong number of vertices");
        for (std::size_t i = 0; i < free.size(); ++i) {
            const bool padding = i >= static_cast<std::size_t>(world_.scene.model.vertex_count());
            reader_.demand(free[i] == 0.0 || (free[i] == 1.0 && !padding), "a vertex neither pinned nor free");
        }
        const auto same_size = [](const SavedObstacle& a, const ObstacleState& b) {
            return a.start.scale == b.start.scale && a.end.scale == b.start.scale;
        };
        reader_.demand(std::ranges::equal(saved_.obstacles, world_.scene.script.obstacles, same_size),
                       "obstacles of other sizes");
        const auto same_shape = [](const SavedObstacle& a, const ObstacleState& b) {
            const std::size_t vertices = b.start_shape ? b.start_shape->size() : 0;
            const bool whole =
                std::ranges::all_of(a.start_shape, &Vec3::allFinite) && std::ranges::all_of(a.end_shape, &Vec3::allFinite);
            return whole && are_deflections_of(b, a.deflection, a.aim) && a.start_shape.size() == vertices &&
                   (a.end_shape.empty() || a.end_shape.size() == vertices);
        };
        reader_.demand(std::ranges::equal(saved_.obstacles, world_.scene.script.obstacles, same_shape),
                       "obstacles of other shapes");
        reader_.demand(saved_.clamps.size() == world_.scene.model.hinges.all.size(), "a wrong number of hinges");
        bool same = saved_.seams.size() == world_.scene.script.seams.size();
        for (std::size_t k = 0; same && k < saved_.seams.size(); ++k) {
            const Seam &seam = saved_.seams[k], &own = world_.scene.script.seams[k];
            same = seam.first_spring == own.first_spring && seam.length.size() == own.length.size() &&
                   seam.contact == own.contact && seam.first_weld == own.first_weld;
        }
        const std::vector<double>& lengths = saved_.state.cloth.rest_length;
        const auto springs = static_cast<std::size_t>(world_.scene.model.springs.size());
        reader_.demand(same && (lengths.empty() || (lengths.size() == springs && !saved_.seams.empty())), "other seams");
        reader_.demand(saved_.sewn_directions.size() == world_.scene.model.sewn_points.size(), "a wrong number of sewn points");
        const Holds& holds = saved_.holds;
        reader_.demand(holds.welds.size() == world_.scene.model.welds.size(), "a wrong number of welds");
        reader_.demand(holds.limits.size() == world_.scene.model.limits.edges.size(), "a wrong number of limited edges");
        reader_.demand(std::ranges::all_of(holds.limits, [](double h) { return h >= 0.0 && h < 1e300; }),
                       "a strain limit that pushes");
        reader_.demand(std::ranges::all_of(holds.welds, [](const Vec3& h) { return h.norm() < 1e300; }),
                       "a weld without a force");
        reader_.demand(std::ranges::all_of(saved_.sewn_directions, [](const Vec3& d) { return d.allFinite(); }),
                       "a seam that closes in no direction");
        reader_.demand(std::all_of(lengths.begin(), lengths.end(), [](double length) { return length >= 0.0 && length < 1e300; }),
                       "a rest length out of range");
    }

    void check_plan() const {
        const StepPlan& plan = saved_.plan;
        reader_.demand(saved_.plan_outdated || can_be_chosen(world_.scene, plan.scheme, plan.parts), "a scheme of another kind");
        const auto& [first, in_use] = saved_.solver;
        reader_.demand(first != LinearSolver::automatic && in_use != LinearSolver::automatic, "a linear solver that is none");
        reader_.demand(saved_.contact.min_distance >= 0.0 && saved_.contact.min_distance <= 1.0, "a distance out of range");
        for (const auto* forces : {&saved_.contact.last, &saved_.contact.lasting}) {
            const auto twice = std::ranges::adjacent_find(*forces, std::ranges::greater_equal{}, &KeyedForce::key);
            reader_.demand(twice == forces->end(), "a contact force twice");
        }
    }

    void check_rest() const {
        const RestState& rest = saved_.rest;
        reader_.demand(fits_or_empty(rest.anchor), "a wrong number of vertices");
        reader_.demand(rest.cloths.empty() || (rest.cloths.size() == world_.scene.model.cloths.size() && fits(rest.anchor)),
                       "a wrong number of cloths");
    }

    void check_past() const {
        const SchemeHistory& past = saved_.state.past;
        const bool known = past.earlier_length > 0.0;
        reader_.demand(known || past.earlier_length == 0.0, "a negative time step");
        for (const Vec3Arrays* vectors : {&past.earlier.positions, &past.earlier.velocities, &past.acceleration}) {
            reader_.demand(known ? fits(*vectors) : fits_or_empty(*vectors), "a wrong number of vertices");
        }
        reader_.demand(fits_or_empty(past.unbalanced), "a wrong number of vertices");
        const StepControl& control = saved_.state.control;
        reader_.demand(control.length == 0.0 || control.length >= shortest_step, "a time step too short");
        reader_.demand(control.left >= 0.0 && control.error_ratio_before >= 0.0, "an error below 0");
    }

    const SavedWorld& saved_;
    const World& world_;
    const StateReader& reader_;
};

void put_shape(SavedObstacle&& saved, ObstacleState& obstacle) {
    if (saved.start_shape.empty()) return;
    const auto shared = [](std::vector<Vec3>& shape) { return std::make_shared<const std::vector<Vec3>>(std::move(shape)); };
    obstacle.start_shape = shared(saved.start_shape);
    obstacle.go_to(saved.end_shape.empty() ? obstacle.start_shape : shared(saved.end_shape));
    obstacle.compliance.deflection = std::move(saved.deflection);
    if (obstacle.compliance.mesh) obstacle.compliance.aim = shared(saved.aim);
}

void put_script(SavedWorld& saved, Script& script) {
    script.free = std::move(saved.free);
    script.pin_targets = std::move(saved.pin_targets);
    for (std::size_t k = 0; k < saved.obstacles.size(); ++k) {
        ObstacleState& obstacle = script.obstacles[k];
        obstacle.start = saved.obstacles[k].start;
        obstacle.end = saved.obstacles[k].end;
        put_shape(std::move(saved.obstacles[k]), obstacle);
        obstacle.settled = saved.obstacles[k].settled;
    }
    for (std::size_t k = 0; k < saved.seams.size(); ++k) saved.seams[k].stitches = std::move(script.seams[k].stitches);
    script.seams = std::move(saved.seams);
}

/// Restores hinges beside pins, and seams.
void put_model(const SavedWorld& saved, ClothModel& model) {
    for (std::size_t k = 0; k < saved.clamps.size(); ++k) model.hinges.all[k].clamp = saved.clamps[k];
    for (std::size_t k = 0; k < saved.sewn_directions.size(); ++k) model.sewn_points[k].direction = saved.sewn_directions[k];
    put_holds(saved.holds, model);
    set_bending(model);
    copy_bending(model.springs, model.adjacency);
}

/// The solver's data on the structure of the model stay: no stage depends on them, and they are expensive.
void put_solver(const SavedWorld& saved, const StepScene& scene, NewtonSpace& newton) {
    StepSolver solver = std::move(newton.system.solver);
    newton = NewtonSpace{};
    if (!saved.solver_is_set) {
        solver.forget_model();
    } else if (!solver.is_for(scene.model)) {
        solver.set_model(scene.compute, scene.model, scene.settings.linear_solver);
    }
    solver.go_on_from(saved.solver);
    newton.system.solver = std::move(solver);
}

void put_state(SavedWorld& saved, World& world) {
    world.changed = saved.changed;
    world.refused = {};
    world.plan_outdated = saved.plan_outdated;
    world.waiting = std::move(saved.waiting);
    StepSettings& settings = world.scene.settings;
    settings.time_step = saved.settings.time_step;
    settings.gravity = saved.settings.gravity;
    settings.wind = saved.settings.wind;
    saved.state.cloth.points = std::move(world.state.cloth.points);
    world.state = std::move(saved.state);
    update_points(world.state.cloth);
    world.state.contact.last.set(saved.contact.last);
    world.state.contact.lasting.set(saved.contact.lasting);
    world.state.contact.cloth_anchors = saved.contact.cloth_anchors;
    world.state.contact.energy = saved.contact.energy;
    world.state.contact.min_distance = saved.contact.min_distance;
    world.rest = std::move(saved.rest);
    world.load_source = saved.loads.known ? LoadSource::saved_state : LoadSource::nowhere;
    world.saved_loads = std::move(saved.loads.all);
}

/// The detector holds only cloth that does not wait against cloth. If it refuses the state, it is unchanged.
void restore_detector(const SavedWorld& saved, World& world) {
    ContactDetector& detector = *world.scene.detector;
    StateReader reader(saved.detector);
    if (saved.waiting == world.waiting) return detector.restore(reader);
    StateWriter before;
    detector.save(before);
    const std::vector<std::byte> own = before.take();
    const std::vector<int> own_waiting = world.waiting;
    const auto let_wait = [&](const std::vector<int>& waiting) {
        world.waiting = waiting;
        pass_cloth_to_detector(world);
    };
    let_wait(saved.waiting);
    try {
        detector.restore(reader);
    } catch (const SceneError&) {
        let_wait(own_waiting);
        StateReader again(own);
        detector.restore(again);
        throw;
    }
}

}  // namespace

std::vector<std::byte> saved_world(const World& world, const std::vector<StartMove>& start_moves, SavedSize& size) {
    const Identity identity = identity_of(world);
    SavedWorld saved = state_of(world, size);
    saved.start_moves = start_moves;
    StateWriter writer = begin_sealed(with_room(size.whole));
    writer(identity.numbers, identity.cloth, identity.obstacles, identity.settings, saved);
    std::vector<std::byte> bytes = end_sealed(state_seal, writer);
    if (bytes.capacity() > with_room(bytes.size())) bytes.shrink_to_fit();  // hosts hold many states
    size.whole = bytes.size();
    return bytes;
}

std::vector<StartMove> restore_world(std::span<const std::byte> bytes, World& world) {
    StateReader reader(unsealed(state_seal, bytes));
    const Identity own = identity_of(world);
    Identity identity;
    reader(identity.numbers, identity.cloth, identity.obstacles, identity.settings);
    demand_same(identity, own);
    SavedWorld saved;
    reader(saved);
    reader.demand(reader.at_end(), "there is more than belongs to it");
    StateCheck(saved, world, reader).run();
    if (world.scene.detector) restore_detector(saved, world);
    put_script(saved, world.scene.script);
    put_model(saved, world.scene.model);
    put_state(saved, world);
    put_solver(saved, world.scene, world.work.newton);
    world.scene.plan = world.plan_outdated ? StepPlan{} : plan_again(world.scene, world.state.cloth, saved.plan);
    return std::move(saved.start_moves);
}

}  // namespace percale
