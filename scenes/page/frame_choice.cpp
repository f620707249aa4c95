#include "page/frame_choice.h"

#include <algorithm>

namespace percale::scenes {

namespace {

std::vector<int> every_nth(int frames, int worst, int every) {
    std::vector<int> shown;
    for (int i = 0; i < frames; ++i)
        if (i % every == 0 || i == frames - 1 || i == worst) shown.push_back(i);
    return shown;
}

}  // namespace

FrameChoice choose_frames(int frames, int worst, std::size_t fixed, std::size_t each, std::size_t max) {
    // At the end `every` is `frames`: then only the first, the worst and the last frame are left.
    for (int every = 1; every <= frames; ++every) {
        FrameChoice choice{every, every_nth(frames, worst, every)};
        if (fixed + each * choice.shown.size() <= max) return choice;
    }
    return {};
}

}  // namespace percale::scenes
