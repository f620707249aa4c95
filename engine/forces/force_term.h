#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "blocks.h"
#include "kernels/compute.h"
#include "kernels/kernels.h"
#include "model/adjacency.h"
#include "model/cloth_facts.h"
#include "model/cloth_model.h"
#include "model/vec3_arrays.h"
#include "percale/mesh.h"
#include "percale/plan.h"
#include "percale/report.h"
#include "support/list_hash.h"

namespace percale {

/// The springs during one step, in the layout of the adjacency: tension T = k (l - l_rest) + c (v_ij . d), with d = x_ij /
/// |x_ij|.
struct StepSprings {
    const Adjacency* adjacency = nullptr;
    SpringEntries entries;                         // k N/m, l_rest m, c N s/m
    bool velocity_damping = false;                 // there is a c
    AlignedVector<double> stiffness, rest_length;  // of this step, where they are not those of the model
    AlignedVector<double> seam_rest_length;        // m, where seams have changed theirs
    const double* undamped_rest_length = nullptr;  // m, of each place: without damping
    AlignedVector<double> points;                  // work space
};

/// Results of an evaluation: the blocks of the step matrix, and work space.
struct SpringTerms {
    /// kg: -dt^2 Jq - dt Jv between the two vertices of each spring, made positive definite, is a I + w w^T (spring_block).
    AlignedVector<float> values;
    AlignedVector<float> corners;  // couplings between the edges of membrane triangles (CornerFillPass); empty without
    AlignedVector<double> points, motion, scratch;
};

/// The state that springs see; dt in s scales the matrix terms.
struct SpringMotion {
    const Vec3Arrays& positions;
    const Vec3Arrays& velocities;
    double dt;
};

/// One triangle in the air, as it lay when the stage began.
struct WindTriangle {
    Vec3 normal = Vec3::Zero();  // unit; zero if it has no area
    double area = 0.0;           // m^2
};

/// Air around all cloth during one stage.
struct StepWind {
    bool blows = false;                   // false: there is no air, nothing else is set
    Vec3 velocity = Vec3::Zero();         // m/s
    double density = 0.0;                 // kg/m^3
    std::vector<WindTriangle> triangles;  // in the order of the model's
};

/// The state and settings of one evaluation.
struct ForceInput {
    const Compute* compute = nullptr;
    const ClothModel* model = nullptr;
    const StepSprings* springs = nullptr;
    const Vec3Arrays* positions = nullptr;
    const Vec3Arrays* velocities = nullptr;
    Vec3 gravity = Vec3::Zero();
    const StepWind* wind = nullptr;  // null: there is no air
    double dt = 0.0;
    bool with_matrix = false;
};

/// Forces of one state and the parts of the step matrix.
struct Forces {
    Vec3Arrays total;  // N
    SpringTerms spring_terms;
    ForceBlocks blocks;       // of the matrix, all but springs
    double wind_power = 0.0;  // W, of the air on the cloth
    double potential = 0.0;   // J, sum over the terms
};

/// The arguments of energies.
struct StoredInput {
    const ClothModel& model;
    const Vec3Arrays& positions;               // m
    std::span<const double> rest_length = {};  // ClothState::rest_length
    Vec3 gravity = Vec3::Zero();
};

/// One force on the cloth. total_force.cpp lists all of them; code that evaluates, measures, checks, saves or plans forces uses
/// that list. The ledger (substep/) computes what a term takes beyond the change of its energy from its force and its energy
/// (shape_loss); it takes damping of springs (spring_loss.h) and the power of the wind by name.
class ForceTerm {
public:
    virtual ~ForceTerm() = default;
    virtual std::string_view name() const = 0;

    /// Whether the scene has this force. Otherwise only its reasons are requested.
    virtual bool acts(const ForceInput& input) const = 0;

    /// forces.total += its forces, N, and with input.with_matrix its part of the matrix -dt^2 Jq - dt Jv, as springs
    /// (SpringTerms) or as blocks (ForceBlocks), both seen by every solver, made positive semidefinite except for loads, which
    /// are complete. Returns its potential, J: the forces are minus its gradient with respect to the positions at the end of dt.
    virtual double add(const ForceInput& input, Forces& forces) const = 0;

    /// The entry of the energies in which its stored energy is counted; null: it stores nothing.
    virtual double StepEnergy::*entry() const { return nullptr; }
    virtual double energy(const StoredInput&) const { return 0.0; }

    // Properties for check_derivatives.
    virtual bool is_internal() const { return true; }    // the forces add up to no force and no moment
    virtual bool is_in_matrix() const { return true; }   // `add` makes a part of the matrix
    virtual bool may_be_below() const { return false; }  // the matrix, where inexact; else it is an upper bound
    /// Fills in what this term reads from earlier ones of the list, so that it can be evaluated alone.
    virtual void stand_alone(const ForceInput&, Forces&) const {}
    /// exact[i] = false for vertices at which the matrix, added at this state, is not the derivative for moves by `reach`, m.
    virtual void mark_inexact(const ForceInput&, const Forces&, double /*reach*/, std::vector<bool>& /*exact*/) const {}

    /// Hashes what a saved state's cloth must have in common with the one into which it is restored.
    virtual void identify(const ClothModel&, ListHash&) const {}

    /// Reasons why the plan leaves it, or parts of it, out of the scene.
    virtual void add_skips(const ForceFacts&, std::vector<Skip>&) const {}
};

}  // namespace percale
