#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <string>

#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/stepped_scene.h"

// Contact leaves out faces, edges and vertices of obstacles that cloth cannot reach (collision/README.md). Cloth is thrown at
// bodies on which it would reach them if the reasons were wrong.
namespace percale::test::left_out_contacts_test {
namespace {

struct Body {
    std::string kind;
    TriangleMesh mesh;
};

/// The mesh with one half in a plane: its inner edges are flat, those of the border are not.
TriangleMesh half_flat(TriangleMesh sheet) {
    for (Vec3& x : sheet.vertices)
        if (x.x() < 0.0) x.y() = 0.0;
    return sheet;
}

/// The mesh with every second triangle twice or three times, some turned over.
TriangleMesh repeated(TriangleMesh mesh, Random& random) {
    const std::vector<Triangle> once = mesh.triangles;
    for (const Triangle& t : once) {
        for (int more = random.index(4) - 1; more > 0; --more)
            mesh.triangles.push_back(random.index(2) == 0 ? Triangle{t[1], t[2], t[0]} : Triangle{t[1], t[0], t[2]});
    }
    return mesh;
}

Body draw_body(Random& random) {
    const auto seed = static_cast<unsigned>(random.index(100000));
    switch (random.index(9)) {
        case 0:
            return {"tangled ball", tangled_ball(0.2, 1, random.number(0.05, 0.25), seed)};
        case 1:
            return {"fine tangled ball", tangled_ball(0.2, 2, random.number(0.05, 0.15), seed)};
        case 2:
            return {"pierced ball", pierced_ball(0.2, random)};
        case 3:
            return {"bent tube", bent_tube(random)};
        case 4:
            return {"touching boxes", touching_boxes(random)};
        case 5:
            return {"inside out", inside_out(spiky_ball(0.2, 1, 0.5, seed))};
        case 6:
            return {"open sheet with flat edges", half_flat(crumpled_sheet(0.5, 6, 0.05, random))};
        case 7:
            return {"repeated triangles", repeated(spiky_ball(0.2, 1, 0.5, seed), random)};
        default:
            return {"overlapping", joined(spiky_ball(0.2, 1, 0.6, seed), moved(l_solid(), {-1.0, -1.05, -0.5}))};
    }
}

StepSettings draw_settings(ContactResponse response, Random& random) {
    StepSettings settings{.time_step = 1.0 / random.decades(30.0, 240.0)};
    settings.contact_response = response;
    // Projection takes backward Euler alone.
    if (response == ContactResponse::penalty && random.index(2) == 0) settings.scheme = Scheme::tr_bdf2;
    return settings;
}

/// Cloth that flies at the body from a place clear of it, half of the time held at a corner.
SteppedScene throw_cloth(const Body& body, const StepSettings& settings, Random& random) {
    const int count = 9 + random.index(12);
    const TriangleMesh sheet = make_grid(0.6, 0.6, count, count);
    for (double reach = 0.1;; reach += 0.02) {
        const Vec3 from = random.unit();
        SteppedScene scene(placed(sheet, {.translation = reach * from, .rotation = random.rotation(), .scale = 1.0}), settings,
                           random.decades(2e-3, 8e-3));
        scene.add(body.mesh, body.kind);
        try {
            scene.simulation.prepare();
        } catch (const StartError&) {
            continue;
        }
        const double speed = random.number(0.5, 4.0);
        scene.simulation.set_velocities(scene.cloth, std::vector<Vec3>(sheet.vertices.size(), -speed * from));
        if (random.index(2) == 0) scene.simulation.pin(scene.cloth, 0);
        return scene;
    }
}

}  // namespace

TEST_CASE("nothing crosses bodies that intersect themselves, touch themselves or face inwards", "[law]") {
    const ContactResponse response = GENERATE(ContactResponse::penalty, ContactResponse::projection);
    int touched = 0;
    const char* wanted = std::getenv("PERCALE_LEFT_OUT_SCENES");
    const auto scenes = static_cast<unsigned>(wanted != nullptr ? std::atoi(wanted) : 100);
    for (unsigned seed = 0; seed < scenes; ++seed) {
        Random random(seed);
        const Body body = draw_body(random);
        const StepSettings settings = draw_settings(response, random);
        SteppedScene scene = throw_cloth(body, settings, random);
        int faults = 0, contacts = 0;
        for (double time = 0.0; time < 0.3 && faults == 0; time += settings.time_step) {
            contacts += scene.simulation.step().contacts;
            faults += scene.faults();
        }
        touched += contacts > 0 ? 1 : 0;
        CAPTURE(seed, body.kind);
        CHECK(faults == 0);
    }
    CHECK(touched > 0.8 * scenes);
}

}  // namespace percale::test::left_out_contacts_test
