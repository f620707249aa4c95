#include "saved_identity.h"

#include "forces/total_force.h"
#include "percale/error.h"
#include "percale/options.h"
#include "percale/saved_state.h"
#include "support/hash.h"
#include "support/list_hash.h"

namespace percale {
namespace {

std::uint64_t cloth_hash(const ClothModel& model, const ClothPairs& pairs) {
    ListHash hash;
    for (const ClothRange& cloth : model.cloths) {
        for (const int number : {cloth.first, cloth.count, cloth.columns, static_cast<int>(cloth.fabric.self_contact)}) {
            hash.add(number);
        }
        for (const double drag : {cloth.fabric.drag_normal, cloth.fabric.drag_tangential}) hash.add(drag);
    }
    for (const auto* numbers : {&model.mass, &model.thickness}) hash.add_all(*numbers);
    hash.add_all(model.rest);
    hash.add_all(model.triangles);
    for (const auto& [cloths, pair] : pairs.said()) {
        for (const int number : {cloths[0], cloths[1], static_cast<int>(pair.contact)}) hash.add(number);
        hash.add(pair.thickness.value_or(0.0));
    }
    for (const auto& [cloth, layer] : pairs.layers()) {
        for (const int number : {cloth, layer}) hash.add(number);
    }
    for (const ForceTerm* term : force_terms()) term->identify(model, hash);
    return hash.value();
}

std::uint64_t obstacles_hash(const World& world) {
    StateWriter writer;
    writer(world.scene.detector != nullptr);
    for (const ObstacleState& obstacle : world.scene.script.obstacles)
        writer(obstacle.triangles, obstacle.start.scale, obstacle.restitution, obstacle.compliance.mesh != nullptr);
    return checksum(writer.take());
}

std::uint64_t numbers_hash(const World& world) {
    StateWriter writer;
    for (const GivenNumbers* numbers : {&world.cloth_numbers, &world.obstacle_numbers, &world.seam_numbers}) writer(numbers->all);
    return checksum(writer.take());
}

}  // namespace

Identity identity_of(const World& world) {
    return {cloth_hash(world.scene.model, world.scene.script.pairs), obstacles_hash(world), options_hash(world.scene.settings),
            numbers_hash(world)};
}

void demand_same(const Identity& saved, const Identity& own) {
    if (saved.cloth != own.cloth)
        throw SceneError("saved state: it is of other cloth, pairs of cloths or seams than this simulation has");
    if (saved.obstacles != own.obstacles) throw SceneError("saved state: it is of other obstacles than this simulation has");
    if (saved.numbers != own.numbers)
        throw SceneError("saved state: other cloths, seams or obstacles were removed before it was saved than here");
    if (saved.settings != own.settings) throw SceneError("saved state: it was made with other step settings than these");
}

}  // namespace percale
