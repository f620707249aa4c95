#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "common/source_place.h"
#include "models/polygon.h"
#include "percale/mesh.h"

// A sewing pattern as plain data: flat panels, where they are placed, and which of their edges are sewn together. Lengths in m.
namespace percale::scenes {

enum class EdgeCurve { line, quadratic, cubic, arc };

/// One edge of a panel, from a corner to another.
struct PanelEdge {
    int from = 0, to = 0;
    EdgeCurve curve = EdgeCurve::line;
    std::vector<Point2>
        control;  // in the panel: of a Bezier curve one or two; of an arc a point halfway along it; of a line none
    std::string label;
};

/// A flat piece of cloth. Its edges follow each other around its outline, the last one ends where the first begins; triangles
/// wind as the outline does.
struct Panel {
    std::string name;
    std::vector<Point2> corners;
    std::vector<PanelEdge> edges;
    Pose pose;             // from the panel, z = 0, to the world
    double wrap = 0.0;     // radius of an upright cylinder around which it is laid before the pose; 0: it stays flat
    bool flipped = false;  // its triangles wind against its outline
    SourcePlace place = {};
};

/// An edge as one side of a seam runs along it.
struct EdgeUse {
    int panel = 0, edge = 0;
    bool reversed = false;  // from its end to its beginning
};

/// Two sides that are sewn together, each one or more edges in a row: they begin together and end together.
struct PatternSeam {
    std::string name;
    std::array<std::vector<EdgeUse>, 2> sides;
    bool gather = false;  // their lengths may differ
    SourcePlace place = {};
};

struct Pattern {
    std::string file;
    std::vector<Panel> panels;
    std::vector<PatternSeam> seams;
};

}  // namespace percale::scenes
