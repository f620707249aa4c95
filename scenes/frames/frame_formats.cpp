#include "frames/frame_formats.h"

#include "frames/glb_frames.h"
#include "frames/obj_frames.h"
#include "frames/ply_frames.h"
#include "frames/point_cache_frames.h"
#include "frames/vtp_frames.h"

namespace percale::scenes {

std::span<const FrameFormat> frame_formats() {
    static const FrameFormat formats[] = {
        obj_frames(), ply_frames(), glb_frames(), pc2_frames(), mdd_frames(), vtp_frames(),
    };
    return formats;
}

std::vector<std::string> frame_words() {
    std::vector<std::string> words = {no_frames};
    for (const FrameFormat& format : frame_formats()) words.push_back(format.word);
    return words;
}

std::string frame_words_meaning() {
    std::string text = std::string(no_frames) + ": nothing";
    for (const FrameFormat& format : frame_formats()) text += "; " + format.word + ": " + format.sentence;
    return text;
}

}  // namespace percale::scenes
