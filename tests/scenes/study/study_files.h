#pragma once

#include <string>
#include <vector>

#include "scenes/study/study_folder.h"
#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"

namespace percale::scenes::test {

/// A study of the falling sheet in a folder; returns its path.
inline std::string write_study(const TestFolder& folder, const std::string& vary, const std::string& top = "") {
    folder.write("sheet.toml", falling_sheet() + "[expect]\nlowest_vertex = { above = 1.9 }\n");
    return folder.write("study.toml", "scene = \"sheet.toml\"\n" + top + "[vary]\n" + vary);
}

/// The runs of a study that are not done.
inline std::vector<std::size_t> runs_left(const StudyFolder& folder, const Study& study) {
    std::vector<std::size_t> left;
    for (std::size_t run = 0; run < study.runs.size(); ++run)
        if (!folder.is_done(run)) left.push_back(run);
    return left;
}

}  // namespace percale::scenes::test
