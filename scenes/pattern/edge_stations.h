#pragma once

#include <array>
#include <vector>

#include "pattern/pattern.h"

namespace percale::scenes {

/// Where the edges of a pattern are divided.
struct EdgeStations {
    /// Fractions of the arc length, ascending from 0 to 1; [p][e] holds those of edge e of panel p.
    std::vector<std::vector<std::vector<double>>> shares;

    /// A station of an edge, by its number there.
    struct Place {
        int panel = 0, edge = 0, station = 0;
    };
    /// For each seam the stations that are sewn together, from its beginning to its end.
    std::vector<std::vector<std::array<Place, 2>>> sewn;
};

/// Divides all edges into pieces about as long as `edge_length`, m. Where a corner lies on one side of a seam, the other has a
/// station, too, unless it has a corner within a third of an edge length, which then is sewn to it. A side that is longer by a
/// tenth or more has further stations between those that are sewn. Throws SceneError for an edge that is in two seams.
EdgeStations divide_edges(const Pattern& pattern, double edge_length);

}  // namespace percale::scenes
