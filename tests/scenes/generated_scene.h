#pragma once

#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "scenes/common/text.h"
#include "scenes/format/scene_table.h"

namespace percale::scenes::test {

/// Scene files made from the tables of fields alone: every key with a value in its range, but one if that is asked for.
class GeneratedScene {
public:
    explicit GeneratedScene(unsigned seed, double chance = 0.0) : chance_(chance), random_(seed) {}

    /// A key that must be there; once, with `value` in place of one in range, or with `ending` behind its name.
    std::string wanted = {};
    std::optional<std::string> value = {};
    std::string ending = {};

    std::string text() {
        choose_fabric();
        choose_end();
        return entries(keys_of(scene_table()), "", "\n") + "\n";
    }

    /// A value of this key, as a scene file writes it.
    std::string value_of(const SceneKey& key, const std::string& path) {
        switch (key.kind) {
            case KeyKind::text:
                return text_of(path);
            case KeyKind::word:
                return "\"" + one_of(key.choices) + "\"";
            case KeyKind::flag:
                return one_of({"true", "false"});
            case KeyKind::number:
                return number_of(key, path);
            case KeyKind::integer:
                return integer_of(key);
            case KeyKind::integer_or_auto:
                return below(3) == 0 ? "\"auto\"" : integer_of(key);
            case KeyKind::number_or_auto:
                return below(3) == 0 ? "\"auto\"" : number_of(key, path);
            case KeyKind::number_or_rest:
                return until_rest_ ? "\"rest\"" : number_of(key, path);
            case KeyKind::numbers:
                return numbers_of(key, path);
            case KeyKind::integers:
                return list(key.count, [&] { return integer_of(key); });
            case KeyKind::box:
                return path == wanted && value ? once() : box_of(key);
            case KeyKind::vertices:
                return vertices_of(key, path);
            case KeyKind::names:
                return list(key.count, [&] { return one_of({"\"c0\"", "\"c1\""}); });
            case KeyKind::words:
                if (path == "output.frames") return "\"" + one_of(key.choices) + "\"";  // one is written as that
                return below(2) == 0 ? "[]" : "[\"" + one_of(key.choices) + "\"]";
            case KeyKind::pairs:
                return list(1 + below(3), [&] { return list(2, [&] { return integer_of(key); }); });
            case KeyKind::stitches:
                return list(1 + below(3),
                            [&] { return "[" + integer_of(key) + ", " + integer_of(key) + ", " + integer_of(key) + ", 0.25]"; });
            case KeyKind::direction:
                return below(2) == 0 ? one_of({"\"u\"", "\"v\""}) : list(2, [&] { return number_of(key, path); });
            case KeyKind::limit:
                return limit_of(key, path);
            case KeyKind::table:
            case KeyKind::table_or_list:  // a list of one table is written as that
                return table_of(key, path);
            case KeyKind::table_list:
                return tables_of(key, path);
            case KeyKind::named_tables:
                break;
        }
        const std::string first = "{ f0 = " + table_of(key, path);
        return first + ", f1 = " + table_of(key, path) + " }";
    }

private:
    double uniform(double lowest, double highest) { return std::uniform_real_distribution<double>(lowest, highest)(random_); }
    int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
    std::string one_of(const std::vector<std::string>& texts) {
        return texts[static_cast<std::size_t>(below(static_cast<int>(texts.size())))];
    }
    bool leads_to_wanted(const std::string& path) const { return wanted == path || wanted.starts_with(path + "."); }

    /// Which of the keys that exclude each other a fabric has.
    void choose_fabric() {
        const bool presets = wanted == "fabric.preset" || (wanted.empty() && below(3) == 0);
        const std::set<std::string> of_moduli = {"fabric.stretch_stiffness", "fabric.shear_stiffness", "fabric.poisson_ratio"};
        const bool moduli = of_moduli.contains(wanted) || (wanted.empty() && !presets && below(2) == 0);
        must_ = {"fabric", "cloth.rest", "seam.cloths", "seam.vertices",
                 presets  ? "fabric.preset"
                 : moduli ? "fabric.stretch_stiffness"
                          : "fabric.springs"};
        banned_ = of_moduli;
        banned_.insert("fabric.preset");
        if (presets || moduli) banned_ = {"fabric.springs", "fabric.membrane", presets ? "" : "fabric.preset"};
        const std::pair<std::string, std::string> either[] = {{"fabric.springs.bend", "fabric.bend_stiffness"},
                                                              {"fabric.spring_damping", "fabric.damping_time"},
                                                              {"fabric.pressure", "fabric.gas_volume"},
                                                              {"expect.at", "expect.during"}};
        for (const auto& [one, other] : either) banned_.insert(wanted == one || (wanted != other && below(2) == 0) ? other : one);
    }

    /// Only scenes that end at rest have a max_duration.
    void choose_end() {
        until_rest_ = wanted == "max_duration" || (wanted.empty() && below(2) == 0);
        until_rest_ ? must_.insert("duration") : banned_.insert("max_duration");
    }

    bool has(const SceneKey& key, const std::string& path) {
        if (banned_.contains(path)) return false;
        return key.required || key.kind == KeyKind::box || must_.contains(path) || leads_to_wanted(path) ||
               uniform(0.0, 1.0) < chance_;
    }

