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

FrameChoice choose_frames(int frames, int worst, std::size_t fixed, std::size_t each, std::size_t most) {
    // The whole of `frames` is every: then the first, the worst and the last are left.
    for (int every = 1; every <= frames; ++every) {
        FrameChoice choice{every, every_nth(frames, worst, every)};
        if (fixed + each * choice.shown.size() <= most) return choice;
    }
    return {};
}

}  // namespace percale::scenes
