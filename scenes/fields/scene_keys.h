#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace percale::scenes {

enum class KeyKind {
    text,
    word,            // one of `choices`
    flag,            // true or false
    number,          // in [lowest, highest]
    integer,         // in [lowest, highest]
    number_or_auto,  // or the word "auto"
    integer_or_auto,
    number_or_rest,  // or the word "rest"
    numbers,         // a list of `count`, each in [lowest, highest]
    integers,        // a list of `count`, each in [lowest, highest]
    box,             // [[x, y, z], [x, y, z]], each in [lowest, highest], the first nowhere above the second
    vertices,        // a list of indices, { box = ... } or "boundary"
    names,           // a list of `count` texts
    words,           // one of `choices`, or a list of some of them, none twice
    pairs,           // a list of lists of two integers, each in [lowest, highest]
    stitches,        // a list of lists [i, j, k, t] of three integers, each in [lowest, highest], and a number 0 ... 1
    direction,       // "u", "v" or a list of two or three numbers
    limit,           // a number, { below = }, { above = } or { between = [a, b] }
    table,
    table_or_list,  // [...] or [[...]]
    table_list,     // [[...]]
    named_tables    // [... .NAME]
};

/// One key of a scene file. Rows of field tables hold it (field_table.h); the list of all keys, made of these, is in
/// format/scene_table.h.
struct SceneKey {
    std::string path;  // in a row the key; in the list dotted from the top, names of fabrics left out: "fabric.springs.bend"
    KeyKind kind = KeyKind::text;
    std::string sentence = {};
    std::string unit = {};
    double lowest = -std::numeric_limits<double>::infinity();  // allowed range of numbers, both ends included
    double highest = std::numeric_limits<double>::infinity();
    int count = 0;
    std::vector<std::string> choices = {};
    std::string default_text = {};      // "" if there is none
    bool required = false;              // in its table
    bool alternative = false;           // exactly one of these in its table
    std::string needs = {};             // means nothing without that other key
    std::string needs_why = {};         // "unit is that of a mesh file"
    std::string former = {};            // its name in the release before, which still works
    bool setting = true;                // what a run does depends on it; false: it names or judges the run
    std::vector<SceneKey> inside = {};  // of a table, in a row; empty in the list
};

/// "a number", "a list of 3 numbers", "one of fcl, bullet"; what a value must be.
std::string kind_text(const SceneKey& key);

/// "0 ... 10 m", ">= 0", "" if nothing is excluded.
std::string range_text(const SceneKey& key);

}  // namespace percale::scenes
