#pragma once

#include <string>
#include <vector>

#include "percale/mesh.h"

namespace percale::scenes {

struct ShippedMesh {
    std::string file;  // under data/meshes
    TriangleMesh mesh;
};

/// The meshes of data/meshes, made anew: funnel, mannequin, needles, poncho, sphere, spikes; coordinates rounded to 1e-6 m.
std::vector<ShippedMesh> make_shipped_meshes();

}  // namespace percale::scenes
