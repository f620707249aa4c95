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

std::vector<int> waiting_cloth(const StepScene& scene, double time) {
    const auto waits = [&](const Seam& seam) { return !seam.contact && seam.closes_after(time); };
    if (std::ranges::none_of(scene.script.seams, waits)) return {};
    const ClothModel& model = scene.model;
    std::vector<int> group(model.cloths.size(), -1);
    const auto join = [&](int first, int second) {
        const int from = group[first] < 0 ? first : group[first], other = group[second] < 0 ? second : group[second];
        group[first] = group[second] = std::min(from, other);
        std::ranges::replace(group, std::max(from, other), std::min(from, other));
    };
    for (const Seam& seam : scene.script.seams) {
        if (!waits(seam)) continue;
        // All stitches of a seam join the same two cloths.
        join(cloth_of(model, seam.stitches.front().vertex), cloth_of(model, seam.stitches.front().from));
    }
    return group;
}

bool meet_now(const World& world, int first, int second) {
    const std::vector<ClothRange>& cloths = world.scene.model.cloths;
    if (!cloths[first].fabric.self_contact || !cloths[second].fabric.self_contact) return false;
    const std::vector<int>& waiting = world.waiting;
    const auto group = [&](int cloth) { return cloth < static_cast<int>(waiting.size()) ? waiting[cloth] : -1; };
    if (group(first) >= 0 && group(first) == group(second)) return false;
    // A seam that closes around another layer would close upon the part of it that sticks out between its edges.
    const ClothPairs& pairs = world.scene.script.pairs;
    const bool closes = group(first) >= 0 || group(second) >= 0;
    if (closes && pairs.layer(first) != pairs.layer(second)) return false;
    return pairs.of(first, second).contact;
}

bool cloth_meets_now(const World& world) {
    const int count = static_cast<int>(world.scene.model.cloths.size());
    for (int first = 0; first < count; ++first) {
        for (int second = first; second < count; ++second) {
            if (meet_now(world, first, second)) return true;
        }
    }
    return false;
}

namespace {

/// The pair settings for the detector: the given ones, and that waiting cloths do not meet; thicknesses times
/// `activation_ratio`.
ClothPairs pairs_now(const World& world, double activation_ratio) {
    ClothPairs pairs;
    for (const auto& [cloth, layer] : world.scene.script.pairs.layers()) pairs.set_layer(cloth, layer);
    const int count = static_cast<int>(world.scene.model.cloths.size());
    for (const auto& [cloths, said] : world.scene.script.pairs.said()) {
        ClothPair pair = said;
        if (pair.thickness) *pair.thickness *= activation_ratio;
        pairs.set(cloths[0], cloths[1], pair);
    }
    if (world.waiting.empty()) return pairs;
    for (int first = 0; first < count; ++first) {
        for (int second = first; second < count; ++second) {
            if (!meet_now(world, first, second)) pairs.set(first, second, {.contact = false});
        }
    }
    return pairs;
}

}  // namespace

void pass_cloth_to_detector(World& world) {
    const ClothModel& model = world.scene.model;
    if (!world.scene.detector) return;
    std::vector<double> activation_distance = model.thickness;
    const double activation_ratio = world.work.newton.stage.law(world.scene.settings.contact_response).activation_ratio();
    for (double& thickness : activation_distance) thickness *= activation_ratio;
    world.scene.detector->set_cloth(model.triangles, activation_distance);
    if (!cloth_meets_now(world)) return;
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
    world.scene.detector->set_self_contact({.cloth = owner,
                                            .rest = model.rest,
                                            .friction = friction,
                                            .stitches = stitches,
                                            .pairs = pairs_now(world, activation_ratio)});
}

void check_scheme(const StepScene& scene) {
    if (scene.settings.scheme == Scheme::automatic) return;
    const SchemeFacts& scheme = facts_of(scene.settings.scheme);
    if (scene.model.has_holds() && !scheme.contact) {
        const std::string what = scene.model.limits.empty() ? "welded seams" : "strain limit";
        throw SceneError(std::string(scheme.word) + " takes no " + what + "; use scheme backward_euler or tr_bdf2");
    }
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

std::vector<ContactLoad> contact_loads(const World& world, int only) {
    if (world.load_source == LoadSource::nowhere) return {};
    if (world.load_source == LoadSource::saved_state) {
        std::vector<ContactLoad> loads = world.saved_loads;
        if (only >= 0) std::erase_if(loads, [only](const ContactLoad& load) { return load.obstacle != only; });
        return loads;
    }
    const StagePoint& last = world.work.newton.current;
    std::vector<ContactLoad> loads = contact_loads(last.constraints, last.contact, last.constraint_forces, only);
    for (ContactLoad& load : loads) load.cloth_point = world.state.cloth.positions.at(load.vertex);
    return loads;
}

void set_workers(World& world) {
    if (world.own_workers) {
        const int max = world.scene.model.vertex_count() / min_vertices_a_thread;
        const int said = world.scene.settings.threads;
        const int wanted = said > 0 ? said : std::min(max, static_cast<int>(std::thread::hardware_concurrency()));
        const int threads = std::clamp(wanted, 1, max_threads);
        if (threads == 1) world.workers.reset();
        if (threads > 1 && !(world.workers && world.workers->threads() == threads)) world.workers = make_workers(threads);
    }
    world.scene.compute.workers = world.workers.get();
    if (world.scene.detector) world.scene.detector->set_workers(world.workers.get());
}

}  // namespace percale
