#include "lists/constraint_search.h"

#include <algorithm>
#include <bit>

#include "lists/obstacle_terms.h"

namespace percale {
namespace {

/// Adds the constraint of a pair; `factor` of its forces.
void add_constraint(const ListedScene& scene, const ContactPair& pair, const PairContact& contact, double factor,
                    ContactConstraints& to) {
    to.vertex.push_back({pair.cloth[0], pair.cloth[1], pair.cloth[2], -1});
    to.weight.push_back(contact.weight);
    to.direction.push_back(contact.direction);
    to.obstacle_point.push_back(contact.obstacle_point);
    to.obstacle_displacement.push_back(contact.obstacle_displacement);
    to.distance.push_back(contact.distance);
    to.thickness.push_back(scene.thickness_of(pair));
    to.friction.push_back(scene.obstacles[pair.obstacle]->friction());
    to.mollifier.push_back(factor);
    to.obstacle.push_back(pair.obstacle);
    to.feature.push_back(pair.feature);
}

/// The constraints of a vertex that a pair of it and a face represents; returns the distance of the pair.
double add_vertex(const ListedScene& scene, const ContactPair& pair, const ConstraintSearch::Place& place,
                  ContactConstraints& to) {
    const Obstacle& obstacle = *scene.obstacles[pair.obstacle];
    const SurfaceTerms terms = obstacle_terms(pair, place.positions, obstacle, place.fraction, scene.thickness_of(pair));
    const Triangle& corners = obstacle.surface().triangles[pair.feature];
    for (const SurfaceTerm& term : std::span(terms.terms).first(terms.count)) {
        PairContact contact{.distance = term.distance,
                            .weight = {1.0, 0.0, 0.0, 0.0},
                            .obstacle_point = place.positions[pair.cloth[0]] - term.apart};
        if (term.distance > 0.0) contact.direction = term.apart / term.distance;
        for (int k = 0; k < 3; ++k) contact.obstacle_displacement += term.weight[k] * obstacle.displacement(corners[k]);
        add_constraint(scene, pair, contact, term.factor, to);
        to.feature.back() = contact_places * pair.feature + term.place;
    }
    return terms.distance;
}

/// The constraint of a pair with an edge or a face of cloth. If it was a contact it stays one until the next update of the
/// candidates: constraints are only added while a step is being solved, so that the force is continuous where closest points pass
/// from one feature to the next. Returns the distance of the pair.
double add_minimum(const ListedScene& scene, const ContactPair& pair, const ConstraintSearch::Place& place,
                   const SelectedLane& at, ContactConstraints& to) {
    const double thickness = scene.thickness_of(pair);
    const PairContact contact = pair_contact(pair, place.positions, *scene.obstacles[pair.obstacle], place.fraction);
    const double mollifier = edge_mollifier(contact, thickness);
    if (contact.distance >= thickness || mollifier == 0.0) return contact.distance;
    const auto& [list, pack] = at.place;
    if (contact.local_minimum) {
        list->packs.make_persistent(pack, at.lane, thickness);
        list->has_persistent = true;
    }
    if ((list->packs.at[pack].persistent >> at.lane & 1U) != 0) add_constraint(scene, pair, contact, mollifier, to);
    return contact.distance;
}

}  // namespace

void ConstraintSearch::run(const ListedScene& scene, std::span<ClusterList* const> clusters, const Place& place,
                           ContactConstraints& to) {
    constraints.clear();
    smallest_distance = std::numeric_limits<double>::infinity();
    find_candidates(clusters);
    select_packs(scene, place.positions);
    measure_selected(scene, {place.positions, place.positions, {place.fraction, place.fraction}});
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
        fetch_ahead(scene, i);
        const ContactPair pair = scene.pair_of(lanes_[i]);
        const double distance = pair.kind == PairKind::vertex_face ? add_vertex(scene, pair, place, to)
                                                                   : add_minimum(scene, pair, place, lanes_[i], to);
        smallest_distance = std::min(smallest_distance, distance);
    }
    for (ClusterList* list : clusters) CandidateLists::set_smallest_bounds(*list);
}

/// The packs whose bounds are used up.
void ConstraintSearch::find_candidates(std::span<ClusterList* const> clusters) {
    candidates_.clear();
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        if (i + 2 < clusters.size()) {
            const std::vector<float>& wake = clusters[i + 2]->packs.wake;
            fetch(wake.data(), wake.size());
        }
        ClusterList& list = *clusters[i];
        for (const int pack : packs_up_to(list.packs.wake, list.travel, found_)) candidates_.push_back({&list, pack});
    }
}

/// Selects those of them that have to be measured: the hulls of most are far away.
void ConstraintSearch::select_packs(const ListedScene& scene, std::span<const Vec3> positions) {
    selected_.clear();
    const ContactPair* last = nullptr;
    Box box;  // of the last cloth feature
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
        if (i + 16 < candidates_.size()) __builtin_prefetch(&candidates_[i + 16].list->packs.at[candidates_[i + 16].index]);
        if (i + 8 < candidates_.size()) scene.fetch_hull(candidates_[i + 8]);
        const auto& [list, pack] = candidates_[i];
        const ContactPair& feature = candidates_[i].feature();
        const double thickness = scene.thickness_of(feature);
        const PackHull& hull = scene.hull_of(candidates_[i]);
        double apart = height_above(hull, feature.vertices(), positions);
        if (apart < thickness) {
            if (last != &feature) box = box_of(feature, positions);
            last = &feature;
            apart = std::max(apart, hull.box().gap(box));
        }
        if (apart < thickness) {
            selected_.push_back(candidates_[i]);
        } else {
            list->packs.raise(pack, apart, apart - thickness, thickness, list->travel);
        }
    }
}

/// Finds the lanes that can be contacts.
void ConstraintSearch::measure_selected(const ListedScene& scene, const ClothMove& here) {
    lanes_.clear();
    for (std::size_t i = 0; i < selected_.size(); ++i) {
        if (i + 4 < selected_.size()) {
            const SelectedPack& next = selected_[i + 4];
            scene.packs_for(next.feature()).placed[next.number()].prefetch(next.feature().kind);
        }
        const SelectedPack& at = selected_[i];
        const PackAnswer answer = scene.measure_pack(here, at, scene.thickness_of(at.feature()));
        for (unsigned lanes = answer.contact | (at.list->packs.at[at.index].persistent & answer.near); lanes != 0;
             lanes &= lanes - 1) {
            lanes_.push_back({at, std::countr_zero(lanes)});
            __builtin_prefetch(&scene.packs_for(at.feature()).packs[at.number()].feature);
        }
    }
}

void ConstraintSearch::fetch_ahead(const ListedScene& scene, std::size_t lane) const {
    for (int depth = 0; depth < pair_fetches; ++depth) {
        const std::size_t ahead = lane + 4 * static_cast<std::size_t>(pair_fetches - depth);
        if (ahead >= lanes_.size()) continue;
        const ContactPair pair = scene.pair_of(lanes_[ahead]);
        fetch_pair(pair, *scene.obstacles[pair.obstacle], depth);
    }
}

}  // namespace percale
