#include "format/script_tables.h"

#include <limits>

#include "format/body_tables.h"
#include "format/expectations.h"
#include "format/scene.h"

namespace percale::scenes {
namespace {

template <class Event>
FieldTable<Event> vertex_event_table() {
    return {.fields = {value_field<Event>({.path = "cloth", .sentence = "NAME of a cloth.", .required = true}, &Event::cloth),
                       selection_field<Event>({.path = "vertices", .sentence = "Which of its vertices.", .required = true},
                                              &Event::vertices)}};
}

FieldTable<MoveEvent> move_table() {
    FieldTable<MoveEvent> table = vertex_event_table<MoveEvent>();
    table.fields.push_back(value_field<MoveEvent>({.path = "to",
                                                   .sentence = "How far from where they are then.",
                                                   .unit = "m",
                                                   .lowest = -max_coordinate,
                                                   .highest = max_coordinate,
                                                   .required = true},
                                                  &MoveEvent::to));
    table.fields.push_back(value_field<MoveEvent>(
        {.path = "over", .sentence = "How long it takes.", .unit = "s", .lowest = 1e-6, .highest = max_time, .required = true},
        &MoveEvent::over));
    return table;
}

template <class Event>
Field<EventSpec> vertex_event(const std::string& key, const std::string& sentence, const FieldTable<Event>& table) {
    return variant_table<Event, EventSpec>({.path = key, .sentence = sentence}, &EventSpec::what, table);
}

constexpr double infinity = std::numeric_limits<double>::infinity();

const FieldTable<Expectation>& matches_table() {
    static const FieldTable<Expectation> table = {
        .fields = {
            value_field<Expectation>({.path = "file", .sentence = "The mesh file, relative to the scene file.", .required = true},
                                     &Expectation::file),
            value_field<Expectation>({.path = "within",
                                      .sentence = "Largest distance of a vertex allowed.",
                                      .unit = "m",
                                      .lowest = 0.0,
                                      .highest = max_coordinate,
                                      .required = true},
                                     &Expectation::highest),
        }};
    return table;
}

void read_limit(const TomlNode& node, Expectation& limit) {
    if (node.is_number()) {
        limit.lowest = limit.highest = node.number;
    } else if (const TomlNode* below = node.find("below")) {
        limit.highest = below->number;
        limit.highest_included = false;
    } else if (const TomlNode* above = node.find("above")) {
        limit.lowest = above->number;
        limit.lowest_included = false;
    } else {
        const TomlNode& between = *node.find("between");
        limit.lowest = between.items[0].number;
        limit.highest = between.items[1].number;
    }
}

TomlNode limit_node(const Expectation& limit) {
    if (limit.lowest == limit.highest) return value_node(limit.lowest);
    TomlNode table;
    const bool above = !limit.lowest_included, below = !limit.highest_included;
    TomlNode value = above   ? value_node(limit.lowest)
                     : below ? value_node(limit.highest)
                             : value_node(std::array{limit.lowest, limit.highest});
    value.key = above ? "above" : below ? "below" : "between";
    table.entries.push_back(std::move(value));
    return table;
}

/// The time at which all expectations of a table are judged.
const FieldTable<Expectation>& when_table() {
    static const FieldTable<Expectation> table = {
        .fields =
            {
                value_field<Expectation>(
                    {.path = "at",
                     .sentence = "When this table is looked at, in the first state at that time or after it, and in "
                                 "that alone; in [[expect]], of which there may be several.",
                     .unit = "s",
                     .lowest = 0.0,
                     .highest = max_time},
                    &Expectation::at),
                value_field<Expectation>(
                    {.path = "during",
                     .sentence =
                         "From when to when it is looked at: sums and extremes are those of these states, and "
                         "what a run has at its end (speeds, heights, gaps of seams, `matches`) must hold in each of them.",
                     .unit = "s",
                     .lowest = 0.0,
                     .highest = max_time},
                    &Expectation::during),
            },
        .rules = {.shown = [](const TomlNode&) -> std::string { return "expect"; }, .exclude = {{"at", "during"}}}};
    return table;
}

Expectation expectation_of(const TomlNode& node) {
    Expectation expectation{.measure = node.key, .lowest = -infinity, .highest = infinity, .file = {}, .place = node.key_place};
    FaultList first(false);
    if (node.find("file") != nullptr) {
        read_fields(node, matches_table(), expectation, first);
    } else {
        read_limit(node, expectation);
    }
    return expectation;
}

/// The expectations of one table.
void read_expectations(const TomlNode& table, std::vector<Expectation>& list) {
    Expectation when;
    FaultList first(false);
    read_fields(table, when_table(), when, first);
    if (when.during && when.during->front() > when.during->back())
        fail_at(table.find("during")->place, "expect.during ends before it begins");
    for (const TomlNode& entry : table.entries) {
        if (entry.key == "at" || entry.key == "during") continue;
        Expectation& expectation = list.emplace_back(expectation_of(entry));
        expectation.at = when.at;
        expectation.during = when.during;
    }
}

TomlNode expectation_node(const Expectation& expectation) {
    TomlNode node = expectation.file.empty() ? limit_node(expectation) : spec_node(matches_table(), expectation);
    node.key = expectation.measure;
    return node;
}

/// A table for each time that follows another one.
std::optional<TomlNode> expectations_node(const Scene& scene) {
    TomlNode list;
    list.kind = TomlKind::list;
    const Expectation* last = nullptr;
    for (const Expectation& expectation : scene.expectations) {
        const bool same = last != nullptr && last->at == expectation.at && last->during == expectation.during;
        if (!same || list.items.back().find(expectation.measure) != nullptr)
            list.items.push_back(spec_node(when_table(), expectation));
        list.items.back().entries.push_back(expectation_node(expectation));
        last = &expectation;
    }
    if (list.items.empty()) return TomlNode{};
    return list.items.size() == 1 ? std::move(list.items.front()) : std::move(list);
}

std::vector<SceneKey> expect_keys() {
    std::vector<SceneKey> keys = keys_of(when_table());
    for (const MeasureDescription& measure : measure_descriptions())
        keys.push_back({.path = measure.name, .kind = KeyKind::limit, .sentence = measure.sentence, .unit = measure.unit});
    keys.push_back({.path = "matches",
                    .kind = KeyKind::table,
                    .sentence = "Compares the vertices at the end with a mesh, in the same order.",
                    .inside = keys_of(matches_table())});
    return keys;
}

}  // namespace

namespace {

Field<SeamSpec> weld_field() {
    return value_field<SeamSpec>(
        {.path = "weld",
         .sentence =
             "true: no gap is left at rest, as if the sides were one; once closed, stitches pull harder step by step until "
             "they meet, with at most stiffness times 1 cm."},
        &SeamSpec::weld);
}

Field<SeamSpec> closing_time(const std::string& key, const std::string& former, const std::string& sentence,
                             double SeamSpec::*time) {
    return value_field<SeamSpec>(
        {.path = key, .sentence = sentence, .unit = "s", .lowest = 0.0, .highest = max_time, .former = former}, time);
}

}  // namespace

const FieldTable<SeamSpec>& seam_table() {
    static const FieldTable<SeamSpec> table = {
        .fields =
            {
                value_field<SeamSpec>(
                    {.path = "name", .sentence = "For messages and report.json; without one a seam has its number."},
                    &SeamSpec::name),
                value_field<SeamSpec>(
                    {.path = "cloths",
                     .sentence =
                         "NAMEs of the two cloths; twice the same is one with itself, as is an only cloth without this key."},
                    &SeamSpec::cloths),
                value_field<SeamSpec>({.path = "vertices",
                                       .sentence = "Pairs [i, j], i a vertex of the first cloth, j one of the second.",
                                       .lowest = 0,
                                       .highest = 2147483647},
                                      &SeamSpec::vertices),
                value_field<SeamSpec>({.path = "points",
                                       .sentence = "Stitches [i, j, k, t]: vertex i of the first cloth joins the point "
                                                   "(1 - t) x_j + t x_k between two vertices of the second.",
                                       .lowest = 0,
                                       .highest = 2147483647},
                                      &SeamSpec::points),
                value_field<SeamSpec>(
                    {.path = "file",
                     .sentence = "A text file of stitches, a line \"i j\" or \"i j k t\" each, relative to the scene "
                                 "file; \"mesh\": the lines \"stitch i j k t\" of the cloth's OBJ file."},
                    &SeamSpec::file),
                closing_time("start_time", "from",
                             "When closing begins; before, each stitch keeps the length that it starts with.",
                             &SeamSpec::start_time),
                closing_time("duration", "over", "How long closing takes.", &SeamSpec::duration),
                value_field<SeamSpec>({.path = "stiffness",
                                       .sentence = "Constant of the spring that draws a stitch together and then holds it.",
                                       .unit = "N/m",
                                       .lowest = 1e-3,
                                       .highest = 1e9},
                                      &SeamSpec::stiffness),
                value_field<SeamSpec>(
                    {.path = "contact_while_closing",
                     .sentence = "false: until this seam has closed the cloths that it joins meet neither each other nor "
                                 "themselves nor cloth of another layer; what then crosses is untangled. For panels that start "
                                 "over each other, or are sewn around another garment."},
                    &SeamSpec::contact_while_closing),
                weld_field(),
            },
        .rules = {.shown = [](const TomlNode&) -> std::string { return "seam"; },
                  .at_least_one = {"vertices", "points", "file"},
                  .at_least_one_why = "what is sewn together"}};
    return table;
}

const FieldTable<PairSpec>& pair_table() {
    static const FieldTable<PairSpec> table = {
        .fields =
            {
                value_field<PairSpec>({.path = "cloths",
                                       .sentence = "NAMEs of the two cloths; twice the same is one with itself.",
                                       .required = true},
                                      &PairSpec::cloths),
                value_field<PairSpec>({.path = "contact", .sentence = "false: they pass through each other."},
                                      &PairSpec::contact),
                value_field<PairSpec>(
                    {.path = "thickness",
                     .sentence = "Below this distance they are in contact; without it the mean of their thicknesses.",
                     .unit = "m",
                     .lowest = 1e-6,
                     .highest = 1.0},
                    &PairSpec::thickness),
            },
        .rules = {.shown = [](const TomlNode&) -> std::string { return "pair"; }}};
    return table;
}

const FieldTable<EventSpec>& event_table() {
    static const FieldTable<EventSpec> table = {
        .fields = {value_field<EventSpec>({.path = "time",
                                           .sentence = "When; after the end of the scene it does not happen.",
                                           .unit = "s",
                                           .lowest = 0.0,
                                           .highest = max_time,
                                           .required = true},
                                          &EventSpec::time),
                   vertex_event("pin", "Holds vertices where they are then.", vertex_event_table<PinEvent>()),
                   vertex_event("unpin", "Lets vertices go.", vertex_event_table<UnpinEvent>()),
                   vertex_event("move", "Moves pinned vertices along a straight line.", move_table()),
                   variant_value<GravityEvent, EventSpec>(
                       {.path = "gravity", .sentence = "Gravity from then on.", .unit = "m/s^2", .lowest = -1e4, .highest = 1e4},
                       &EventSpec::what, &GravityEvent::gravity),
                   variant_value<WindEvent, EventSpec>(
                       {.path = "wind",
                        .sentence = "Velocity of the air from then on. Before the first wind there is no air; [0, 0, 0] stands "
                                    "still.",
                        .unit = "m/s",
                        .lowest = -1e3,
                        .highest = 1e3},
                       &EventSpec::what, &WindEvent::wind)},
        .rules = {.shown = [](const TomlNode&) -> std::string { return "event"; }}};
    return table;
}

Field<Scene> expect_field() {
    return {.key = {.path = "expect",
                    .kind = KeyKind::table_or_list,
                    .sentence = "What makes the scene a test: [expect] of the whole run, or [[expect]], each with its time.",
                    .setting = false,
                    .inside = expect_keys()},
            .read =
                [](const TomlNode& node, Scene& scene, FaultList& faults) {
                    if (node.kind == TomlKind::table) return read_expectations(node, scene.expectations);
                    for (const TomlNode& table : node.items)
                        faults.attempt([&] { read_expectations(table, scene.expectations); });
                },
            .write = expectations_node};
}

}  // namespace percale::scenes
