#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "model/cloth_state.h"
#include "multipliers.h"
#include "percale/contact.h"

namespace percale {

/// Motion of an obstacle over a whole step: its point that is at p when the stage begins moves by turn p + shift, m.
struct ObstacleFlow {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
    Vec3 shift = Vec3::Zero();
    bool deforms = false;  // none: each of its points goes its own way, as the rows say
};

/// Of an obstacle whose vertices go straight from `start` to `end`, for a stage that begins at `fraction` of the step.
ObstacleFlow obstacle_flow(const Pose& start, const Pose& end, double fraction);

/// What all evaluations of one stage know of friction.
struct FrictionStart {
    const Vectors* positions = nullptr;        // m, when the stage begins
    double fraction = 0.0;                     // of the whole step, then
    std::span<const Grip> grips = {};          // then; sorted by vertex and obstacle
    std::span<const ObstacleFlow> flows = {};  // of each obstacle; those not listed stay
    const ContactMultipliers* held = nullptr;  // of rows between cloths, as set_held leaves them; null: nothing
};

/// A vertex pressed to an obstacle, by all their rows together.
struct Touch {
    int vertex = -1, obstacle = -1;
    int next = -1;                // touch of the same vertex with another obstacle
    Vec3 press = Vec3::Zero();    // N, friction coefficient times normal force
    double reach = 0.0;           // m, slip up to which it sticks
    bool old = false;             // it held on when the stage began
    Vec3 flow = Vec3::Zero();     // m, how far the point held moves in the whole step
    Vec3 carried = Vec3::Zero();  // m N, of a deforming obstacle: sum of the rows' displacements times their press
    double load = 0.0;            // N, sum of the rows' presses likewise
    Vec3 slip = Vec3::Zero();     // m, along the surface, from the point held
    Vec3 heading = Vec3::Zero();  // unit, where the matrix lets it slide; zero: nowhere
};

/// Two cloths that a row presses together.
struct Rub {
    int row = -1;
    double press = 0.0, reach = 0.0;  // N, friction coefficient times normal force; m, slip up to which they stick
    Vec3 slip = Vec3::Zero();         // m, along the contact, of the first side from where the second holds it
    Vec3 moved = Vec3::Zero();        // m, what the stage added to it
};

/// The touches of one evaluation.
struct Touches {
    std::vector<Touch> all;
    std::vector<int> first;  // of each vertex, or -1

    void clear(std::size_t vertices);
    Touch& get(int vertex, int obstacle);
    const Touch* find(int vertex, int obstacle) const;
};

/// Sets flow and slip of a touch whose press is known. A point of a deforming obstacle moves as the points that press do in the
/// mean. For the vertex being at `position` at `fraction` of the step.
void set_slip(const FrictionStart& start, const Vec3& position, double fraction, Touch& touch);

/// Of a row between cloths that presses with `normal_force`, N, the vertices being at `positions`, m.
Rub rub_of(const FrictionStart& start, const ContactRows& rows, int row, double normal_force, const Vectors& positions);

/// Coulomb's law with a spring that sticks: -press/reach slip up to the reach, press against the slip beyond.
Vec3 friction_force(const Touch& touch);
Vec3 friction_force(const Rub& rub);

/// Energy of the springs by which touches and rubs hold, J.
double grip_energy(const Touches& touches);
double grip_energy(std::span<const Rub> rubs);

/// The grips that touches leave behind: of a sliding one the point held is dragged along.
void set_grips(const Touches& touches, std::vector<Grip>& grips);

/// The same of rows between cloths, by their keys and as forces: a row that pressed by N with friction F held at -reach F/(mu N).
void set_held(const ContactRows& rows, std::span<const Rub> rubs, const std::vector<RowForce>& row_forces,
              ContactMultipliers& held);

}  // namespace percale
