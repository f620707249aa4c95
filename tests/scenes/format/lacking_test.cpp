#include "scenes/format/lacking.h"

#include "scenes/format/scene_keys.h"
#include "tests/support/catch.h"

using namespace percale::scenes;

TEST_CASE("keys and words that this build lacks are known as such") {
    for (const char* path : {"cloth.pattern", "event.detach"}) {
        CAPTURE(path);
        CHECK(lacks_key(path));
        CHECK(find_scene_key(path) == nullptr);
    }
    CHECK(lacks_choice("output.frames", "ply"));
}

TEST_CASE("nothing that this build has is lacking, nor is a slip") {
    for (const SceneKey& key : scene_keys()) {
        CAPTURE(key.path);
        CHECK_FALSE(lacks_key(key.path));
        for (const std::string& choice : key.choices) CHECK_FALSE(lacks_choice(key.path, choice));
    }
    CHECK_FALSE(lacks_key("fabric.presset"));
    CHECK_FALSE(lacks_key("step.scheme"));
    CHECK_FALSE(lacks_choice("step.scheme", "bdf3"));
    CHECK_FALSE(lacks_choice("step.detector", "bdf2"));
    CHECK_FALSE(lacks_choice("step.tolerance", ""));
}
