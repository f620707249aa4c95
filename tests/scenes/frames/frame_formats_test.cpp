#include "scenes/frames/frame_formats.h"

#include <set>

#include "tests/support/catch.h"

namespace percale::scenes::test::frame_formats_test {

TEST_CASE("every format has a word, a sentence, an ending of its own and a size, and makes an encoder that knows its files") {
    std::set<std::string> words = {no_frames}, endings;
    for (const FrameFormat& format : frame_formats()) {
        CAPTURE(format.word);
        CHECK(words.insert(format.word).second);
        CHECK_FALSE(format.sentence.empty());
        REQUIRE_FALSE(format.endings.empty());
        for (const std::string& ending : format.endings) {
            CHECK(ending.starts_with("."));
            CHECK(ending.size() > 1);
        }
        CHECK(endings.insert(format.endings.front()).second);
        const FrameBytes few = format.bytes({.vertices = 10, .triangles = 10}),
                         more = format.bytes({.vertices = 20, .triangles = 10});
        CHECK(few.each_frame > 0.0);
        CHECK(more.each_frame > few.each_frame);
        const auto encoder = format.make({.cloths = {"sheet"}, .obstacles = {}, .obstacle_moves = {}});
        REQUIRE(encoder != nullptr);
        CHECK(encoder->first_frame_of("frames/notes.txt") == -1);
    }
}

TEST_CASE("the words of scene files are none and those of the formats, each explained") {
    const std::vector<std::string> words = frame_words();
    REQUIRE(words.size() == frame_formats().size() + 1);
    CHECK(words.front() == no_frames);
    for (std::size_t i = 1; i < words.size(); ++i) CHECK(words[i] == frame_formats()[i - 1].word);
    for (const std::string& word : words) CHECK(frame_words_meaning().find(word + ": ") != std::string::npos);
}

}  // namespace percale::scenes::test::frame_formats_test
