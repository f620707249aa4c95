#pragma once

#include <array>
#include <span>
#include <vector>

#include "coulomb.h"
#include "model/vec3_arrays.h"
#include "percale/contact.h"

namespace percale {

/// Whether the first side of a constraint or an anchor between cloths, with these weights, is a vertex; else both are points of
/// edges.
inline bool is_of_vertex(const std::array<double, 4>& weight) { return weight[1] < 0.0; }

/// Friction of a constraint between two cloths.
struct ClothFrictionContact {
    int constraint = -1;
    std::array<int, 4> vertex{-1, -1, -1, -1};  // material points by which `moved` is measured: those of its anchor, or its own
    std::array<double, 4> weight{};
    bool had_anchor = false;    // when the stage began
    CoulombLaw law = {};        // with a limit below 0 where the constraint is subtracted (ContactConstraints::mollifier)
    Vec3 slip = Vec3::Zero();   // m, tangential, of the first side from its anchor on the second
    Vec3 moved = Vec3::Zero();  // m, the part of the slip that the stage added
};

/// Where two cloths stick to each other: the material points of both sides, by vertices and weights as in a contact constraint
/// (> 0 on the first side, < 0 on the second, sum 0), and how far the first has moved along the second from where it stuck.
struct ClothAnchor {
    std::array<int, 4> vertex{-1, -1, -1, -1};
    std::array<double, 4> weight{};
    Vec3 normal = Vec3::Zero();   // unit, second side towards first
    Vec3 stretch = Vec3::Zero();  // m, world, tangential
};

/// The anchors at the start of a stage. They are found by what is in contact, not by its features: those of a vertex by the
/// vertex, those of edges by the material points nearest to the constraint.
class ClothAnchors {
public:
    void set(std::span<const ClothAnchor> anchors);
    /// The anchor of a constraint between cloths, whose direction differs by less than 60 degrees; null: it has none. `start`: m,
    /// the cloth at the start of the stage.
    const ClothAnchor* find(const ContactConstraints& constraints, std::size_t constraint, const Vec3Arrays& start) const;

private:
    struct Entry {
        int vertex = -1, anchor = -1;
    };

    std::vector<ClothAnchor> anchors_;
    std::vector<Entry> entries_;  // ascending; of a vertex, or of all ends of both edges
};

/// Sets the anchors that friction contacts leave behind. While a contact sticks, its anchor keeps its material points; where it
/// slides, the anchor is dragged along: its points are those of the constraint. A vertex keeps one anchor a side, where it is
/// pressed hardest.
class AnchorKeeper {
public:
    void keep(const ContactConstraints& constraints, std::span<const ClothFrictionContact> contacts,
              std::vector<ClothAnchor>& anchors);

private:
    /// A friction contact and the anchor that it leaves.
    struct Candidate {
        ClothAnchor anchor;
        double limit = 0.0;  // N
    };
    static bool comes_before(const Candidate& a, const Candidate& b);

    std::vector<Candidate> candidates_;
};

}  // namespace percale
