#include "engine/contact/contact_secants.h"

#include <algorithm>
#include <cmath>

#include "tests/support/catch.h"

namespace percale::test::contact_secants_test {
namespace {

/// One vertex of mass m at a distance from a plane below it, with the force of contact and without friction.
struct OnPlane {
    double mass = 1e-3, h = 0.01, thickness = 0.002;
    ContactStiffness stiffness{.quadratic = 5.0, .quartic = 3e4};
    AlignedVector<double> free{1.0};
    std::vector<double> loads;
    ContactConstraints constraints;
    ContactTerms terms;
    std::vector<ConstraintForce> forces;
    Vec3Arrays residual;

    /// The other forces press with `load`, N: r = h (load - F).
    void put(double distance, double load) {
        constraints.clear();
        terms.clear();
        constraints.vertex.push_back({0, -1, -1, -1});
        constraints.weight.push_back({1.0, 0.0, 0.0, 0.0});
        constraints.direction.emplace_back(0.0, 1.0, 0.0);
        constraints.distance.push_back(distance);
        constraints.thickness.push_back(thickness);
        const ContactPotential potential = contact_potential(distance, thickness, stiffness);
        forces = {{.normal = potential.slope, .stiffness = potential.curvature}};
        terms.stiffness = {stiffness};
        CoupledBlock block{.vertex = constraints.vertex[0], .weight = constraints.weight[0], .k = {}, .constraint = 0};
        add_normal_block(block.k, h * h * potential.curvature, constraints.direction[0]);
        terms.blocks.push_back(block);
        residual.resize(1);
        residual.set(0, Vec3(0.0, h * (load - potential.slope), 0.0));
    }
    /// N/m, of the matrix.
    double softened() {
        soften_contact({constraints, forces, residual, free, h}, terms, loads);
        return terms.blocks[0].k[3] / (h * h);
    }
    double tangent() const { return forces[0].stiffness; }

    /// Iterations of Newton's method until the force is balanced to 1e-6 of what carries the vertex, that comes down at a
    /// speed of `speed` from a distance; from as deep as it would come without contact, but not below a tenth of the thickness.
    int iterations(double speed, bool soften) {
        double distance = 0.1 * thickness;
        const double free_fall = thickness - h * speed;
        for (int n = 0; n < 100; ++n) {
            put(distance, mass * (distance - free_fall) / (h * h));
            if (std::abs(residual.at(0).y()) < 1e-6 * mass * speed) return n;
            const double stiff = soften ? softened() : tangent();
            distance -= residual.at(0).y() / h / (mass / (h * h) + stiff);
        }
        return 100;
    }
};

}  // namespace

TEST_CASE("The matrix of contact in balance, or pressed by more than its force, has its tangent") {
    OnPlane vertex;
    for (const double depth : {0.05, 0.3, 0.7}) {
        const double distance = (1.0 - depth) * vertex.thickness;
        const double force = contact_potential(distance, vertex.thickness, vertex.stiffness).slope;
        for (const double ratio : {1.0, 1.5, 100.0}) {
            vertex.put(distance, ratio * force);
            CHECK(vertex.softened() == Approx(vertex.tangent()));
        }
    }
}

TEST_CASE("The matrix of contact far out of balance leads it out to half of its depth") {
    OnPlane vertex;
    for (const double depth : {0.05, 0.3, 0.7}) {
        const double distance = (1.0 - depth) * vertex.thickness;
        vertex.put(distance, 0.0);
        const double force = vertex.forces[0].normal;
        const double half = contact_potential((1.0 - 0.5 * depth) * vertex.thickness, vertex.thickness, vertex.stiffness).slope;
        CHECK(vertex.softened() == Approx((force - half) / (0.5 * depth * vertex.thickness)));
        CHECK(vertex.softened() < vertex.tangent());
    }
}

TEST_CASE("The matrix of contact stiffens with what the force has to carry, up to the tangent from half of it on") {
    OnPlane vertex;
    double last = 0.0;
    for (const double share : {-1.0, 0.0, 0.3, 0.6, 0.9, 0.98}) {
        vertex.put(0.5 * vertex.thickness, 0.0);
        const double force = vertex.forces[0].normal;
        vertex.put(0.5 * vertex.thickness, share * force);
        const double softened = vertex.softened();
        CHECK(softened > 0.0);
        CHECK(softened >= last);
        CHECK(softened <= vertex.tangent() * (1.0 + 1e-12));
        if (share >= 0.5) CHECK(softened == Approx(vertex.tangent()));
        last = softened;
    }
}

TEST_CASE("A prescribed vertex, whose residual is 0, leaves the tangent to constraints that move no other") {
    OnPlane vertex;
    vertex.free = {0.0};
    vertex.put(0.5 * vertex.thickness, 0.0);
    CHECK(vertex.softened() == Approx(vertex.tangent()));
}

TEST_CASE("Newton's method leaves contact that is far too deep in half of the iterations") {
    OnPlane vertex;
    for (const double speed : {0.01, 0.1, 1.0}) {
        const int with = vertex.iterations(speed, true), without = vertex.iterations(speed, false);
        CHECK(with < 8);
        CHECK(2 * with <= without + 2);
    }
}

}  // namespace percale::test::contact_secants_test
