#include "picture/picture_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/nearest_name.h"
#include "common/text.h"
#include "frames/cloth_fit.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

// The approximate count of numbers at a bar.
constexpr double wanted_numbers = 5.0;
// Fraction of the values above the range, all of which have the last colour.
constexpr double share_beyond = 0.005;
// In steps: a bound that is a round number up to rounding stays.
constexpr double round_slack = 1e-9;

const std::vector<PictureField>& known_fields() {
    static const std::vector<PictureField> fields = {{"strain", {"strain_warp", "strain_weft"}, "%", 100.0, "strain"},
                                                     {"strain_warp", {"strain_warp"}, "%", 100.0, "strain"},
                                                     {"strain_weft", {"strain_weft"}, "%", 100.0, "strain"},
                                                     {"strain_shear", {"strain_shear"}, "rad", 1.0, "strain"},
                                                     {"pressure", {"pressure"}, "Pa", 1.0, "pressure"},
                                                     {"distance", {"distance"}, "mm", 1000.0, "distance"}};
    return fields;
}

FieldRange widened(double low, double high) {
    if (low < 0.0 && high > 0.0) high = std::max(-low, high), low = -high;
    const double largest = std::max(std::abs(low), std::abs(high)), size = largest > 0.0 ? largest : 1.0;
    if (high - low < 1e-6 * size) low -= 0.5 * size, high += 0.5 * size;
    FieldRange range;
    range.step = round_step((high - low) / wanted_numbers);
    range.low = range.step * std::floor(low / range.step + round_slack);
    range.high = range.step * std::ceil(high / range.step - round_slack);
    return range;
}

}  // namespace

std::vector<std::string> picture_field_words() {
    std::vector<std::string> words;
    for (const PictureField& field : known_fields()) words.push_back(field.word);
    return words;
}

const PictureField& picture_field(const std::string& word) {
    for (const PictureField& field : known_fields())
        if (field.word == word) return field;
    throw SceneError("no field '" + word + "'" + suggestion(word, picture_field_words()));
}

std::vector<double> values_of_file(const PictureField& field, const MeshFields& properties) {
    std::vector<double> values;
    for (const std::string& name : field.properties) {
        const auto found = std::ranges::find(properties.vertex, name, &MeshField::name);
        if (found == properties.vertex.end()) return {};
        if (values.empty()) values.assign(found->values.size(), -std::numeric_limits<double>::infinity());
        for (std::size_t v = 0; v < values.size(); ++v) values[v] = std::max(values[v], field.factor * found->values[v]);
    }
    return values;
}

std::vector<double> distances_to_bodies(const PictureField& field, const TriangleMesh& cloth,
                                        std::span<const ShownShape> shapes) {
    std::vector<TriangleMesh> bodies;
    for (const ShownShape& shape : shapes)
        if (!shape.is_cloth) bodies.push_back(shape.mesh);
    std::vector<double> distances = obstacle_distances(cloth.vertices, bodies);
    for (double& distance : distances) distance *= field.factor;
    return distances;
}

double FieldRange::share(double value) const { return std::clamp((value - low) / (high - low), 0.0, 1.0); }

void FieldSpread::add(const ShownFrame& frame) {
    for (const ShownShape& shape : frame.shapes)
        std::ranges::copy_if(shape.field, std::back_inserter(values_), [](double value) { return std::isfinite(value); });
}

FieldRange FieldSpread::range() const {
    if (values_.empty()) throw SceneError("no cloth that is shown has a finite value of the field");
    std::vector<double> sorted = values_;
    std::ranges::sort(sorted);
    const auto beyond = static_cast<std::size_t>(share_beyond * static_cast<double>(sorted.size()));
    FieldRange range = widened(sorted.front(), sorted[sorted.size() - 1 - beyond]);
    range.some_below = sorted.front() < range.low;
    range.some_above = sorted.back() > range.high;
    return range;
}

FieldRange FieldSpread::range(double low, double high) const {
    if (!std::isfinite(low) || !std::isfinite(high) || !(low < high))
        throw SceneError("the range " + number_text(low) + " ... " + number_text(high) +
                         " of the field must have two finite ends, the lower one first");
    FieldRange range{low, high, round_step((high - low) / wanted_numbers)};
    range.some_below = std::ranges::any_of(values_, [&](double value) { return value < low; });
    range.some_above = std::ranges::any_of(values_, [&](double value) { return value > high; });
    return range;
}

}  // namespace percale::scenes
