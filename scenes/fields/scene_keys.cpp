#include "fields/scene_keys.h"

#include <cmath>

#include "common/text.h"

namespace percale::scenes {

std::string kind_text(const SceneKey& key) {
    switch (key.kind) {
        case KeyKind::text:
            return "a text";
        case KeyKind::word:
            return "one of " + joined(key.choices);
        case KeyKind::flag:
            return "true or false";
        case KeyKind::number:
            return "a number";
        case KeyKind::integer:
            return "a whole number";
        case KeyKind::number_or_auto:
            return "a number or \"auto\"";
        case KeyKind::integer_or_auto:
            return "a whole number or \"auto\"";
        case KeyKind::number_or_rest:
            return "a number or \"rest\"";
        case KeyKind::numbers:
            return "a list of " + std::to_string(key.count) + " numbers";
        case KeyKind::integers:
            return "a list of " + std::to_string(key.count) + " whole numbers";
        case KeyKind::box:
            return "two corners [[x, y, z], [x, y, z]]";
        case KeyKind::vertices:
            return "a list of vertex indices, { box = [[x, y, z], [x, y, z]] } or \"boundary\"";
        case KeyKind::names:
            return "a list of " + std::to_string(key.count) + " names";
        case KeyKind::words:
            return "one of " + joined(key.choices) + ", or a list of some of them";
        case KeyKind::pairs:
            return "a list of pairs [i, j] of vertex indices";
        case KeyKind::stitches:
            return "a list of stitches [i, j, k, t] of three vertex indices and a share 0 ... 1";
        case KeyKind::direction:
            return "\"u\", \"v\", a list of 2 numbers (in uv) or of 3";
        case KeyKind::limit:
            return "a number, { below = a }, { above = a } or { between = [a, b] }";
        case KeyKind::table:
            return "a table";
        case KeyKind::table_or_list:
            return "a table or a list of tables";
        case KeyKind::table_list:
            return "a list of tables";
        case KeyKind::named_tables:
            break;
    }
    return "a table of named tables";
}

std::string range_text(const SceneKey& key) {
    const std::string unit = key.unit.empty() ? "" : " " + key.unit;
    const bool lower = !std::isinf(key.lowest), upper = !std::isinf(key.highest);
    if (lower && upper) return number_text(key.lowest) + " ... " + number_text(key.highest) + unit;
    if (lower) return ">= " + number_text(key.lowest) + unit;
    return upper ? "<= " + number_text(key.highest) + unit : "";
}

}  // namespace percale::scenes
