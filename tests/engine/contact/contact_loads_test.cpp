#include "engine/contact/contact_loads.h"

#include "tests/support/catch.h"
#include "tests/support/contact_rows.h"

namespace percale::test::contact_loads_test {
namespace {

struct Constraints {
    ContactConstraints constraints;
    ContactTerms terms;
    std::vector<ConstraintForce> forces;

    void add(const std::array<int, 4>& vertex, const std::array<double, 4>& weight, int obstacle, const ConstraintForce& force) {
        add_constraint(vertex, weight, obstacle, constraints);
        forces.push_back(force);
    }
    std::vector<ContactLoad> loads() const { return contact_loads(constraints, terms, forces); }
};

}  // namespace

TEST_CASE("Constraints distribute their force to their vertices by weight, summed by vertex and obstacle") {
    Constraints r;
    r.add({4, 2, -1, -1}, {0.25, 0.75, 0, 0}, 1, {.normal = 8.0, .friction = Vec3(4, 0, 0)});
    r.add({2, -1, -1, -1}, {1, 0, 0, 0}, 0, {.normal = 1.0});
    r.add({2, -1, -1, -1}, {1, 0, 0, 0}, 1, {.normal = 2.0});
    const std::vector<ContactLoad> loads = r.loads();
    REQUIRE(loads.size() == 3);
    CHECK((loads[0].vertex == 2 && loads[0].obstacle == 0));
    CHECK(loads[0].force() == Vec3(0, 1, 0));
    CHECK((loads[1].vertex == 2 && loads[1].obstacle == 1));
    CHECK(loads[1].normal == Vec3(0, 8, 0));
    CHECK(loads[1].friction == Vec3(3, 0, 0));
    CHECK((loads[2].vertex == 4 && loads[2].obstacle == 1));
    CHECK(loads[2].force() == Vec3(1, 2, 0));
}

TEST_CASE("Constraints between cloths, and constraints that do not push, load nothing") {
    Constraints r;
    r.add({0, 1, 2, 3}, {1, -0.5, -0.25, -0.25}, -1, {.normal = 8.0});
    r.add({0, -1, -1, -1}, {1, 0, 0, 0}, 0, {.normal = 0.0});
    CHECK(r.loads().empty());
}

TEST_CASE("A load's obstacle point is the mean of the points that press its vertex, weighted by normal force") {
    Constraints r;
    r.add({4, 2, -1, -1}, {0.25, 0.75, 0, 0}, 1, {.normal = 8.0});
    r.add({2, -1, -1, -1}, {1, 0, 0, 0}, 1, {.normal = 2.0});
    r.add({2, -1, -1, -1}, {1, 0, 0, 0}, 0, {.normal = 5.0});
    r.constraints.obstacle_point = {Vec3(1, 0, 0), Vec3(0, 4, 0), Vec3(0, 0, 3)};
    const std::vector<ContactLoad> loads = r.loads();
    REQUIRE(loads.size() == 3);
    CHECK(loads[0].obstacle_point == Vec3(0, 0, 3));
    CHECK((loads[1].obstacle_point - Vec3(0.75, 1.0, 0)).norm() < 1e-15);  // 6 N and 2 N
    CHECK(loads[2].obstacle_point == Vec3(1, 0, 0));
}

TEST_CASE("Loads of one obstacle are the loads of all obstacles restricted to it") {
    Constraints r;
    r.add({4, 2, -1, -1}, {0.25, 0.75, 0, 0}, 1, {.normal = 8.0, .friction = Vec3(4, 0, 0)});
    r.add({2, -1, -1, -1}, {1, 0, 0, 0}, 0, {.normal = 1.0});
    r.add({0, 1, 2, 3}, {1, -0.5, -0.25, -0.25}, -1, {.normal = 8.0});
    r.terms.friction_contacts.clear(8);
    for (const int obstacle : {0, 1}) {
        FrictionContact& contact = r.terms.friction_contacts.get(2, obstacle);
        contact.friction_limit = Vec3(0, 3 + obstacle, 0);
        contact.stick_threshold = 1e-4;
        contact.slip = Vec3(2e-4, 0, 0);
    }
    for (const int obstacle : {0, 1, 2}) {
        const std::vector<ContactLoad> loads = contact_loads(r.constraints, r.terms, r.forces, obstacle);
        std::size_t count = 0;
        for (const ContactLoad& load : r.loads()) {
            if (load.obstacle != obstacle) continue;
            REQUIRE(count < loads.size());
            CHECK(loads[count].vertex == load.vertex);
            CHECK(loads[count++].force() == load.force());
        }
        CHECK(count == loads.size());
    }
}

TEST_CASE("Friction on vertices is that of their friction contacts") {
    Constraints r;
    r.add({3, -1, -1, -1}, {1, 0, 0, 0}, 0, {.normal = 10.0});
    r.terms.friction_contacts.clear(8);
    FrictionContact& contact = r.terms.friction_contacts.get(3, 0);
    contact.friction_limit = Vec3(0, 3, 0);
    contact.stick_threshold = 1e-4;
    contact.slip = Vec3(2e-4, 0, 0);
    const std::vector<ContactLoad> loads = r.loads();
    REQUIRE(loads.size() == 1);
    CHECK(loads[0].normal == Vec3(0, 10, 0));
    CHECK((loads[0].friction - Vec3(-3, 0, 0)).norm() < 1e-14);
}

}  // namespace percale::test::contact_loads_test
