#pragma once

#include <string>

// Elements of SVG files. Places in pixels.
namespace percale::scenes {

/// A place with one digit after the point.
std::string svg_number(double value);

/// Text for XML; control characters, which it cannot hold, as question marks.
std::string svg_escaped(const std::string& text);

/// ' name="value"'; text must be escaped already.
std::string svg_attribute(const char* name, double value);
std::string svg_attribute(const char* name, const std::string& value);

/// `style`: attributes.
std::string svg_line(double x1, double y1, double x2, double y2, const std::string& style);
/// `anchor`: start, middle or end; `more`: further attributes.
std::string svg_text(double x, double y, const std::string& anchor, const std::string& text, const std::string& more = "");

/// The opening of a document with a white ground; "</svg>" ends it.
std::string svg_opening(double width, double height, const std::string& title);

}  // namespace percale::scenes
