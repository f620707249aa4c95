#include "self/self_contact_detection.h"

#include <algorithm>
#include <limits>

#include "geometry/chunks.h"
#include "geometry/clamp_floor.h"
#include "geometry/joined_places.h"
#include "percale/certify.h"
#include "tolerances.h"

namespace percale {
namespace {

/// Fraction of h below which every pair of the lists is in contact, a local minimum or not: near a seam the features that lie
/// closer may be no pairs, as they share a stitched point. 0: nothing holds such a pair apart until the clamp stops it, and
/// Newton makes no progress (3,000 iterations a step, distances of 1e-17 m). Large: one contact counts several times.
constexpr double min_activation_ratio = 0.1;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Whether a distance stays above its floor while it shrinks by `shrink`.
bool stays_clear(double distance, double thickness, double shrink) {
    return distance - floor_below(distance, thickness) > shrink;
}

}  // namespace

SelfContactDetection::SelfContactDetection(std::span<const Triangle> triangles, std::span<const double> vertex_thickness,
                                           const SelfContact& cloth)
    : lists_(triangles, vertex_thickness, cloth),
      friction_(cloth.friction.begin(), cloth.friction.end()),
      stitches_(cloth.stitches.begin(), cloth.stitches.end()) {
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
        const int owner = cloth.cloth[triangles[t][0]];
        if (owner < 0) continue;
        met_triangles_.push_back(t);
        cloth_of_triangle_.push_back(owner);
    }
}

std::vector<Triangle> SelfContactDetection::triangles() const {
    std::vector<Triangle> triangles;
    for (const int t : met_triangles_) triangles.push_back(lists_.surface().triangles[t]);
    return triangles;
}

StartFault SelfContactDetection::check_start(std::span<const Vec3> positions) const {
    const std::vector<Triangle> met = triangles();
    const TriangleMesh cloth{.vertices = joined_places(positions, met), .triangles = met};
    const ClothCertificate certificate = certify_cloth(cloth, stitches_, meeting());
    const auto& pairs = certificate.crossing.empty() ? certificate.touching : certificate.crossing;
    if (pairs.empty()) return {};
    StartFault fault;
    fault.intersecting_pairs = static_cast<int>(certificate.crossing.size());
    fault.cloth_triangle = met_triangles_[pairs[0].first];
    fault.other_cloth_triangle = met_triangles_[pairs[0].second];
    return fault;
}

void SelfContactDetection::update_candidates(std::span<const Vec3> start, std::span<const Vec3> predicted, Workers* workers) {
    lists_.set_workers(workers);
    lists_.for_each([&](SelfList& list) {
        for (SelfPairRecord& record : list.records) settle(list, record, start);
    });
    lists_.begin_step(start, predicted);
}

double SelfContactDetection::add_constraints(std::span<const Vec3> positions, ContactConstraints& constraints, Workers* workers) {
    lists_.set_workers(workers);
    lists_.cover(positions, positions);
    near_.clear();
    lists_.for_each([&](SelfList& list) {
        if (list.smallest_reach - list.travel < list.thickness) near_.push_back(&list);
    });
    // As with obstacles, the results of chunks of lists are joined in the order of the lists.
    const std::size_t grain = workers ? tolerances::self_lists_a_part : near_.size() + 1,
                      parts = chunk_count(near_.size(), grain);
    if (found_.size() < parts) found_.resize(parts);
    parallel_for_chunks(workers, near_.size(), grain, [&](std::size_t first, std::size_t last, int) {
        Found& own = found_[first / grain];
        own.constraints.clear();
        own.smallest = infinity;
        for (std::size_t i = first; i < last; ++i)
            add_constraints_of(*near_[i], positions, own.smallest, parts == 1 ? constraints : own.constraints);
    });
    double smallest = infinity;
    for (const Found& own : std::span(found_).first(parts)) {
        smallest = std::min(smallest, own.smallest);
        if (parts > 1) constraints.append(own.constraints);
    }
    return smallest;
}

void SelfContactDetection::add_constraints_of(SelfList& list, std::span<const Vec3> positions, double& smallest,
                                              ContactConstraints& constraints) {
    list.smallest_reach = infinity;
    for (SelfPair& pair : list.pairs) {
        if (pair.reach - list.travel < pair.thickness) smallest = std::min(smallest, measure(list, pair, positions, constraints));
        list.smallest_reach = std::min(list.smallest_reach, pair.reach);
    }
}

/// Measures a pair and adds its contact constraints; returns its distance, or infinity if it is not in contact.
double SelfContactDetection::measure(SelfList& list, SelfPair& pair, std::span<const Vec3> positions,
                                     ContactConstraints& constraints) {
    return pair.shape == PairShape::edge_edge ? measure_edges(list, pair, positions, constraints)
                                              : measure_vertex(list, pair, positions, constraints);
}

double SelfContactDetection::measure_vertex(SelfList& list, SelfPair& pair, std::span<const Vec3> positions,
                                            ContactConstraints& constraints) const {
    const SurfaceTerms terms = vertex_terms(pair, positions, lists_.cloth());
    pair.reach = terms.distance + list.travel;
    double smallest = infinity;
    for (const SurfaceTerm& term : std::span(terms.terms).first(terms.count)) {
        const std::array<double, 4> weight{1.0, -term.weight[0], -term.weight[1], -term.weight[2]};
        const double activation_distance = activation_distance_at(pair, list.seam_activation_distance(pair), weight);
        if (term.distance >= activation_distance) continue;
        const Vec3 direction = term.distance > 0.0 ? Vec3(term.apart / term.distance) : Vec3(Vec3::Zero());
        add_constraint(pair, activation_distance, {term.distance, weight, direction, term.factor}, constraints);
        smallest = std::min(smallest, term.distance);
    }
    return smallest;
}

