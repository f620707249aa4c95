#include "frames/numbered_frames.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "frames/frame_folder.h"

namespace percale::scenes {

namespace {

const MeshFields no_fields;

/// The file of a shape, "" where the cast names none.
const std::string& obj_file_at(const std::vector<std::string>& files, std::size_t index) {
    static const std::string none;
    return files.empty() ? none : files[index];
}

class NumberedFrames final : public FrameEncoder {
public:
    NumberedFrames(const FrameCast& cast, const std::string& ending, MeshWriter write)
        : cast_(cast), ending_(ending), write_(std::move(write)) {}

    FrameFiles write(const FrameShapes& frame, FrameFolder& folder) override {
        FrameFiles files;
        for (std::size_t i = 0; i < frame.cloths.size(); ++i) {
            files.cloths.push_back(numbered("frames/" + cast_.cloths[i], frame.index));
            const NumberedMesh mesh{frame.cloths[i], frame.cloth_fields.empty() ? no_fields : frame.cloth_fields[i],
                                    obj_file_at(cast_.cloth_files, i)};
            folder.write(files.cloths.back(), [&](const std::string& path) { write_(path, mesh); });
        }
        for (std::size_t i = 0; i < frame.obstacles.size(); ++i) {
            const bool moves = cast_.obstacle_moves[i];
            files.obstacles.push_back(numbered("obstacles/" + cast_.obstacles[i], moves ? frame.index : 0));
            if (!moves && frame.index > 0) continue;
            const NumberedMesh mesh{frame.obstacles[i], no_fields, obj_file_at(cast_.obstacle_files, i)};
            folder.write(files.obstacles.back(), [&](const std::string& path) { write_(path, mesh); });
        }
        return files;
    }

    void finish(std::span<const double>, FrameFolder&) override {}

    int first_frame_of(const std::string& name) const override {
        int number = -1;
        for (const std::string& cloth : cast_.cloths) number = std::max(number, number_of(name, "frames/" + cloth));
        for (const std::string& obstacle : cast_.obstacles) number = std::max(number, number_of(name, "obstacles/" + obstacle));
        return number;
    }

private:
    std::string numbered(const std::string& name, int index) const { return numbered_name(name, index, ending_); }

    /// The number in START_NUMBER.obj; -1 for other names.
    int number_of(const std::string& name, const std::string& start) const {
        if (!name.starts_with(start + "_") || !name.ends_with(ending_)) return -1;
        const std::string_view rest = std::string_view(name).substr(start.size() + 1);
        const std::string number(rest.substr(0, rest.size() - std::min(rest.size(), ending_.size())));
        const bool digits =
            number.size() >= 5 && number.size() <= 9 && number.find_first_not_of("0123456789") == std::string::npos;
        return digits ? std::stoi(number) : -1;
    }

    FrameCast cast_;
    std::string ending_;
    MeshWriter write_;
};

}  // namespace

std::string numbered_name(const std::string& name, int index, const std::string& ending) {
    char number[16];
    std::snprintf(number, sizeof number, "_%05d", index);
    return name + number + ending;
}

std::unique_ptr<FrameEncoder> numbered_frames(const FrameCast& cast, const std::string& ending, MeshWriter write) {
    return std::make_unique<NumberedFrames>(cast, ending, std::move(write));
}

}  // namespace percale::scenes
