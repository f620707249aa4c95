#pragma once

#include <vector>

#include "fields/field_table.h"
#include "format/scene.h"

// How obstacles move.
namespace percale::scenes {

Field<ObstacleSpec> motion_field();
Field<ObstacleSpec> spin_field();
Field<ObstacleSpec> pinch_field();
/// Where the shapes of obstacles that bend come from, and when they are played.
std::vector<Field<ObstacleSpec>> bend_fields();

}  // namespace percale::scenes