/// m, the activation distance of two edges that begin a contact where they are.
double SelfContactDetection::activation_distance(const SelfList& list, const SelfPair& pair, const EdgeContact& contact) const {
    return std::max(contact.activation_ratio, contact.crossing * min_activation_ratio) *
           activation_distance_at(pair, list.seam_activation_distance(pair), contact.weight);
}

/// A step begins. While two edges are in contact, their activation distance only falls: if it grew, its potential would feed the
/// cloth, and sheets at rest on each other tremble.
void SelfContactDetection::settle(const SelfList& list, SelfPairRecord& record, std::span<const Vec3> positions) const {
    if (record.activation_distance == 0.0) return;
    const SelfPair& pair = list.pairs[record.pair];
    const EdgeContact contact = edge_contact(pair, positions, lists_.surface());
    record.activation_distance = contact.distance < record.activation_distance
                                     ? std::min(record.activation_distance, activation_distance(list, pair, contact))
                                     : 0.0;
}

double SelfContactDetection::measure_edges(SelfList& list, SelfPair& pair, std::span<const Vec3> positions,
                                           ContactConstraints& constraints) const {
    const EdgeContact contact = edge_contact(pair, positions, lists_.surface());
    pair.reach = contact.distance + list.travel;
    double begun = list.activation_distance(pair);
    if (begun == 0.0) {
        begun = activation_distance(list, pair, contact);
        if (contact.distance < begun) list.record_of(pair).activation_distance = begun;
    }
    if (contact.distance >= begun) return infinity;
    add_constraint(pair, begun, {contact.distance, contact.weight, contact.direction, 1}, constraints);
    return contact.distance;
}

/// Vertices without weight are left out.
void SelfContactDetection::add_constraint(const SelfPair& pair, double activation_distance, const Contact& contact,
                                          ContactConstraints& constraints) const {
    std::array<int, 4> vertex{-1, -1, -1, -1};
    std::array<double, 4> weight{};
    for (int k = 0, count = 0; k < 4; ++k) {
        if (contact.weight[k] == 0.0) continue;
        vertex[count] = pair.vertex[k];
        weight[count++] = contact.weight[k];
    }
    constraints.vertex.push_back(vertex);
    constraints.weight.push_back(weight);
    constraints.direction.push_back(contact.direction);
    constraints.obstacle_point.push_back(Vec3::Zero());
    constraints.obstacle_displacement.push_back(Vec3::Zero());
    constraints.distance.push_back(contact.distance);
    constraints.thickness.push_back(activation_distance);
    constraints.friction.push_back(0.5 * (friction_[pair.vertex[0]] + friction_[pair.vertex[3]]));
    constraints.mollifier.push_back(contact.factor);
    constraints.obstacle.push_back(-1);
    constraints.feature.push_back(pair.shape == PairShape::edge_edge ? 2 : 1);
}

double SelfContactDetection::collision_free_step_size(std::span<const Vec3> from, std::span<const Vec3> to, Workers* workers) {
    lists_.set_workers(workers);
    const double covered = lists_.cover(from, to);
    lists_.set_motion(from, to);
    near_.clear();
    lists_.for_each([&](SelfList& list) {
        if (!stays_clear(list.smallest_reach - list.travel, list.thickness, lists_.shrink(list) * covered))
            near_.push_back(&list);
    });
    // Chunks are the same for any number of threads; within one, the limit of a list bounds the search of the next ones.
    constexpr std::size_t grain = tolerances::self_lists_a_part;
    found_.resize(std::max(found_.size(), chunk_count(near_.size(), grain)));
    parallel_for_chunks(workers, near_.size(), grain, [&](std::size_t first, std::size_t last, int) {
        double& safe = found_[first / grain].safe;
        safe = covered;
        for (std::size_t i = first; i < last; ++i) safe = clamp(*near_[i], from, to, safe);
    });
    double safe = covered;
    for (std::size_t part = 0; part < chunk_count(near_.size(), grain); ++part) safe = std::min(safe, found_[part].safe);
    return safe;
}

/// Lowers `safe` where a pair of the list needs it.
double SelfContactDetection::clamp(SelfList& list, std::span<const Vec3> from, std::span<const Vec3> to, double safe) {
    const double shrink = lists_.shrink(list);
    if (stays_clear(list.smallest_reach - list.travel, list.thickness, shrink * safe)) return safe;
    for (SelfPair& pair : list.pairs) {
        if (stays_clear(pair.reach - list.travel, pair.thickness, shrink * safe)) continue;
        const double distance = self_distance(pair, from);
        pair.reach = distance + list.travel;
        if (stays_clear(distance, pair.thickness, shrink * safe)) continue;
        const MovingFour four = moving_pair(pair, from, to);
        safe = time_of_impact_lower_bound(four, pair.shape, clamped_distance(four, distance, pair.thickness), safe);
    }
    return safe;
}

}  // namespace percale
