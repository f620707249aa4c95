#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cloth_anchors.h"
#include "coulomb.h"
#include "model/cloth_state.h"
#include "percale/contact.h"

namespace percale {

/// Displacement of an obstacle over the whole step: u(p) = turn p + shift, m, for its point that is at p as the stage begins.
struct ObstacleMotion {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
    Vec3 shift = Vec3::Zero();
    bool deforms = false;  // no rigid motion: each point has its own displacement, which the constraints hold
};

/// The motion of an obstacle with vertices on straight lines from `start` to `end`; the stage begins at `fraction` of the step.
ObstacleMotion obstacle_motion(const Pose& start, const Pose& end, double fraction);

/// The data of friction that all evaluations of one stage share.
struct FrictionStart {
    const Vec3Arrays* positions = nullptr;                  // m, at the start of the stage
    double fraction = 0.0;                                  // of the whole step, at the start of the stage
    std::span<const StickAnchor> stick_anchors = {};        // at the start of the stage; sorted by vertex and obstacle
    std::span<const ObstacleMotion> obstacle_motions = {};  // of each obstacle; those beyond the list are at rest
    const ClothAnchors* cloth_anchors = nullptr;            // between cloths, likewise; null: none
};

/// A vertex in contact with an obstacle: the sum over all constraints between them. `friction_limit` is a vector, the sum of
/// their mu N n by weight, with opposed normals flipped: its norm is the limit, its direction the contact normal.
struct FrictionContact {
    int vertex = -1, obstacle = -1;
    int next = -1;                              // friction contact of the same vertex with another obstacle
    Vec3 friction_limit = Vec3::Zero();         // N, sum of mu N n, see above
    double stick_threshold = 0.0;               // m, slip up to which it sticks
    bool had_anchor = false;                    // it had a stick anchor when the stage began
    Vec3 obstacle_displacement = Vec3::Zero();  // m, displacement of the anchor's point in the whole step
    Vec3 carried = Vec3::Zero();                // m N, of a deforming obstacle: sum of obstacle displacements times normal forces
    double load = 0.0;                          // N, sum of the normal forces, those subtracted below 0
    double pressed = 0.0;                       // N, sum of those above 0
    Vec3 slip = Vec3::Zero();                   // m, tangential, from the stick anchor
    Vec3 slip_direction = Vec3::Zero();         // unit, in which the tangent stiffness is dropped (active set); zero: the
                                                // matrix treats the contact as sticking, also beyond the threshold

    CoulombLaw law() const { return {friction_limit.norm(), stick_threshold}; }
};

/// The friction contacts of one evaluation.
struct FrictionContacts {
    std::vector<FrictionContact> all;
    std::vector<int> first;  // of each vertex, or -1

    void clear(std::size_t vertices);
    FrictionContact& get(int vertex, int obstacle);
    const FrictionContact* find(int vertex, int obstacle) const;
};

/// Sets the obstacle displacement and the slip of a friction contact with a known friction limit, for the vertex at `position` at
/// `fraction` of the step. A point of a deforming obstacle moves by the mean of the pressing points, weighted by normal force.
void set_slip(const FrictionStart& start, const Vec3& position, double fraction, FrictionContact& contact);

/// The friction of a constraint between cloths with a normal force of `normal_force`, N, and vertices at `positions`, m.
ClothFrictionContact cloth_friction_contact(const FrictionStart& start, const ContactConstraints& constraints, int constraint,
                                            double normal_force, const Vec3Arrays& positions);

/// Energy of the springs by which friction contacts stick, J.
double stick_energy(const FrictionContacts& friction_contacts);
double stick_energy(std::span<const ClothFrictionContact> cloth_friction_contacts);

/// Sets the stick anchors that friction contacts leave behind. A sliding contact drags its anchor along.
void set_stick_anchors(const FrictionContacts& friction_contacts, std::vector<StickAnchor>& stick_anchors);

}  // namespace percale
