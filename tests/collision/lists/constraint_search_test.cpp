#include "collision/lists/constraint_search.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "collision/lists/obstacle_terms.h"
#include "tests/support/catch.h"
#include "tests/support/collision/pairs.h"
#include "tests/support/collision/scenes.h"
#include "tests/support/random.h"

namespace percale::test::constraint_search_test {
namespace {

/// Obstacle, feature, distance.
using Contact = std::tuple<int, int, double>;

/// A cloth edge may be named the other way round, which costs a rounding.
bool nearly_same(const Contact& a, const Contact& b) {
    return std::get<0>(a) == std::get<0>(b) && std::get<1>(a) == std::get<1>(b) &&
           std::abs(std::get<2>(a) - std::get<2>(b)) < 1e-14;
}

void add_terms(const ContactPair& pair, std::span<const Vec3> x, const Obstacle& obstacle, double fraction,
               std::vector<Contact>& contacts) {
    const SurfaceTerms terms = obstacle_terms(pair, x, obstacle, fraction, sheet_thickness);
    for (const SurfaceTerm& term : std::span(terms.terms).first(terms.count))
        contacts.emplace_back(pair.obstacle, contact_places * pair.feature + term.place, term.distance);
}

/// Contacts without lists, boxes or trees; not those of cloth faces, whose edges' owners are the lists' choice.
std::vector<Contact> contacts_of_all_pairs(const Steps& steps, std::span<const Vec3> x, double fraction) {
    std::vector<Contact> contacts;
    for (int o = 0; o < static_cast<int>(steps.obstacles.size()); ++o) {
        Obstacle obstacle(steps.obstacles[o].mesh, {}, 0.0, make_brute_force_tree);
        obstacle.move(steps.obstacles[o].start, steps.obstacles[o].end);
        for (ContactPair pair : all_pairs(steps.cloth, obstacle, true)) {
            pair.obstacle = o;
            if (pair.kind == PairKind::vertex_face) add_terms(pair, x, obstacle, fraction, contacts);
            if (pair.kind != PairKind::edge_edge) continue;
            const PairContact contact = pair_contact(pair, x, obstacle, fraction);
            if (contact.distance < sheet_thickness && contact.local_minimum)
                contacts.emplace_back(o, pair.feature, contact.distance);
        }
    }
    std::sort(contacts.begin(), contacts.end());
    return contacts;
}

}  // namespace

TEST_CASE("constraints are those of all pairs of features that are near, at any fraction of the step") {
    const Scene scene = GENERATE(Scene::ball, Scene::box, Scene::spiky, Scene::two, Scene::single_triangle);
    const bool moving = GENERATE(false, true);
    Random random(320 + static_cast<int>(scene));
    const TriangleMesh sheet = make_grid(0.4, 0.4, 3, 3);
    Steps steps = make_steps(scene, sheet, backends()[0]);
    long expected_constraints = 0;
    for (int state = 0; state < 6; ++state) {
        if (moving) set_poses(steps, true, random);
        const double fraction = random.number(0.0, 1.0);
        const auto x = shifted(placed(sheet, random.pose(0.0)), random.point(0.25), 0.03, random);
        const std::vector<Contact> expected = contacts_of_all_pairs(steps, x, fraction);
        ContactConstraints constraints;
        steps.detector->update_candidates(x, x);
        steps.detector->find_contacts(x, fraction, constraints);
        std::vector<Contact> found;
        for (std::size_t i = 0; i < constraints.size(); ++i) {
            if (constraints.vertex[i][2] < 0)
                found.push_back({constraints.obstacle[i], constraints.feature[i], constraints.distance[i]});
        }
        std::sort(found.begin(), found.end());
        CHECK(std::equal(found.begin(), found.end(), expected.begin(), expected.end(), nearly_same));
        expected_constraints += static_cast<long>(expected.size());
    }
    CHECK(expected_constraints > 0);
}

}  // namespace percale::test::constraint_search_test