    /// The alternative that is there; "" in a table without.
    std::string chosen(const std::vector<SceneKey>& keys, const std::string& prefix) {
        std::vector<std::string> all;
        std::string needed;
        for (const SceneKey& key : keys) {
            const bool leads = leads_to_wanted(prefix + key.path);
            if (key.alternative) all.push_back(key.path);
            if (leads && (key.alternative || !key.needs.empty())) needed = key.alternative ? key.path : key.needs;
        }
        if (all.empty() || !needed.empty()) return needed;
        return one_of(all);
    }

    std::string entries(const std::vector<SceneKey>& keys, const std::string& prefix, const std::string& between) {
        const std::string alternative = chosen(keys, prefix);
        std::string text;
        for (const SceneKey& key : keys) {
            const std::string path = prefix + key.path;
            if (key.alternative ? key.path != alternative : !has(key, path)) continue;
            if (!key.needs.empty() && key.needs != alternative) continue;
            std::string name = key.path;
            if (path == wanted) name += std::exchange(ending, "");
            text += (text.empty() ? "" : between) + name + " = " + (path == wanted && value ? once() : value_of(key, path));
        }
        return text;
    }

    std::string once() {
        std::string text = *value;
        value.reset();
        return text;
    }

    std::string table_of(const SceneKey& key, const std::string& path) {
        return "{ " + entries(key.inside, path + ".", ", ") + " }";
    }

    std::string tables_of(const SceneKey& key, const std::string& path) {
        const int count = path == "cloth" ? 2 : chance_ > 0.0 ? 1 + below(3) : 1;
        std::string text;
        for (int i = 0; i < count; ++i) {
            item_ = i;
            text += (i > 0 ? ", " : "") + table_of(key, path);
        }
        return "[" + text + "]";
    }

    std::string number_of(const SceneKey& key, const std::string& path) {
        if (path.ends_with(".time")) return number_text(item_ + uniform(0.0, 0.9));
        const double lowest = std::isinf(key.lowest) ? -10.0 : key.lowest, highest = std::isinf(key.highest) ? 10.0 : key.highest;
        const bool logarithmic = lowest > 0.0 && highest > 10.0 * lowest;
        return number_text(logarithmic ? std::exp(uniform(std::log(lowest), std::log(highest))) : uniform(lowest, highest));
    }

    std::string integer_of(const SceneKey& key) {
        const auto lowest = static_cast<int>(key.lowest);
        return std::to_string(lowest + below(static_cast<int>(std::min(key.highest - lowest, 1e3)) + 1));
    }

    template <class Make>
    std::string list(int count, Make make) {
        std::string text;
        for (int i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + make();
        return "[" + text + "]";
    }

    /// Directions are such that normalising them again gives the same bits.
    std::string numbers_of(const SceneKey& key, const std::string& path) {
        if (key.count == 4) return one_of({"[1, 0, 0, 0]", "[0, 1, 0, 0]", "[0, 0, -1, 0]", "[0.5, 0.5, -0.5, 0.5]"});
        if (path == "expect.during") return list(2, [&, end = uniform(0.0, 1.0)]() mutable { return number_text(end += 1.0); });
        if (path.ends_with(".axis")) return one_of({"[0, 0, -4]", "[2, 0, 0]", "[0, -0.5, 0]", "[0, 0, 1]"});
        return list(key.count, [&] { return number_of(key, path); });
    }

    /// A name that exists in the scene.
    std::string text_of(const std::string& path) {
        if (path.ends_with(".name"))
            return "\"" + std::string(path.starts_with("cloth") ? "c" : "o") + std::to_string(item_) + "\"";
        if (path == "cloth.rest") return "\"uv\"";
        if (path.ends_with(".fabric")) return one_of({"\"f0\"", "\"f1\""});
        if (path.ends_with(".cloth")) return one_of({"\"c0\"", "\"c1\""});
        return "\"some text " + std::to_string(below(1000000)) + "\"";
    }

    std::string box_of(const SceneKey& key) {
        const double middle = 0.5 * (key.lowest + key.highest);
        const auto corner = [&](double lowest, double highest) {
            return list(3, [&] { return number_text(uniform(lowest, highest)); });
        };
        const std::string first = corner(key.lowest, middle);
        return "[" + first + ", " + corner(middle, key.highest) + "]";
    }

    std::string vertices_of(const SceneKey& key, const std::string& path) {
        const int form = wanted.starts_with(path + ".") ? 2 : below(3);
        if (form == 0) return "\"boundary\"";
        if (form == 1) return list(1 + below(4), [&] { return std::to_string(below(100)); });
        return table_of(key, path);
    }

    std::string limit_of(const SceneKey& key, const std::string& path) {
        const std::string number = number_of(key, path);
        const int form = below(4);
        if (form == 0) return number;
        if (form == 1) return "{ below = " + number + " }";
        return form == 2 ? "{ above = " + number + " }" : "{ between = [" + number + ", 11.5] }";
    }

    double chance_;
    std::mt19937 random_;
    std::set<std::string> must_, banned_;
    bool until_rest_ = false;
    int item_ = 0;
};

}  // namespace percale::scenes::test
