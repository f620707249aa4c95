#pragma once

#include <string>

#include "percale/mesh.h"
#include "scenes/meshes/obj_file.h"
#include "tests/scenes/test_folder.h"

namespace percale::scenes::test {

/// strips.toml and plate.obj: two strips on both sides of a plate that is wider than they are, sewn to each other by one seam,
/// which the plate keeps open.
inline void write_open_seam(const TestFolder& folder, const std::string& seam) {
    const std::string strip = "points = [[-10, 0], [10, 0], [10, 10], [-10, 10]]\n";
    folder.write("strips.toml", "unit = \"cm\"\n[[panel]]\nname = \"a\"\n" + strip + "at = [0, 0, 5]\n[[panel]]\nname = \"b\"\n" +
                                    strip + "at = [0, 0, -5]\nturn = [0, 180, 0]\n[[seam]]\nname = \"" + seam + "\"\n" +
                                    "sides = [[\"a.1\"], [\"b.3\"]]\n");
    const TriangleMesh plate = make_box(Vec3(2.0, 2.0, 0.02));
    write_obj(folder.path("plate.obj"), plate.vertices, plate.triangles);
}

}  // namespace percale::scenes::test
