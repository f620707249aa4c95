#pragma once

#include <string>

namespace percale {

/// Joins a vertex of one cloth to a point of another, or of the same: x_vertex and (1 - share) x_from + share x_to. A vertex is
/// joined to a vertex by from == to, whatever the share.
struct Stitch {
    int vertex = -1;
    int from = -1, to = -1;
    double share = 0.0;  // 0 ... 1

    bool joins_vertices() const { return from == to || share == 0.0 || share == 1.0; }
    /// The vertex to which `vertex` is joined, if it is joined to a vertex.
    int other() const { return share == 1.0 ? to : from; }
    bool operator==(const Stitch&) const = default;
};

struct SeamSettings {
    double after = 0.0;         // s from now until closing begins, 0 ... 1e6; before, stitches keep their lengths; nothing sleeps
    double over = 1.0;          // s, duration of closing, 0 ... 1e6
    double stiffness = 1000.0;  // N/m of each stitch, 1e-3 ... 1e9
    /// Whether the cloths that it joins meet each other, and themselves, before it has closed. If not, nor do cloths that such
    /// seams join with them, nor those of other layers (Simulation::set_layer), which would be caught in it; crossings are then
    /// untangled (Simulation::prepare). For panels that start over each other or are sewn around another garment.
    bool contact_while_closing = true;
    /// Whether no gap is left at rest: each step adds to the force of a closed stitch, up to `stiffness` times 1 cm, until its
    /// sides meet. Needs backward Euler or TR-BDF2: without numerical damping stitches would swing.
    bool weld = false;
    std::string name = "seam";  // for messages
};

}  // namespace percale
