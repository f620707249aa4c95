#pragma once

#include <string>

#include "percale/plan.h"
#include "run/scene_build.h"

namespace percale::scenes {

/// The number and the length of the steps in which a scene is run.
std::string steps_text(const Scene& scene);

/// The plan of a built scene before its first step, with the motion and events that its file holds.
ScenePlan plan_of(const BuiltScene& built);

/// Warnings of a built scene before its first step: what is not as its file says, what its plan expects to go wrong, events that
/// come too late. `plan`: plan_of it.
std::vector<Finding> plan_findings(const BuiltScene& built, const ScenePlan& plan);

/// What the start moved out of obstacles and cloth: notes, and warnings where that is far.
std::vector<Finding> start_findings(const BuiltScene& built);

/// What was left out of each obstacle's mesh.
std::vector<CleaningReport> cleaning_of(const BuiltScene& built);

/// Computes plan and cleaning once for all later calls: the longest stable step of a large cloth takes seconds, as does the
/// cleaning of a large mesh, which only reports state.
void keep_plan(BuiltScene& built);
void keep_cleaning(BuiltScene& built);

/// How many frames a run writes at most, and about how many bytes in all formats of the scene together.
struct OutputSize {
    double frames = 0.0, bytes = 0.0;
};
OutputSize output_size_of(const BuiltScene& built);

/// The plan for people: title, scheme, counts, obstacles with their triangles, what is left out and why, predicted memory and
/// cost.
std::string plan_text(const BuiltScene& built);

/// The same as a JSON object; SI units, memory in bytes.
std::string plan_json(const BuiltScene& built);

}  // namespace percale::scenes
