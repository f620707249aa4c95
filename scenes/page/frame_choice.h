#pragma once

#include <cstddef>
#include <vector>

namespace percale::scenes {

/// The frames of a run that a page shows, by number: every nth, the last and the worst.
struct FrameChoice {
    int every = 1;
    std::vector<int> shown;  // ascending
};

/// The frames with the smallest n whose bytes, `fixed` and `each` for every frame, are at most `most`; no frame where not even
/// the first and the last fit. `frames`: at least 1; `worst`: a frame that is always shown, -1: none.
FrameChoice choose_frames(int frames, int worst, std::size_t fixed, std::size_t each, std::size_t max);

}  // namespace percale::scenes
