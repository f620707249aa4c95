#pragma once

#include <string>

#include "tests/scenes/small_scenes.h"
#include "tests/scenes/test_folder.h"

namespace percale::scenes::test {

/// A study of the falling sheet in a folder; returns its path.
inline std::string write_study(const TestFolder& folder, const std::string& vary, const std::string& top = "") {
    folder.write("sheet.toml", falling_sheet() + "[expect]\nlowest_vertex = { above = 1.9 }\n");
    return folder.write("study.toml", "scene = \"sheet.toml\"\n" + top + "[vary]\n" + vary);
}

}  // namespace percale::scenes::test
