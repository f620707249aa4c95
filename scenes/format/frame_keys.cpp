#include "format/frame_keys.h"

namespace percale::scenes {

Field<ObstacleSpec> frames_field() {
    return value_field<ObstacleSpec>({.path = "frames",
                                      .sentence = "First and last number of the files that mesh names with %d, or %04d for four "
                                                  "digits, all with the same triangles: each vertex goes straight from one to "
                                                  "the next.",
                                      .lowest = 0.0,
                                      .highest = 1e6,
                                      .needs = "mesh",
                                      .needs_why = "frames are mesh files"},
                                     &ObstacleSpec::frames);
}

Field<ObstacleSpec> fps_field() {
    return value_field<ObstacleSpec>(
        {.path = "fps",
         .sentence = "Frames a second, without it 30; the first is there at 0 s, and the last stays.",
         .unit = "1/s",
         .lowest = 1e-3,
         .highest = 1e4,
         .needs = "mesh",
         .needs_why = "they are mesh files"},
        &ObstacleSpec::fps);
}

}  // namespace percale::scenes
