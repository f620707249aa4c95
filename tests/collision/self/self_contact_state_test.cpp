#include <cstddef>

#include "collision/self/self_contact_detection.h"
#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/collision/cloths.h"
#include "tests/support/collision/steps.h"
#include "tests/support/saved_bytes.h"

namespace percale::test::self_contact_state_test {
namespace {

SelfContactDetection detection_of(const Cloths& cloths) {
    return {cloths.mesh.triangles, cloths.thickness, cloths.self_contact()};
}

void restore(SelfContactDetection& detection, const Saved& saved) {
    StateReader reader(saved);
    detection.go_on_from(detection.restored(reader));
}

/// One step with all calls; moves `x` to where the clamp leads.
ContactConstraints step(SelfContactDetection& detection, std::vector<Vec3>& x, const std::vector<Vec3>& to) {
    ContactConstraints constraints;
    detection.update_candidates(x, to);
    detection.add_constraints(x, constraints);
    x = between(x, to, detection.collision_free_step_size(x, to));
    constraints.distance.push_back(detection.add_constraints(x, constraints));
    return constraints;
}

std::vector<Vec3> drawn_together(const std::vector<Vec3>& x, Random& random) {
    std::vector<Vec3> to = x;
    for (Vec3& p : to) p += Vec3(0, -0.05 * p.y(), 0) + random.point(0.002);
    return to;
}

}  // namespace

TEST_CASE("contact of cloth with cloth continues in the same bits where its state is read") {
    Random random(2);
    const Cloths cloths = sheet_stack(3, 7, 0.04, 0.02, random);
    SelfContactDetection detection = detection_of(cloths);
    std::vector<SelfContactDetection> copies;
    std::vector<Vec3> x = cloths.mesh.vertices;
    int contacts = 0;
    for (int n = 0; n < 18; ++n) {
        if (n % 6 == 0) restore(copies.emplace_back(detection_of(cloths)), saved_by(detection));
        const std::vector<Vec3> to = drawn_together(x, random), from = x;
        const ContactConstraints constraints = step(detection, x, to);
        contacts += static_cast<int>(constraints.size());
        for (SelfContactDetection& copy : copies) {
            std::vector<Vec3> there = from;
            CHECK(same_constraints(step(copy, there, to), constraints));
            CHECK(same_bits(there, x));
            CHECK(saved_by(copy) == saved_by(detection));
        }
    }
    CHECK(contacts > 100);
}

TEST_CASE("a state of cloth against cloth whose bytes were changed is refused, or taken and answers without harm") {
    Random random(4);
    const Cloths cloths = sheet_stack(2, 5, 0.03, 0.02, random);
    SelfContactDetection detection = detection_of(cloths);
    std::vector<Vec3> x = cloths.mesh.vertices;
    const std::vector<Vec3> to = drawn_together(x, random);
    step(detection, x, to);
    const Saved good = saved_by(detection);
    int refused = 0;
    for (int round = 0; round < 500; ++round) {
        Saved bad = good;
        const int at = random.index(static_cast<int>(bad.size()));
        bad[static_cast<std::size_t>(at)] = static_cast<std::byte>(random.index(256));
        SelfContactDetection other = detection_of(cloths);
        try {
            restore(other, bad);
            if (round % 10 == 0) step(other, x, x);
        } catch (const SceneError&) {
            ++refused;
        }
    }
    CHECK(refused > 20);
    CHECK_THROWS_AS(restore(detection, Saved(good.begin(), good.end() - 1)), SceneError);
}

}  // namespace percale::test::self_contact_state_test
