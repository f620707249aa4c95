#pragma once

#include <span>
#include <utility>
#include <vector>

#include "percale/contact.h"
#include "self/self_contact_state.h"

namespace percale {

/// Contact of cloth with cloth: candidate lists, rows and cuts.
class SelfContactDetection {
public:
    SelfContactDetection(std::span<const Triangle> triangles, std::span<const double> vertex_thickness, const SelfContact& cloth);

    /// The triangles of cloth that meets cloth.
    std::vector<Triangle> triangles() const;
    std::span<const Stitch> stitches() const { return stitches_; }
    /// Which of them meet.
    MeetingCloth meeting() const { return {cloth_of_triangle_, &lists_.cloth_pairs()}; }

    /// The first pair of cloth triangles that cross, or touch without being neighbours; exact.
    StartFault check_start(std::span<const Vec3> positions) const;

    /// As those of ContactDetector, by threads or, without any, by the caller's.
    void refresh(std::span<const Vec3> start, std::span<const Vec3> predicted, Workers* workers = nullptr);
    double largest_safe_fraction(std::span<const Vec3> from, std::span<const Vec3> to, Workers* workers = nullptr);

    /// Appends rows; returns the smallest distance of those, m, or infinity.
    double add_rows(std::span<const Vec3> positions, ContactRows& rows, Workers* workers = nullptr);

    /// As those of self_contact_state.h.
    void save(StateWriter& state) const { percale::save(lists_, state); }
    SelfListsMemory restored(StateReader& state) const { return restored_memory(lists_, state); }
    void go_on_from(SelfListsMemory memory) { lists_.set_memory(std::move(memory)); }

private:
    /// What a stretch of lists finds.
    struct Found {
        ContactRows rows;  // where they are not wanted elsewhere
        double smallest = 0.0, safe = 1.0;
    };
    void add_rows_of(SelfList& list, std::span<const Vec3> positions, double& smallest, ContactRows& rows);
    double cut(SelfList& list, std::span<const Vec3> from, std::span<const Vec3> to, double safe);
    double measure(SelfList& list, SelfPair& pair, std::span<const Vec3> positions, ContactRows& rows);
    void add_row(const SelfPair& pair, double zone, const SelfPairContact& contact, ContactRows& rows) const;

    SelfContactLists lists_;
    std::vector<SelfList*> near_;  // lists that may have a row, or cut a move
    std::vector<Found> found_;
    std::vector<double> friction_;
    std::vector<int> met_triangles_;      // of cloth that meets cloth
    std::vector<int> cloth_of_triangle_;  // of each of them
    std::vector<Stitch> stitches_;
};

}  // namespace percale
