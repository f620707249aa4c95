#pragma once

#include "fields/field_table.h"
#include "format/scene.h"

// The keys of obstacles whose mesh is another in each frame.
namespace percale::scenes {

Field<ObstacleSpec> frames_field();
Field<ObstacleSpec> fps_field();

}  // namespace percale::scenes
