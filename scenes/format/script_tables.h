#pragma once

#include "fields/field_table.h"
#include "format/scene.h"

// The fields of what happens in a scene and of what is expected of it: [[seam]], [[pair]], [[event]], [expect].
namespace percale::scenes {

const FieldTable<SeamSpec>& seam_table();
const FieldTable<PairSpec>& pair_table();
const FieldTable<EventSpec>& event_table();

/// [expect] as a whole: a key for each measure, and `matches`. The list keeps the order of the file.
Field<Scene> expect_field();

}  // namespace percale::scenes
