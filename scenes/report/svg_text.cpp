#include "report/svg_text.h"

#include <cstdio>

namespace percale::scenes {

std::string svg_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
}

std::string svg_escaped(const std::string& text) {
    std::string result;
    for (const char letter : text) {
        if (letter == '&')
            result += "&amp;";
        else if (letter == '<')
            result += "&lt;";
        else if (letter == '>')
            result += "&gt;";
        else if (letter == '"')
            result += "&quot;";
        else
            result += static_cast<unsigned char>(letter) < 0x20 ? '?' : letter;
    }
    return result;
}

std::string svg_attribute(const char* name, double value) { return std::string(" ") + name + "=\"" + svg_number(value) + "\""; }
std::string svg_attribute(const char* name, const std::string& value) { return std::string(" ") + name + "=\"" + value + "\""; }

std::string svg_line(double x1, double y1, double x2, double y2, const std::string& style) {
    return "<line" + svg_attribute("x1", x1) + svg_attribute("y1", y1) + svg_attribute("x2", x2) + svg_attribute("y2", y2) + " " +
           style + "/>\n";
}

std::string svg_text(double x, double y, const std::string& anchor, const std::string& text, const std::string& more) {
    return "<text" + svg_attribute("x", x) + svg_attribute("y", y) + svg_attribute("text-anchor", anchor) + more + ">" +
           svg_escaped(text) + "</text>\n";
}

std::string svg_opening(double width, double height, const std::string& title) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"" +
           svg_attribute("width", width) + svg_attribute("height", height) + " viewBox=\"0 0 " + svg_number(width) + " " +
           svg_number(height) + "\" font-family=\"sans-serif\" font-size=\"14\">\n<title>" + svg_escaped(title) +
           "</title>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
}

}  // namespace percale::scenes
