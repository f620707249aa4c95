#include "generators/shipped_meshes.h"

#include <cmath>

#include "generators/funnel.h"
#include "generators/mannequin.h"
#include "generators/poncho.h"
#include "generators/rigged_glb.h"
#include "generators/spikes.h"

namespace percale::scenes {

namespace {

/// Short numbers keep the files small, and hide the last bits, in which compilers may differ.
TriangleMesh rounded(TriangleMesh mesh) {
    for (Vec3& x : mesh.vertices)
        for (double& coordinate : x) coordinate = std::round(coordinate * 1e6) / 1e6 + 0.0;
    return mesh;
}

}  // namespace

std::vector<ShippedMesh> make_shipped_meshes() {
    const SpikeBed needles{.width = 0.6, .count = 10, .height = 0.1, .base = 0.03, .thickness = 0.02};
    const TriangleMesh mannequin = rounded(make_mannequin(0.02));
    return {{"funnel.obj", rounded(make_funnel()), ""},
            {"mannequin.glb", mannequin, rigged_glb("mannequin", make_mannequin_rig(mannequin), mannequin_clips())},
            {"mannequin.obj", mannequin, ""},
            {"needles.obj", rounded(make_spikes(needles)), ""},
            {"poncho.obj", rounded(make_poncho()), ""},
            {"sphere.obj", rounded(make_sphere(0.25, 4)), ""},
            {"spikes.obj", rounded(make_spikes()), ""}};
}

}  // namespace percale::scenes
