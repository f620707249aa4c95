#include "study/study.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/input_file.h"
#include "common/nearest_name.h"
#include "common/scene_file_error.h"
#include "common/text.h"
#include "export/run_settings.h"
#include "fields/toml_text.h"
#include "format/expectations.h"
#include "format/scene_file.h"
#include "percale/error.h"
#include "study/draws.h"

namespace percale::scenes {

namespace {

using nlohmann::ordered_json;

/// How a key goes through the runs: its values one after another, or one drawn for each run.
struct Variation {
    std::string form = "list";
    std::vector<std::string> values = {};
    std::function<double(Draws&)> draw = {};  // null: of `values`
};

const std::vector<std::string> study_keys = {"scene", "seed", "draws", "frames", "plot", "vary"};
const std::vector<std::string> range_forms = {"from", "to", "count", "scale"};
const std::vector<std::string> random_forms = {"uniform", "log_uniform", "normal"};

bool is_in(const std::vector<std::string>& words, const std::string& word) {
    return std::ranges::find(words, word) != words.end();
}

void check_known(const TomlNode& table, const std::string& shown, const std::vector<std::string>& valid) {
    for (const TomlNode& node : table.entries)
        if (!is_in(valid, node.key))
            fail_at(node.key_place, "unknown key '" + node.key + "' in " + shown + suggestion(node.key, valid));
}

double number_at(const TomlNode& table, const std::string& key) {
    const TomlNode* node = table.find(key);
    if (node == nullptr) fail_at(table.place, "a range has from, to and count; this one lacks '" + key + "'");
    if (!node->is_number() || !std::isfinite(node->number)) fail_at(node->place, key + " must be a number");
    return node->number;
}

long whole_number(const TomlNode& node, const std::string& shown, long lowest, long highest) {
    if (node.kind != TomlKind::integer || node.integer < lowest || node.integer > highest)
        fail_at(node.place, shown + " must be a whole number, " + std::to_string(lowest) + " ... " + std::to_string(highest) +
                                ", not " + described(node));
    return node.integer;
}

Variation range_of(const TomlNode& node) {
    check_known(node, "a range", range_forms);
    const double from = number_at(node, "from"), to = number_at(node, "to");
    number_at(node, "count");
    const long count = whole_number(*node.find("count"), "count", 2, max_runs);
    const TomlNode* scale = node.find("scale");
    const bool log = scale != nullptr && scale->text == "log";
    if (scale != nullptr && !log && scale->text != "linear") fail_at(scale->place, "scale must be \"linear\" or \"log\"");
    if (log && !(from > 0.0 && to > 0.0)) fail_at(node.place, "a logarithmic range must be of numbers above 0");
    Variation variation{.form = log ? "log" : "linear"};
    for (long k = 0; k < count; ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(count - 1);
        const double value =
            log ? std::exp(std::log(from) + share * (std::log(to) - std::log(from))) : from + share * (to - from);
        variation.values.push_back(number_text(k == 0 ? from : k == count - 1 ? to : value));
    }
    return variation;
}

Variation random_of(const TomlNode& node, const std::string& form) {
    const TomlNode& pair = *node.find(form);
    if (node.entries.size() != 1) fail_at(node.place, "a random value has one of " + joined(random_forms) + " and nothing else");
    const bool two =
        pair.kind == TomlKind::list && pair.items.size() == 2 && pair.items[0].is_number() && pair.items[1].is_number();
    if (!two) fail_at(pair.place, form + " must be a list of 2 numbers, not " + described(pair));
    const double a = pair.items[0].number, b = pair.items[1].number;
    if (form == "normal") {
        if (!(b >= 0.0)) fail_at(pair.place, "normal = [mean, deviation]: the deviation must be at least 0");
        return {form, {}, [=](Draws& draws) { return draws.normal(a, b); }};
    }
    if (!(a <= b)) fail_at(pair.place, form + " ends before it begins");
    if (form == "uniform") return {form, {}, [=](Draws& draws) { return draws.uniform(a, b); }};
    if (!(a > 0.0)) fail_at(pair.place, "log_uniform must be of numbers above 0");
    return {form, {}, [=](Draws& draws) { return draws.log_uniform(a, b); }};
}

Variation variation_of(const TomlNode& node) {
    if (node.kind == TomlKind::list) {
        if (node.items.empty()) fail_at(node.place, "vary." + node.key + " is an empty list");
        Variation variation;
        for (const TomlNode& item : node.items) variation.values.push_back(toml_text(item));
        return variation;
    }
    if (node.kind != TomlKind::table)
        fail_at(node.place,
                "vary." + node.key +
                    " must be a list of values, a range { from, to, count } or a random value { uniform = [a, b] }, not " +
                    described(node));
    for (const std::string& form : random_forms)
        if (node.find(form) != nullptr) return random_of(node, form);
    return range_of(node);
}

/// One run for each combination and draw.
void expand(Study& study, const std::vector<Variation>& variations, long draws, std::uint64_t first) {
    std::size_t count = static_cast<std::size_t>(draws);
    for (const Variation& variation : variations) {
        if (variation.draw) continue;
        count *= variation.values.size();
        if (count > max_runs)
            throw SceneError(study.file + ": more than " + std::to_string(max_runs) +
                             " runs, which is the most that a study may have");
    }
    Draws random(first);
    for (std::size_t run = 0; run < count; ++run) {
        std::vector<std::string>& values = study.runs.emplace_back(variations.size());
        std::size_t left = run / static_cast<std::size_t>(draws);
        for (std::size_t k = variations.size(); k-- > 0;) {
            const Variation& variation = variations[k];
            if (variation.draw) continue;
            values[k] = variation.values[left % variation.values.size()];
            left /= variation.values.size();
        }
        for (std::size_t k = 0; k < variations.size(); ++k)
            if (variations[k].draw) values[k] = number_text(variations[k].draw(random));
    }
}

std::string text_at(const TomlNode& document, const std::string& key) {
    const TomlNode* node = document.find(key);
    if (node != nullptr && node->kind != TomlKind::text) fail_at(node->place, key + " must be a text, not " + described(*node));
    return node != nullptr ? node->text : "";
}

/// plot = [KEY, MEASURE]; without, the first key that has numbers.
void choose_plot(Study& study, const TomlNode* node) {
    std::vector<std::string> numeric, measures;
    for (std::size_t k = 0; k < study.keys.size(); ++k)
        if (std::ranges::all_of(study.runs, [&](const auto& run) { return is_number(run[k]); })) numeric.push_back(study.keys[k]);
    if (!numeric.empty()) study.plot_key = numeric.front();
    if (node == nullptr) return;
    for (const MeasureDescription& measure : measure_descriptions()) measures.push_back(measure.name);
    const bool two = node->kind == TomlKind::list && node->items.size() == 2;
    if (!two) fail_at(node->place, "plot must be a list of a key and a measure, not " + described(*node));
    study.plot_key = node->items[0].text;
    study.plot_measure = node->items[1].text;
    if (!is_in(study.keys, study.plot_key))
        fail_at(node->place,
                "plot: '" + study.plot_key + "' is none of the keys that vary" + suggestion(study.plot_key, study.keys));
    if (!is_in(numeric, study.plot_key)) fail_at(node->place, "plot: not all values of '" + study.plot_key + "' are numbers");
    if (!is_in(measures, study.plot_measure))
        fail_at(node->place, "plot: no measure '" + study.plot_measure + "'" + suggestion(study.plot_measure, measures));
}

/// Throws the error of the first run whose scene is refused.
void check_runs(const Study& study, const TomlNode& vary) {
    const std::string count = " of " + std::to_string(study.runs.size()) + ": ";
    for (std::size_t run = 0; run < study.runs.size(); ++run)
        at_place(vary.place, "run " + std::to_string(run) + count, [&] { load_scene(study.scene, overrides_of(study, run)); });
}

}  // namespace

bool is_random_form(const std::string& form) { return is_in(random_forms, form); }
bool is_log_form(const std::string& form) { return form.starts_with("log"); }

bool is_number(const std::string& value) {
    char* end = nullptr;
    std::strtod(value.c_str(), &end);
    return !value.empty() && *end == '\0';
}

std::string shown_value(const std::string& value) { return value.starts_with('"') ? parse_toml_value(value, {}).text : value; }

bool is_study_file(const std::string& file) {
    const TomlNode document = parse_toml(read_text(file), file);
    return document.find("scene") != nullptr || document.find("vary") != nullptr;
}

Study read_study(const std::string& file) {
    const TomlNode document = parse_toml(read_text(file), file);
    check_known(document, "a study", study_keys);
    const std::string scene = text_at(document, "scene");
    if (scene.empty()) throw SceneError(file + ": a study needs scene = \"FILE\", the scene that it varies");
    Study study{
        .file = file, .scene = (std::filesystem::path(file).parent_path() / scene).string(), .keys = {}, .forms = {}, .runs = {}};
    if (document.find("frames") != nullptr) study.frames = text_at(document, "frames");
    const TomlNode* vary = document.find("vary");
    if (vary == nullptr || vary->kind != TomlKind::table || vary->entries.empty())
        throw SceneError(file + ": a study needs [vary], the keys of the scene that change and their values");
    std::vector<Variation> variations;
    for (const TomlNode& node : vary->entries) {
        study.keys.push_back(node.key);
        study.forms.push_back(variations.emplace_back(variation_of(node)).form);
    }
    const TomlNode *draws = document.find("draws"), *first = document.find("seed");
    const bool random = std::ranges::any_of(variations, [](const Variation& variation) { return bool(variation.draw); });
    for (const TomlNode* node : {draws, first})
        if (node != nullptr && !random) fail_at(node->key_place, node->key + " is for random values, and [vary] has none");
    expand(study, variations, draws != nullptr ? whole_number(*draws, "draws", 1, max_runs) : 1,
           static_cast<std::uint64_t>(first != nullptr ? whole_number(*first, "seed", 0, 1L << 53) : 0));
    check_runs(study, *vary);
    choose_plot(study, document.find("plot"));
    return study;
}

std::vector<Override> overrides_of(const Study& study, std::size_t run) {
    std::vector<Override> overrides;
    for (std::size_t k = 0; k < study.keys.size(); ++k) overrides.push_back({study.keys[k], study.runs[run][k]});
    overrides.push_back({"output.frames", study.frames});
    return overrides;
}

std::string study_text(const Study& study) {
    const ordered_json json = {{"scene", std::filesystem::absolute(study.scene).lexically_normal().string()},
                               {"frames", study.frames},
                               {"plot", {study.plot_key, study.plot_measure}},
                               {"keys", study.keys},
                               {"forms", study.forms},
                               {"runs", study.runs},
                               {"settings", ordered_json::parse(settings_text(load_scene(study.scene)))}};
    return json.dump(1) + "\n";
}

Study stored_study(const std::string& file) {
    const std::string text = read_text(file);
    try {
        const auto json = ordered_json::parse(text);
        Study study{.file = file,
                    .scene = json.at("scene"),
                    .frames = json.at("frames"),
                    .plot_key = json.at("plot").at(0),
                    .plot_measure = json.at("plot").at(1),
                    .keys = json.at("keys"),
                    .forms = json.value("forms", std::vector<std::string>(json.at("keys").size(), "list")),  // earlier: none
                    .runs = json.at("runs")};
        const auto whole = [&](const std::vector<std::string>& run) { return run.size() == study.keys.size(); };
        if (study.forms.size() == study.keys.size() && std::ranges::all_of(study.runs, whole)) return study;
    } catch (const ordered_json::exception&) {
    }
    throw SceneError(file + ": is not what percale sweep has written");
}

}  // namespace percale::scenes
