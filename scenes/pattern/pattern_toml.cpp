#include "pattern/pattern_toml.h"

#include <algorithm>
#include <cmath>

#include "common/input_file.h"
#include "common/length_unit.h"
#include "common/nearest_name.h"
#include "common/scene_file_error.h"
#include "common/text.h"
#include "fields/toml_document.h"
#include "pattern/pattern_parts.h"

namespace percale::scenes {
namespace {

constexpr double farthest_point = 1e5;  // units

void check_keys(const TomlNode& table, const std::string& shown, const std::vector<std::string>& valid) {
    if (table.kind != TomlKind::table) fail_at(table.place, shown + " must be a table, not " + described(table));
    for (const TomlNode& entry : table.entries) {
        if (std::find(valid.begin(), valid.end(), entry.key) != valid.end()) continue;
        fail_at(entry.key_place, shown + " has no key '" + entry.key + "'" + suggestion(entry.key, valid));
    }
}

const TomlNode& needed(const TomlNode& table, const std::string& shown, const char* key) {
    const TomlNode* node = table.find(key);
    if (node == nullptr) fail_at(table.place, shown + " lacks " + key);
    return *node;
}

const std::vector<TomlNode>& list_in(const TomlNode& node, const std::string& shown) {
    if (node.kind != TomlKind::list || node.items.empty()) fail_at(node.place, shown + " must be a list, not " + described(node));
    return node.items;
}

std::string text_in(const TomlNode& node, const std::string& shown) {
    if (node.kind != TomlKind::text || node.text.empty()) fail_at(node.place, shown + " must be a text, not " + described(node));
    return node.text;
}

bool flag_in(const TomlNode* node, const std::string& shown) {
    if (node == nullptr) return false;
    if (node->kind != TomlKind::boolean) fail_at(node->place, shown + " must be true or false, not " + described(*node));
    return node->text == "true";
}

double number_in(const TomlNode& node, const std::string& shown) {
    if (!node.is_number() || !std::isfinite(node.number)) {
        fail_at(node.place, shown + " must be a number, not " + described(node));
    }
    if (std::abs(node.number) <= farthest_point) return node.number;
    fail_at(node.place, shown + " = " + number_text(node.number) + " is out of range; allowed: -1e5 ... 1e5");
}

template <std::size_t count>
std::array<double, count> numbers_in(const TomlNode& node, const std::string& shown) {
    if (node.kind != TomlKind::list || node.items.size() != count) {
        fail_at(node.place, shown + " must be a list of " + std::to_string(count) + " numbers, not " + described(node));
    }
    std::array<double, count> numbers;
    for (std::size_t k = 0; k < count; ++k) numbers[k] = number_in(node.items[k], shown);
    return numbers;
}

class TomlPattern {
public:
    TomlPattern(const TomlNode& document, const std::string& name) : document_(document) { pattern_.file = name; }

    Pattern read() {
        if (document_.find("cloth") != nullptr && document_.find("panel") == nullptr)
            throw SceneError(pattern_.file + ": is a scene file, not a sewing pattern: percale run takes it");
        check_keys(document_, "a pattern", {"title", "unit", "panel", "seam"});
        read_unit();
        for (const TomlNode& node : list_in(needed(document_, "a pattern", "panel"), "panel")) add_panel(node);
        const TomlNode* seams = document_.find("seam");
        if (seams == nullptr) return pattern_;
        for (const TomlNode& node : list_in(*seams, "seam")) add_seam(node);
        return pattern_;
    }

private:
    void read_unit() {
        const TomlNode& node = needed(document_, "a pattern", "unit");
        const std::string word = text_in(node, "unit");
        const std::optional<double> metres = metres_of_unit(word);
        const std::vector<std::string> words(length_unit_words.begin(), length_unit_words.end());
        if (!metres) fail_at(node.place, "unit has no choice '" + word + "'" + suggestion(word, words));
        unit_ = *metres;
    }

    Point2 point_in(const TomlNode& node, const std::string& shown) const {
        const auto [x, y] = numbers_in<2>(node, shown);
        return unit_ * Point2(x, y);
    }

    std::string new_name(const TomlNode& node, const std::string& shown) const {
        const std::string name = text_in(node, shown);
        const auto bad = [](unsigned char letter) { return std::isalnum(letter) == 0 && letter != '_' && letter != '-'; };
        if (std::ranges::any_of(name, bad))
            fail_at(node.place, shown + " \"" + name + "\" must hold only letters, digits, _ and -");
        if (panel_number(name) < 0) return name;
        fail_at(node.place, "a second panel '" + name + "'");
    }

    int panel_number(const std::string& name) const {
        const auto found = std::ranges::find(pattern_.panels, name, &Panel::name);
        return found == pattern_.panels.end() ? -1 : static_cast<int>(found - pattern_.panels.begin());
    }

    void add_panel(const TomlNode& node) {
        const TomlNode* name = node.find("name");
        const std::string shown = name != nullptr && name->kind == TomlKind::text ? "panel '" + name->text + "'" : "a panel";
        check_keys(node, shown, {"name", "points", "curves", "at", "turn", "wrap", "mirror"});
        Panel panel{.name = new_name(needed(node, shown, "name"), "panel.name"),
                    .corners = {},
                    .edges = {},
                    .pose = {},
                    .place = node.place};
        for (const TomlNode& point : list_in(needed(node, shown, "points"), "points")) {
            panel.corners.push_back(point_in(point, "points"));
        }
        const int corners = static_cast<int>(panel.corners.size());
        for (int k = 0; k < corners; ++k) {
            panel.edges.push_back({.from = k, .to = (k + 1) % corners, .control = {}, .label = {}});
        }
        if (const TomlNode* curves = node.find("curves")) {
            for (const TomlNode& curve : list_in(*curves, "curves")) add_curve(curve, panel);
        }
        read_placement(node, panel);
        pattern_.panels.push_back(panel);
        if (const TomlNode* mirror = node.find("mirror")) pattern_.panels.push_back(mirrored(panel, new_name(*mirror, "mirror")));
    }

