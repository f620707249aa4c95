#include "pattern/pattern_json.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/input_file.h"
#include "common/nearest_name.h"
#include "common/text.h"
#include "pattern/pattern_parts.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

using Json = nlohmann::ordered_json;

Point2 read_point(const Json& json) {
    if (json.size() != 2) throw SceneError("a point has " + std::to_string(json.size()) + " numbers; it has x and y");
    return {json.at(0).get<double>(), json.at(1).get<double>()};
}

std::array<double, 3> read_three(const Json& panel, const char* key) {
    if (!panel.contains(key)) return {0.0, 0.0, 0.0};
    const Json& list = panel.at(key);
    if (list.size() != 3) throw SceneError(std::string(key) + " has " + std::to_string(list.size()) + " numbers, not 3");
    return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

/// A whole number that an int holds: get<int>() would cut off fractions and higher bits.
int read_index(const Json& json, const char* what) {
    const bool whole =
        json.is_number_integer() && (json.is_number_unsigned() ? json.get<std::uint64_t>() <= std::numeric_limits<int>::max()
                                                               : json.get<std::int64_t>() >= std::numeric_limits<int>::min());
    if (!whole) throw SceneError(std::string(what) + " is " + json.dump() + ", no whole number of 32 bits");
    return json.get<int>();
}

/// GarmentCode writes true or 1.
bool read_flag(const Json& json) { return json.is_boolean() ? json.get<bool>() : read_index(json, "a flag of a circle") != 0; }

class JsonPattern {
public:
    JsonPattern(const std::string& file, const Json& json) : file_(file), json_(json) { pattern_.file = file; }

    Pattern read() {
        const double units = json_.value("/properties/units_in_meter"_json_pointer, 100.0);
        if (!(units > 0.0)) throw SceneError(file_, "properties.units_in_meter = " + number_text(units) + ", it must be above 0");
        unit_ = 1.0 / units;
        for (const auto& panel : json_.at("pattern").at("panels").items()) {
            at("panel '" + panel.key() + "'", [&] { add_panel(panel.key(), panel.value()); });
        }
        if (!json_.at("pattern").contains("stitches")) return pattern_;
        const Json& stitches = json_.at("pattern").at("stitches");
        for (std::size_t k = 0; k < stitches.size(); ++k) {
            at("stitch " + std::to_string(k), [&] { add_seam(k, stitches.at(k)); });
        }
        return pattern_;
    }

private:
    template <class Work>
    void at(const std::string& place, Work work) {
        try {
            work();
        } catch (const SceneError& error) {
            throw SceneError(file_, place + ": " + error.what());
        } catch (const Json::exception&) {
            throw SceneError(file_, place + ": a key is missing or has a value of another kind than GarmentCode writes");
        }
    }

    void add_panel(const std::string& name, const Json& json) {
        Panel panel{.name = name, .corners = {}, .edges = {}, .pose = {}, .wrap = 0.0, .place = {.file = file_}};
        const auto [x, y, z] = read_three(json, "translation");
        panel.pose = {.translation = unit_ * Vec3(x, y, z), .rotation = turned(read_three(json, "rotation"))};
        for (const Json& vertex : json.at("vertices")) panel.corners.push_back(unit_ * read_point(vertex));
        for (const Json& edge : json.at("edges")) panel.edges.push_back(read_edge(edge, panel));
        pattern_.panels.push_back(std::move(panel));
    }

    PanelEdge read_edge(const Json& json, const Panel& panel) const {
        PanelEdge edge{.control = {}, .label = json.value("label", "")};
        edge.from = read_index(json.at("endpoints").at(0), "an end of an edge");
        edge.to = read_index(json.at("endpoints").at(1), "an end of an edge");
        const int corners = static_cast<int>(panel.corners.size());
        for (const int corner : {edge.from, edge.to}) {
            if (corner >= 0 && corner < corners) continue;
            throw SceneError("edge " + std::to_string(panel.edges.size()) + " ends at vertex " + std::to_string(corner) +
                             ", vertices are 0 ... " + std::to_string(corners - 1));
        }
        if (json.contains("curvature")) read_curve(json.at("curvature"), panel, edge);
        return edge;
    }

    void read_curve(const Json& json, const Panel& panel, PanelEdge& edge) const {
        const Point2 &a = panel.corners[edge.from], along = panel.corners[edge.to] - a;
        const Point2 left(-along.y(), along.x());
        const auto control = [&](const Json& point) {
            const Point2 relative = read_point(point);
            edge.control.push_back(a + relative.x() * along + relative.y() * left);
        };
        const std::string type = json.is_array() ? "quadratic" : json.at("type").get<std::string>();
        if (json.is_array()) {
            control(json);
            edge.curve = EdgeCurve::quadratic;
        } else if (type == "quadratic" || type == "cubic") {
            for (const Json& point : json.at("params")) control(point);
            edge.curve = type == "cubic" ? EdgeCurve::cubic : EdgeCurve::quadratic;
        } else if (type == "circle") {
            edge.control = {circle_middle(json.at("params"), a, panel.corners[edge.to])};
            edge.curve = EdgeCurve::arc;
        } else {
            const std::vector<std::string> types = {"quadratic", "cubic", "circle"};
            throw SceneError("no type of curve '" + type + "'" + suggestion(type, types));
        }
        const std::size_t wanted = edge.curve == EdgeCurve::cubic ? 2 : 1;
        if (edge.control.size() != wanted)
            throw SceneError("a " + type + " curve has " + std::to_string(wanted) + " control points");
    }

    Point2 circle_middle(const Json& params, const Point2& a, const Point2& b) const {
        const double radius = unit_ * params.at(0).get<double>(), half = 0.5 * (b - a).norm();
        const bool large = read_flag(params.at(1)), right = read_flag(params.at(2));
        // A radius that rounding has left below half of the chord is a half circle, as drawing programs take it.
        const double to_centre = std::sqrt(std::max(0.0, radius * radius - half * half));
        const double bulge = std::max(radius, half) + (large ? to_centre : -to_centre);
        return arc_middle(a, b, right ? bulge : -bulge);
    }

    EdgeUse read_use(const Json& json) const {
        const std::string name = json.at("panel").get<std::string>();
        std::vector<std::string> names;
        for (const Panel& panel : pattern_.panels) names.push_back(panel.name);
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) throw SceneError("no panel '" + name + "'" + suggestion(name, names));
        const int panel = static_cast<int>(found - names.begin()), edge = read_index(json.at("edge"), "edge");
        const int edges = static_cast<int>(pattern_.panels[panel].edges.size());
        if (edge >= 0 && edge < edges) return {panel, edge, false};
        throw SceneError("panel '" + name + "' has no edge " + std::to_string(edge) + ", edges are 0 ... " +
                         std::to_string(edges - 1));
    }

    void add_seam(std::size_t number, const Json& json) {
        if (json.size() < 2) throw SceneError("it joins two edges");
        PatternSeam seam{.name = "stitch " + std::to_string(number),
                         .sides = {{{read_use(json.at(0))}, {read_use(json.at(1))}}},
                         .gather = true,  // the format does not distinguish gathers from mistakes
                         .place = {.file = file_}};
        const bool right_wrong = json.size() > 2 && json.at(2).is_string() && json.at(2).get<std::string>() == "right_wrong";
        if (!right_wrong) reverse_side(seam.sides[1]);
        pattern_.seams.push_back(std::move(seam));
    }

    const std::string& file_;
    const Json& json_;
    double unit_ = 0.01;  // m
    Pattern pattern_;
};

}  // namespace

Pattern read_pattern_json(const std::string& file) {
    const std::string text = read_text(file);
    try {
        const Json json = Json::parse(text);
        return JsonPattern(file, json).read();
    } catch (const Json::parse_error& error) {
        throw SceneError(file, "is no JSON from its byte " + std::to_string(error.byte) + " on");
    } catch (const Json::exception&) {
        throw SceneError(file, "is no sewing pattern: pattern.panels is missing or of another kind than GarmentCode writes");
    }
}

}  // namespace percale::scenes
