#include "sewing.h"

#include <algorithm>

namespace percale {
namespace {

/// s, m. Time in which a weld takes up its gap, and the gap at which its spring's force is the largest that it holds with.
/// Shorter: stitches swing. Wider: a seam that something keeps open pulls harder and harder.
constexpr double weld_time = 0.05, widest_weld = 0.01;

/// s, in which the hold of a strain limit takes up the excess. Longer: more steps until the limit is kept. Shorter than the time
/// step: as if it were that long.
constexpr double limit_time = 1.0 / 60.0;

}  // namespace

void add_rest_lengths(const SpringNetwork& network, std::vector<double>& rest_length) {
    if (rest_length.empty()) return;
    const auto known = static_cast<long>(rest_length.size());
    rest_length.insert(rest_length.end(), network.rest_length.begin() + known, network.rest_length.end());
}

bool joins_itself(const Stitch& stitch) {
    if (stitch.joins_vertices()) return stitch.vertex == stitch.other();
    return stitch.vertex == stitch.from || stitch.vertex == stitch.to;
}

double tighten_holds(World& world) {
    StepScene& scene = world.scene;
    ClothModel& model = scene.model;
    if (model.welds.empty() && model.limits.empty()) return 0.0;
    copy_holds(model, world.holds_before);
    const double dt = scene.settings.time_step, share = std::min(1.0, dt / weld_time);
    double work = tighten(model.limits, model.springs, world.state.cloth.positions, std::min(1.0, dt / limit_time));
    for (const Seam& seam : scene.script.seams) {
        if (seam.closes_after(world.state.time)) continue;
        work += tighten(welds_of(seam, model), world.state.cloth.positions, share, widest_weld);
    }
    if (world.rest.potential) *world.rest.potential += work;
    return work;
}

void loosen_holds(World& world) { put_holds(world.holds_before, world.scene.model); }

int sew(World& world, std::span<const Stitch> stitches, const SeamSettings& settings) {
    ClothModel model = world.scene.model;
    Seam seam{.length = {},
              .from = world.state.time + settings.after,
              .over = settings.over,
              .first_weld = settings.weld ? static_cast<int>(model.welds.size()) : -1,
              .contact = settings.contact_while_closing};
    append_seam(stitches, settings.stiffness, world.state.cloth.positions, seam, model);
    finish_model(model);
    world.scene.model = std::move(model);
    add_rest_lengths(world.scene.model.springs, world.state.cloth.rest_length);
    world.scene.script.seams.push_back(std::move(seam));
    world.work.newton.system.solver.forget_model();
    scene_changed(world);
    world.waiting = waiting_cloth(world.scene, world.state.time);
    world.changed = world.changed || settings.weld;  // the scheme must take welds
    if (meets_cloth(world.scene)) {
        pass_cloth_to_detector(world);
        world.changed = true;
    }
    return static_cast<int>(world.scene.script.seams.size()) - 1;
}

}  // namespace percale
