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
#include "model/vectors.h"
#include "percale/mesh.h"
#include "percale/plan.h"
#include "percale/report.h"
#include "support/list_hash.h"

namespace percale {

/// What the springs are during one step, in the layout of the adjacency: tension T = k (l - l_rest) + c (v_ij . d), with
/// d = x_ij / |x_ij|.
struct StepSprings {
    const Adjacency* adjacency = nullptr;
    SpringEntries entries;                         // k N/m, l_rest m, c N s/m
    bool velocity_damping = false;                 // there is a c
    AlignedVector<double> stiffness, rest_length;  // of this step, where they are not those of the model
    AlignedVector<double> seam_rest_length;        // m, where seams have changed theirs
    const double* undamped_rest_length = nullptr;  // m, of each place: without damping
    AlignedVector<double> points;                  // work space
};

/// What an evaluation leaves behind: the blocks of the step matrix, and work space.
struct SpringTerms {
    /// kg: -dt^2 Jq - dt Jv between the two vertices of each spring, made positive definite, is a I + w w^T (spring_block).
    AlignedVector<float> values;
    AlignedVector<float> corners;  // what couples the edges of membrane triangles (CornerFillPass); empty without
    AlignedVector<double> points, motion, scratch;
};

/// The state that springs see; dt in s scales the matrix terms.
struct SpringMotion {
    const Vectors& positions;
    const Vectors& velocities;
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

/// What the wind leaves behind besides forces.
struct WindTerms {
    double power = 0.0;                  // W, of the air on the cloth
    double potential = 0.0;              // J, dt times the dissipation potential
    std::vector<SymmetricBlock> blocks;  // kg, -dt Jv of each vertex
};

/// What forces act on in one evaluation.
struct ForceInput {
    const Compute* compute = nullptr;
    const ClothModel* model = nullptr;
    const StepSprings* springs = nullptr;
    const Vectors* positions = nullptr;
    const Vectors* velocities = nullptr;
    Vec3 gravity = Vec3::Zero();
    const StepWind* wind = nullptr;  // null: there is no air
    double dt = 0.0;
    bool with_matrix = false;
};

/// Forces of one state and what the step matrix is made of.
struct Forces {
    Vectors total;  // N
    SpringTerms spring_terms;
    WindTerms wind;
    std::vector<EnclosedBlock> enclosed;
    double potential = 0.0;  // J, the sum of what the terms return
};

/// What energies are functions of.
struct StoredInput {
    const ClothModel& model;
    const Vectors& positions;                  // m
    std::span<const double> rest_length = {};  // ClothState::rest_length
    Vec3 gravity = Vec3::Zero();
};

/// One force on the cloth. total_force.cpp lists all of them; who evaluates, measures, checks, saves or plans forces goes through
/// that list. The ledger (span/) finds what a term takes beyond the change of its energy from its force and its energy
/// (shape_loss); damping of springs (spring_loss.h) and the power of the wind it asks for by name.
class ForceTerm {
public:
    virtual ~ForceTerm() = default;
    virtual std::string_view name() const = 0;

    /// Whether the scene has it. Where not, nothing else is asked of it but reasons.
    virtual bool acts(const ForceInput& input) const = 0;

    /// forces.total += its forces, N, and with input.with_matrix its part of the matrix -dt^2 Jq - dt Jv, made positive
    /// semidefinite but for enclosed blocks, which are whole. Returns its potential, J: what the forces are minus the gradient
    /// of, by the positions at the end of dt.
    virtual double add(const ForceInput& input, Forces& forces) const = 0;

    /// The entry of the energies in which what it stores is counted; null: it stores nothing.
    virtual double StepEnergy::*entry() const { return nullptr; }
    virtual double energy(const StoredInput&) const { return 0.0; }

    // What check_derivatives asks for.
    virtual bool is_internal() const { return true; }    // the forces add up to no force and no moment
    virtual bool is_in_matrix() const { return true; }   // `add` makes a part of the matrix
    virtual bool may_be_below() const { return false; }  // where inexact; else the matrix bounds the derivative from above
    /// Fills in what this term reads from earlier ones of the list, so that it can be evaluated alone.
    virtual void stand_alone(const ForceInput&, Forces&) const {}
    /// exact[i] = false for vertices at which the matrix, added at this state, is not the derivative for moves by `reach`, m.
    virtual void mark_inexact(const ForceInput&, const Forces&, double /*reach*/, std::vector<bool>& /*exact*/) const {}

    /// What a saved state's cloth must have in common with the one it is restored into.
    virtual void identify(const ClothModel&, ListHash&) const {}

    /// Why the plan leaves it out of the scene, or parts of it.
    virtual void add_skips(const ForceFacts&, std::vector<Skip>&) const {}
};

}  // namespace percale
