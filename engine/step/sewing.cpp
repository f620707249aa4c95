#include "sewing.h"

namespace percale {

void add_rest_lengths(const SpringNetwork& network, std::vector<double>& rest_length) {
    if (rest_length.empty()) return;
    const auto known = static_cast<long>(rest_length.size());
    rest_length.insert(rest_length.end(), network.rest_length.begin() + known, network.rest_length.end());
}

bool joins_itself(const Stitch& stitch) {
    if (stitch.joins_vertices()) return stitch.vertex == stitch.other();
    return stitch.vertex == stitch.from || stitch.vertex == stitch.to;
}

int sew(World& world, std::span<const Stitch> stitches, const SeamSettings& settings) {
    ClothModel model = world.scene.model;
    Seam seam{.length = {},
              .from = world.state.time + settings.after,
              .over = settings.over,
              .contact = settings.contact_while_closing};
    append_seam(stitches, settings.stiffness, world.state.cloth.positions, seam, model);
    finish_model(model);
    world.scene.model = std::move(model);
    add_rest_lengths(world.scene.model.springs, world.state.cloth.rest_length);
    world.scene.script.seams.push_back(std::move(seam));
    world.work.newton.solver.forget_model();
    scene_changed(world);
    world.waiting = waiting_cloth(world.scene, world.state.time);
    if (meets_cloth(world.scene)) {
        pass_cloth_to_detector(world);
        world.changed = true;
    }
    return static_cast<int>(world.scene.script.seams.size()) - 1;
}

}  // namespace percale