    void read_placement(const TomlNode& node, Panel& panel) const {
        if (const TomlNode* at = node.find("at")) {
            const auto [x, y, z] = numbers_in<3>(*at, "at");
            panel.pose.translation = unit_ * Vec3(x, y, z);
        }
        if (const TomlNode* turn = node.find("turn")) panel.pose.rotation = turned(numbers_in<3>(*turn, "turn"));
        const TomlNode* wrap = node.find("wrap");
        if (wrap == nullptr) return;
        panel.wrap = unit_ * number_in(*wrap, "wrap");
        if (!(panel.wrap > 0.0))
            fail_at(wrap->place, "wrap = " + number_text(wrap->number) + " is out of range; it must be above 0");
    }

    void add_curve(const TomlNode& node, Panel& panel) const {
        const std::string shown = "a curve of panel '" + panel.name + "'";
        check_keys(node, shown, {"edge", "bulge", "control"});
        const TomlNode &number = needed(node, shown, "edge"), *bulge = node.find("bulge"), *control = node.find("control");
        const int edges = static_cast<int>(panel.edges.size());
        if (number.kind != TomlKind::integer || number.integer < 0 || number.integer >= edges) {
            fail_at(number.place,
                    shown + " is of edge " + described(number) + "; its edges are 0 ... " + std::to_string(edges - 1));
        }
        if ((bulge == nullptr) == (control == nullptr)) fail_at(node.place, shown + " needs either bulge or control");
        PanelEdge& edge = panel.edges[static_cast<std::size_t>(number.integer)];
        if (bulge != nullptr) {
            edge.curve = EdgeCurve::arc;
            edge.control = {arc_middle(panel.corners[edge.from], panel.corners[edge.to], unit_ * number_in(*bulge, "bulge"))};
            return;
        }
        edge.control.clear();
        for (const TomlNode& point : list_in(*control, "control")) edge.control.push_back(point_in(point, "control"));
        if (edge.control.size() > 2)
            fail_at(control->place,
                    shown + " has " + std::to_string(edge.control.size()) + " control points; it has 1 (quadratic) or 2 (cubic)");
        edge.curve = edge.control.size() == 2 ? EdgeCurve::cubic : EdgeCurve::quadratic;
    }

    /// PANEL.EDGE, with a minus behind it where the edge is run through from its end.
    EdgeUse use_in(const TomlNode& node) const {
        std::string word = text_in(node, "an edge of a seam");
        const bool reversed = word.ends_with('-');
        if (reversed) word.pop_back();
        const std::size_t dot = word.rfind('.');
        const std::string name = word.substr(0, dot), number = dot == std::string::npos ? "" : word.substr(dot + 1);
        if (number.empty() || number.size() > 6 || number.find_first_not_of("0123456789") != std::string::npos) {
            fail_at(node.place, "an edge of a seam is PANEL.EDGE, such as \"front.1\", not \"" + node.text + "\"");
        }
        std::vector<std::string> names;
        for (const Panel& panel : pattern_.panels) names.push_back(panel.name);
        const int panel = panel_number(name), edge = std::stoi(number);
        if (panel < 0) fail_at(node.place, "no panel '" + name + "'" + suggestion(name, names));
        const int edges = static_cast<int>(pattern_.panels[panel].edges.size());
        if (edge < edges) return {panel, edge, reversed};
        fail_at(node.place, "panel '" + name + "' has no edge " + number + ", edges are 0 ... " + std::to_string(edges - 1));
    }

    void add_seam(const TomlNode& node) {
        check_keys(node, "a seam", {"name", "sides", "gather"});
        PatternSeam seam{.name = "seam " + std::to_string(pattern_.seams.size()), .sides = {}, .place = node.place};
        if (const TomlNode* name = node.find("name")) seam.name = text_in(*name, "seam.name");
        seam.gather = flag_in(node.find("gather"), "gather");
        const TomlNode& sides = needed(node, "a seam", "sides");
        if (list_in(sides, "sides").size() != 2)
            fail_at(sides.place, "a seam has two sides, not " + std::to_string(sides.items.size()));
        bool said = false;
        for (std::size_t s = 0; s < 2; ++s) {
            for (const TomlNode& use : list_in(sides.items[s], "a side of a seam")) seam.sides[s].push_back(use_in(use));
            said = said || std::ranges::any_of(seam.sides[s], &EdgeUse::reversed);
        }
        if (!said) match_ends(pattern_, seam);
        pattern_.seams.push_back(std::move(seam));
    }

    const TomlNode& document_;
    double unit_ = 1.0;  // m
    Pattern pattern_;
};

}  // namespace

Pattern parse_pattern_toml(const std::string& text, const std::string& name) {
    const TomlNode document = parse_toml(text, name);
    return TomlPattern(document, name).read();
}

Pattern read_pattern_toml(const std::string& file) { return parse_pattern_toml(read_text(file), file); }

}  // namespace percale::scenes
