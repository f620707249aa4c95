#pragma once

#include <functional>
#include <string>
#include <vector>

#include "format/scene_file.h"
#include "run/run_scene.h"

// One variant of a scene of which only the steps matter, in this process.
namespace percale::scenes {

/// All words of step.scheme that name one scheme, in the order of the options, which is that of Scheme.
std::vector<std::string> scheme_words();

/// Builds the scene without expectations and without frames but the first, and calls `use` with it. Gives why that was refused,
/// as an explicit scheme takes no obstacles; "" where it was not. What `use` throws as a SceneError is a refusal, too.
std::string use_steps(Scene scene, const std::function<void(BuiltScene&)>& use);

}  // namespace percale::scenes
