#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "percale/contact.h"
#include "self/self_contact_state.h"
#include "self/vertex_terms.h"

namespace percale {

/// Contact of cloth with cloth: candidate lists, contact constraints and clamps.
class SelfContactDetection {
public:
    SelfContactDetection(std::span<const Triangle> triangles, std::span<const double> vertex_thickness, const SelfContact& cloth);

    /// The triangles of cloth that meets cloth.
    std::vector<Triangle> triangles() const;
    std::span<const Stitch> stitches() const { return stitches_; }
    /// The pairs of cloths that meet.
    MeetingCloth meeting() const { return {cloth_of_triangle_, &lists_.cloth_pairs()}; }

    /// The first pair of cloth triangles that cross, or touch without being neighbours; exact.
    StartFault check_start(std::span<const Vec3> positions) const;

    /// As in ContactDetector, on the threads of `workers`, or on the caller's alone without them.
    void update_candidates(std::span<const Vec3> start, std::span<const Vec3> predicted, Workers* workers = nullptr);
    double collision_free_step_size(std::span<const Vec3> from, std::span<const Vec3> to, Workers* workers = nullptr);

    /// Appends contact constraints; returns the smallest of their distances, m, or infinity.
    double add_constraints(std::span<const Vec3> positions, ContactConstraints& constraints, Workers* workers = nullptr);

    /// As in self_contact_state.h.
    void save(StateWriter& state) const { percale::save(lists_, state); }
    SelfListsState restored(StateReader& state) const { return restored_state(lists_, state); }
    void go_on_from(SelfListsState memory) { lists_.set_memory(std::move(memory)); }

private:
    /// Results of a chunk of lists.
    struct Found {
        ContactConstraints constraints;  // where they do not go to the caller's at once
        double smallest = 0.0, safe = 1.0;
    };
    void add_constraints_of(SelfList& list, std::span<const Vec3> positions, double& smallest, ContactConstraints& constraints);
    double clamp(SelfList& list, std::span<const Vec3> from, std::span<const Vec3> to, double safe);
    double measure(SelfList& list, SelfPair& pair, std::span<const Vec3> positions, ContactConstraints& constraints);
    double measure_vertex(SelfList& list, SelfPair& pair, std::span<const Vec3> positions, ContactConstraints& constraints) const;
    double measure_edges(SelfList& list, SelfPair& pair, std::span<const Vec3> positions, ContactConstraints& constraints) const;
    double activation_distance(const SelfList& list, const SelfPair& pair, const EdgeContact& contact) const;
    void settle(const SelfList& list, SelfPairRecord& record, std::span<const Vec3> positions) const;
    /// One contact of a pair: distance, weights of the pair's vertices, direction and the factor of its forces.
    struct Contact {
        double distance;
        std::array<double, 4> weight;
        Vec3 direction;
        int factor;
    };
    void add_constraint(const SelfPair& pair, double activation_distance, const Contact& contact,
                        ContactConstraints& constraints) const;

    SelfContactLists lists_;
    std::vector<SelfList*> near_;  // lists that may have a constraint or clamp a move
    std::vector<Found> found_;
    std::vector<double> friction_;
    std::vector<int> met_triangles_;      // of cloth that meets cloth
    std::vector<int> cloth_of_triangle_;  // of each of them
    std::vector<Stitch> stitches_;
};

}  // namespace percale
