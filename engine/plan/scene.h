#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kernels/compute.h"
#include "model/cloth_model.h"
#include "model/seams.h"
#include "percale/contact.h"
#include "percale/settings.h"
#include "step_plan.h"

namespace percale {

/// Where the vertices of a deforming obstacle's mesh are before its pose, m.
using Shape = std::shared_ptr<const std::vector<Vec3>>;

/// The mesh of a compliant obstacle. Vertices at one place have one number in its triangles.
struct CompliantMesh {
    std::vector<Triangle> triangles;
    std::vector<int> place;  // of each vertex: the first at the same place
    double edge = 0.0;       // m, mean length of the triangles' edges, before the pose
};

/// How far the surface of a compliant obstacle has given way (compliant/). m, before the pose.
struct Compliance {
    std::shared_ptr<const CompliantMesh> mesh = {};  // null: the obstacle is not compliant
    Shape aim = {};                                  // the end shape without deflections
    std::vector<Vec3> deflection = {};               // start_shape minus the shape without deflections; empty: zero
    std::vector<Vec3> next_deflection = {};          // end_shape minus aim, during a step
};

struct ObstacleState {
    std::string name;
    Pose start, end;  // of the coming step
    int triangles = 0;
    double restitution = 0.0;
    double reach = 0.0;   // m, distance of its farthest vertex from the mesh's origin, the pose's scale included
    bool settled = true;  // the detector knows that it stays at `start`

    Shape start_shape = {}, end_shape = {};  // of the coming step; null: it is rigid
    double shape_travel = 0.0;               // m, largest displacement between them, the pose's scale included
    double end_reach = 0.0;                  // m, `reach` at the end of the step, if it deforms

    Compliance compliance = {};
    double friction = 0.0;  // as passed to the detector

    bool deforms() const { return start_shape != end_shape; }
    bool moves() const { return start != end || deforms(); }
    /// Passes to the detector where the obstacle of a number is at the ends of the coming step.
    void pass_to(ContactDetector& detector, int number) const {
        if (start_shape) detector.deform_obstacle(number, *start_shape, *end_shape);
        detector.move_obstacle(number, start, end);
    }
    /// Sets the shape at the end of the step.
    void go_to(Shape shape) {
        double travel = 0.0, farthest = 0.0, before = 0.0;
        for (std::size_t i = 0; i < shape->size(); ++i) {
            travel = std::max(travel, ((*shape)[i] - (*start_shape)[i]).squaredNorm());
            farthest = std::max(farthest, (*shape)[i].squaredNorm());
            before = std::max(before, (*start_shape)[i].squaredNorm());
        }
        end_shape = travel > 0.0 ? std::move(shape) : start_shape;
        shape_travel = start.scale * std::sqrt(travel);
        end_reach = start.scale * std::sqrt(farthest);
        reach = std::max(end_reach, start.scale * std::sqrt(before));
    }
    /// Sets the end shape without deflections.
    void aim_at(Shape shape) {
        if (compliance.mesh && compliance.aim && *compliance.aim == *shape) return;  // resting deflections stay
        if (compliance.mesh) compliance.aim = shape;
        go_to(std::move(shape));
    }
    /// Ends its motion. Deflections return, unless the shape stayed as it was.
    void arrive() {
        start = end;
        if (deforms()) reach = end_reach;
        start_shape = end_shape;
        shape_travel = 0.0;
        auto& [mesh, aim, deflection, next_deflection] = compliance;
        const bool same = next_deflection == deflection;
        deflection = std::move(next_deflection);
        next_deflection.clear();
        if (!deflection.empty() && !same) go_to(aim);
    }
    /// Undoes its motion after a failed step.
    void stay() {
        if (compliance.mesh) go_to(compliance.aim);
        compliance.next_deflection.clear();
    }
};

/// Scripted motion of the coming step.
struct Script {
    AlignedVector<double> free;  // 1, or 0 where pinned and in the padding
    Vec3Arrays pin_targets;      // m, at the end of the coming step; meaningful where pinned
    std::vector<ObstacleState> obstacles;
    std::vector<Seam> seams;
    ClothPairs pairs;  // m, as thicknesses of the model
};

/// All that is fixed while the substeps of a step are solved. Between steps the plan is renewed, with hinges beside pins, and
/// obstacles arrive. The detector remembers its search; its results follow from its input.
struct StepScene {
    Compute compute;
    StepSettings settings;
    ClothModel model;
    Script script;
    StepPlan plan;
    std::unique_ptr<ContactDetector> detector;  // null: no contact

    bool is_free(int vertex) const { return script.free[vertex] > 0.0; }
};

}  // namespace percale
