#pragma once

#include <string>

#include "models/model.h"

namespace percale::scenes {

/// Whether a file is glTF of version 2, as text or GLB: by its beginning and the version that it says, not by its name.
bool is_gltf_2(const std::string& file);

/// Reads such a file: the nodes of its scene, triangles, skins, morph targets and animations; a skin without inverse bind
/// matrices has identities. Vertices that no triangle has are left out. Throws SceneError naming the file where it does not fit
/// together, or where its triangles need an extension that is not read (compression, instances).
Model read_gltf(const std::string& file);

}  // namespace percale::scenes
