#include "world.h"

#include <algorithm>
#include <string>
#include <thread>

#include "contact/contact_loads.h"
#include "percale/error.h"
#include "schemes/schemes.h"
#include "tolerances.h"

namespace percale {

bool meets_cloth(const StepScene& scene) {
    return std::any_of(scene.model.cloths.begin(), scene.model.cloths.end(),
                       [](const ClothRange& cloth) { return cloth.fabric.self_contact; });
}

bool closes_without_contact(const World& world, double time) {
    return std::ranges::any_of(world.scene.script.seams,
                               [&](const Seam& seam) { return !seam.contact && seam.closes_after(time); });
}

void pass_cloth_to_detector(World& world) {
    const ClothModel& model = world.scene.model;
    if (!world.scene.detector) return;
    std::vector<double> zone = model.thickness;
    const double factor = world.work.newton.law(world.scene.settings.contact_response).zone();
    for (double& thickness : zone) thickness *= factor;
    world.scene.detector->set_cloth(model.triangles, zone);
    if (!meets_cloth(world.scene) || world.cloth_waits) return;
    std::vector<int> owner;
    std::vector<double> friction;
    for (std::size_t c = 0; c < model.cloths.size(); ++c) {
        const ClothRange& cloth = model.cloths[c];
        const auto end = static_cast<std::size_t>(cloth.first + cloth.count);
        owner.resize(end, cloth.fabric.self_contact ? static_cast<int>(c) : -1);
        friction.resize(end, cloth.fabric.friction);
    }
    std::vector<Stitch> stitches;
    for (const Seam& seam : world.scene.script.seams) stitches.insert(stitches.end(), seam.stitches.begin(), seam.stitches.end());
    world.scene.detector->set_self_contact({.cloth = owner, .rest = model.rest, .friction = friction, .stitches = stitches});
}

void check_scheme(const StepScene& scene) {
    if (scene.settings.scheme == Scheme::automatic) return;
    const SchemeFacts& scheme = facts_of(scene.settings.scheme);
    const bool meets = meets_cloth(scene);
    if (!meets && scene.script.obstacles.empty()) return;
    if (!scheme.contact) {
        const std::string kind = scheme.implicit ? std::string(scheme.word) : "an explicit scheme";
        throw SceneError(kind + " takes no " + (meets ? "self_contact" : "obstacles") + "; use scheme backward_euler or tr_bdf2");
    }
    if (scene.settings.contact_response == ContactResponse::projection && scheme.scheme != Scheme::backward_euler) {
        throw SceneError("contact_response projection needs scheme backward_euler, not " + std::string(scheme.word));
    }
}

std::vector<ContactLoad> contact_loads(const World& world) {
    if (world.load_source == LoadSource::nowhere) return {};
    if (world.load_source == LoadSource::saved_state) return world.saved_loads;
    const StagePoint& last = world.work.newton.current;
    return contact_loads(last.rows, last.contact, last.row_forces);
}

void set_workers(World& world) {
    if (world.own_workers) {
        const int most = world.scene.model.vertex_count() / least_vertices_a_thread;
        const int said = world.scene.settings.threads;
        const int wanted = said > 0 ? said : std::min(most, static_cast<int>(std::thread::hardware_concurrency()));
        const int threads = std::clamp(wanted, 1, most_threads);
        if (threads == 1) world.workers.reset();
        if (threads > 1 && !(world.workers && world.workers->threads() == threads)) world.workers = make_workers(threads);
    }
    world.scene.compute.workers = world.workers.get();
    if (world.scene.detector) world.scene.detector->set_workers(world.workers.get());
}

}  // namespace percale
