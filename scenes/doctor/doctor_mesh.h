#pragma once

#include "common/finding.h"
#include "meshes/mesh_facts.h"
#include "percale/fabric.h"

namespace percale::scenes {

/// A mesh as it is used: in m, where it is at the start.
struct ExaminedMesh {
    MeshRole role = MeshRole::cloth;
    std::string name = {};   // "cloth 'shirt'"; "" for a bare mesh
    std::string place = {};  // in the scene file, or the mesh file
    bool from_file = true;   // else a grid or a shape, which is made without faults
    bool sewn = false;       // a seam joins parts of it
    bool filled = false;     // cloth that is closed on purpose
    double scale = 1.0;      // of its pose, which the mesh has and a weld comes before
    TriangleMesh mesh = {};
    MeshFacts facts = {};
};

/// What a mesh is like in its role: as cloth without repeated triangles, which it is not made of. Numbers are those of the mesh.
MeshFacts facts_as(MeshRole role, const TriangleMesh& mesh);

/// What is wrong with cloth of this mesh and fabric.
std::vector<Finding> examine_cloth(const ExaminedMesh& cloth, const Fabric& fabric);

/// What is wrong with an obstacle of this mesh.
std::vector<Finding> examine_obstacle(const ExaminedMesh& obstacle);

/// What does not fit between a cloth and an obstacle.
std::vector<Finding> examine_pair(const ExaminedMesh& cloth, const ExaminedMesh& obstacle);

}  // namespace percale::scenes
