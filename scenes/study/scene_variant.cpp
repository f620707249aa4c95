#include "study/scene_variant.h"

#include "frames/frame_formats.h"
#include "percale/error.h"
#include "percale/options.h"

namespace percale::scenes {

std::vector<std::string> scheme_words() {
    std::vector<std::string> words;
    for (const Option<StepSettings>& option : step_options())
        if (option.key == "scheme") words.assign(option.choices.begin(), option.choices.end());
    std::erase(words, "auto");
    return words;
}

std::string use_steps(Scene scene, const std::function<void(BuiltScene&)>& use) {
    constexpr double one_frame_fps = 1e-9;  // frames per s: the second frame is beyond the end of any run
    scene.output.frames = {no_frames};
    scene.output.fps = one_frame_fps;
    scene.expectations.clear();
    try {
        BuiltScene built = build_scene(scene);
        use(built);
        return "";
    } catch (const SceneError& error) {
        return error.what();
    }
}

}  // namespace percale::scenes
