#include <cstddef>

#include "collision/lists/candidate_lists.h"
#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/collision/scenes.h"
#include "tests/support/saved_bytes.h"

namespace percale::test::candidate_state_test {
namespace {

/// The results of a detector in a step that starts at `from` and would lead to `to`; at the end the cloth is where that led.
struct Answers {
    std::vector<ContactConstraints> constraints;
    double safe = 0.0, smallest = 0.0;
    std::vector<Vec3> end;

    Answers(ContactDetector& detector, const std::vector<Vec3>& from, const std::vector<Vec3>& to) : constraints(3) {
        detector.update_candidates(from, to);
        detector.find_contacts(from, 0.0, constraints[0]);
        safe = detector.collision_free_step_size(from, to, {0.0, 1.0});
        end = between(from, to, safe);
        detector.find_contacts(end, safe, constraints[1]);
        detector.find_contacts(between(from, to, 0.5 * safe), 0.5 * safe, constraints[2]);
        smallest = detector.smallest_distance();
    }
    bool operator==(const Answers& other) const {
        return safe == other.safe && smallest == other.smallest && same_constraints(constraints[0], other.constraints[0]) &&
               same_constraints(constraints[1], other.constraints[1]) && same_constraints(constraints[2], other.constraints[2]);
    }
};

/// Cloth that moves above an obstacle, rests on it now and then, and is hit by it.
struct Walk {
    Steps steps;
    Random random;
    std::vector<Vec3> at;

    Walk(Scene scene, const Backend& backend, unsigned seed) : steps(make_steps(scene, small_sheet(), backend)), random(seed) {
        at = shifted(steps.cloth, {0, 0.25 + 0.5 * sheet_thickness, 0}, 0.1 * sheet_thickness, random);
    }
    std::vector<Vec3> next(int step) {
        std::vector<Vec3> to = at;
        const Vec3 way(0, step % 7 < 4 ? -0.3 * sheet_thickness : 0.25 * sheet_thickness, 0);
        for (Vec3& x : to) x += way + random.point(step % 5 == 0 ? 0.0 : 0.05 * sheet_thickness);
        return step % 6 == 5 ? at : to;
    }
    void move_obstacles(int step) {
        for (MovingMesh& o : steps.obstacles) {
            o.start = o.end;
            if (step % 4 == 3) o.end.translation += random.point(0.2 * sheet_thickness);
        }
        steps.report_poses();
    }
};

/// What a detector holds before it reads a state.
enum class Before { nothing, the_same_clusters, other_clusters };

std::unique_ptr<ContactDetector> copy_of(const Walk& walk, Scene scene, const Backend& backend, const Saved& saved,
                                         Before before) {
    Steps fresh = make_steps(scene, walk.steps.cloth, backend);
    std::vector<Vec3> elsewhere = walk.at;
    if (before == Before::other_clusters) {
        for (Vec3& x : elsewhere) x = Vec3(2.0 + x.z(), 3.0 * x.x(), -x.y());
    }
    if (before != Before::nothing) static_cast<void>(Answers(*fresh.detector, elsewhere, elsewhere));
    restore(*fresh.detector, saved);
    return std::move(fresh.detector);
}

/// The same obstacle motion for all.
void follow(const Walk& walk, ContactDetector& copy) {
    for (std::size_t i = 0; i < walk.steps.obstacles.size(); ++i) {
        copy.move_obstacle(static_cast<int>(i), walk.steps.obstacles[i].start, walk.steps.obstacles[i].end);
    }
}

/// Copies made during the walk, on trees of the backend, follow it; returns the number of contacts.
int check_copies(Scene scene, const Backend& backend) {
    Walk walk(scene, backends()[0], 3);
    std::vector<std::unique_ptr<ContactDetector>> copies;
    int contacts = 0;
    for (int step = 0; step < 24; ++step) {
        if (step % 8 == 0) {
            const auto before = static_cast<Before>(step / 8);
            copies.push_back(copy_of(walk, scene, backend, saved_by(*walk.steps.detector), before));
        }
        walk.move_obstacles(step);
        const std::vector<Vec3> to = walk.next(step);
        const Answers answers(*walk.steps.detector, walk.at, to);
        CAPTURE(backend.name, static_cast<int>(scene), step);
        for (auto& copy : copies) {
            follow(walk, *copy);
            CHECK(Answers(*copy, walk.at, to) == answers);
            CHECK(saved_by(*copy) == saved_by(*walk.steps.detector));
        }
        contacts += static_cast<int>(answers.constraints[1].size());
        walk.at = answers.end;
    }
    return contacts;
}

}  // namespace

TEST_CASE("a detector that reads the state of another answers as that one does, on whatever tree") {
    int contacts = 0;
    for (const Scene scene : {Scene::ball, Scene::box, Scene::spiky, Scene::two, Scene::plane}) {
        for (const Backend& backend : backends()) contacts += check_copies(scene, backend);
    }
    CHECK(contacts > 500);
}

TEST_CASE("a state of other cloth or other obstacles is refused") {
    const Backend backend = backends()[0];
    Walk walk(Scene::box, backend, 1);
    const Answers answers(*walk.steps.detector, walk.at, walk.next(0));
    const Saved saved = saved_by(*walk.steps.detector);
    for (const Scene scene : {Scene::ball, Scene::two}) {
        Steps other = make_steps(scene, walk.steps.cloth, backend);
        CHECK_THROWS_WITH(restore(*other.detector, saved), Catch::Contains("other obstacles"));
    }
    Steps other = make_steps(Scene::box, make_grid(0.4, 0.4, 4, 4), backend);
    CHECK_THROWS_WITH(restore(*other.detector, saved), Catch::Contains("other cloth"));
}

TEST_CASE("a detector's state whose bytes were changed is refused, or taken and answers without harm") {
    Walk walk(Scene::two, backends()[0], 5);
    for (int step = 0; step < 6; ++step) {
        walk.move_obstacles(step);
        const std::vector<Vec3> to = walk.next(step);
        walk.at = Answers(*walk.steps.detector, walk.at, to).end;
    }
    const Saved good = saved_by(*walk.steps.detector);
    Random random(11);
    int refused = 0, taken = 0;
    for (int round = 0; round < 1500; ++round) {
        Saved bad = good;
        const int at = 8 + random.index(static_cast<int>(bad.size()) - 8);
        bad[static_cast<std::size_t>(at)] = static_cast<std::byte>(random.index(256));
        Steps other = make_steps(Scene::two, walk.steps.cloth, backends()[0]);
        try {
            restore(*other.detector, bad);
            ++taken;
            if (taken % 10 == 0) static_cast<void>(Answers(*other.detector, walk.at, walk.at));
        } catch (const SceneError&) {
            ++refused;
        }
    }
    CHECK(refused > 50);
    CHECK(taken > 50);
    CHECK(saved_by(*walk.steps.detector) == good);
}

}  // namespace percale::test::candidate_state_test
