#include "scenes/page/frame_choice.h"

#include <algorithm>

#include "tests/support/catch.h"

namespace percale::scenes::test::frame_choice_test {

TEST_CASE("All frames are shown where they fit to the byte") {
    const FrameChoice choice = choose_frames(5, -1, 100, 10, 150);
    CHECK(choice.every == 1);
    CHECK(choice.shown == std::vector<int>{0, 1, 2, 3, 4});
    CHECK(choose_frames(5, -1, 100, 10, 149).every == 2);
}

TEST_CASE("Of more frames every nth is shown, and the last and the worst") {
    const FrameChoice choice = choose_frames(11, 5, 0, 10, 60);
    CHECK(choice.every == 3);
    CHECK(choice.shown == std::vector<int>{0, 3, 5, 6, 9, 10});
}

namespace {

/// How many frames a smaller n would have shown.
std::size_t shown_with(int frames, int worst, int every) {
    std::size_t count = 0;
    for (int i = 0; i < frames; ++i) count += i % every == 0 || i == frames - 1 || i == worst ? 1 : 0;
    return count;
}

void check_choice(int frames, std::size_t most) {
    const int worst = frames / 3;
    const FrameChoice choice = choose_frames(frames, worst, 3, 10, most);
    if (choice.shown.empty()) {
        CHECK(3 + 10 * shown_with(frames, worst, frames) > most);
        return;
    }
    CHECK(3 + 10 * choice.shown.size() <= most);
    CHECK(choice.shown.size() == shown_with(frames, worst, choice.every));
    CHECK(choice.shown.front() == 0);
    CHECK(choice.shown.back() == frames - 1);
    CHECK(std::ranges::count(choice.shown, worst) == 1);
    if (choice.every > 1) CHECK(3 + 10 * shown_with(frames, worst, choice.every - 1) > most);
}

}  // namespace

TEST_CASE("No smaller n would have fitted, whatever the sizes") {
    for (int frames = 1; frames < 40; ++frames)
        for (std::size_t most = 20; most < 500; most += 7) check_choice(frames, most);
}

TEST_CASE("Where not even the first and the last frame fit none is shown") {
    CHECK(choose_frames(100, -1, 50, 30, 100).shown.empty());
    CHECK(choose_frames(100, -1, 50, 25, 100).shown == std::vector<int>{0, 99});
}

}  // namespace percale::scenes::test::frame_choice_test
