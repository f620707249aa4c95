#pragma once

#include <string>
#include <vector>

#include "percale/mesh.h"

namespace percale::scenes {

struct ShippedMesh {
    std::string file;  // under data/meshes
    TriangleMesh mesh;
    std::string bytes;  // what the file holds; "": the mesh alone, as OBJ
};

/// The meshes of data/meshes, made anew: funnel, mannequin (alone, and with joints and clips), needles, poncho, sphere, spikes;
/// coordinates rounded to 1e-6 m.
std::vector<ShippedMesh> make_shipped_meshes();

}  // namespace percale::scenes
