#pragma once

#include <string_view>

// The files that a page is made of, as the build puts them into the library (browser/embed.cmake).
namespace percale::scenes {

std::string_view page_template();
std::string_view page_style();
/// Our own scripts, one after the other.
std::string_view page_script();
/// three.js and its OrbitControls; empty where the build did not find them.
std::string_view three_library();
std::string_view three_controls();

}  // namespace percale::scenes
