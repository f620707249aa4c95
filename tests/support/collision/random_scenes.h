#pragma once

#include <array>
#include <string>

#include "percale/report.h"
#include "scenes/run/run_scene.h"
#include "tests/support/collision/second_checker.h"

// Scenes drawn at random, each from a seed, so that any one can be made again alone: cloth coarse and fine, of grids and free
// meshes, alone or two over each other; bodies smooth, spiked, folded, self-intersecting, inside out, open, doubled, with faces
// in one plane, thin as needles and blades, two that close to a millimetre; motions, gravity to 40 m/s^2, friction to 2, all
// schemes and responses with contact. Bodies that deform: tests/properties/collision/deforming_scenes_test.cpp.
namespace percale::test {

inline constexpr std::array random_detectors = {scenes::Detector::fcl, scenes::Detector::bullet, scenes::Detector::brute_force};
inline constexpr std::array random_responses = {ContactResponse::penalty, ContactResponse::projection};

struct RandomScene {
    std::string obstacle, motion, cloth;  // their kinds
    bool pinned = false;
    std::string description;  // one line with all drawn values
    scenes::BuiltScene built;
};

/// Scene number `index` of a seed. Detectors and responses alternate: they change nothing else of the scene. The obstacles
/// include body scans where they are installed. The cloth starts clear of the obstacle.
RandomScene make_random_scene(unsigned seed, int index);

struct RandomOutcome {
    scenes::RunResult result;
    StepStatus last = StepStatus::ok;  // of the last step
    int not_finite = 0;                // states with a position or velocity that is not finite
    int crossings = 0;                 // intersecting pairs, over all steps
    double deepest = 0.0;              // m, inside a watertight obstacle, over all steps
    long second_crossings = 0;         // intersecting pairs by a second checker, over all frames
    long second_frames = 0;            // frames that it has checked

    bool good() const {
        return crossings == 0 && second_crossings == 0 && deepest == 0.0 && not_finite == 0 && last != StepStatus::not_finite;
    }
    /// The step reports that the cloth could not follow; nothing has crossed.
    bool blocked() const { return good() && result.status == scenes::RunStatus::failed; }
};

/// Runs it with the exact certificate of every step, and with a second checker of every frame if there is one.
RandomOutcome run_random_scene(RandomScene& scene, const SecondChecker& second = cgal_checker());

}  // namespace percale::test
