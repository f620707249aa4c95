#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "percale/fabric.h"
#include "percale/settings.h"

namespace percale {

/// One field of an options struct, described once: the scene loader, the checks, `percale explain`, the settings in report.json
/// and the key table scenes/scene_keys.md all read these lists.
template <class Owner>
struct Option {
    std::string_view key;                                      // dotted key inside the owner's table of a scene file
    std::string_view unit;                                     // "" if it has none
    std::string_view sentence;                                 // its meaning
    std::string_view former = {};                              // the key of the previous release, which still works
    double lowest = -std::numeric_limits<double>::infinity();  // allowed range of a number, both ends included
    double highest = std::numeric_limits<double>::infinity();
    std::span<const std::string_view> choices = {};  // allowed words, for choices
    bool required = false;                           // in its table of a scene file
    bool changes_steps = true;                       // of StepSettings: steps depend on it whatever the state

    // Exactly one of these is set (`automatic` beside `number`); it names the field.
    double* (*number)(Owner&) = nullptr;
    bool* (*automatic)(Owner&) = nullptr;  // beside `number`: the word "auto" sets it and leaves the number as it is
    int* (*integer)(Owner&) = nullptr;
    bool zero_is_auto = false;  // beside `integer`: the word "auto" stands for 0, which is allowed beside the range
    bool* (*flag)(Owner&) = nullptr;
    std::optional<double>* (*number_or_auto)(Owner&) = nullptr;                // the word "auto" stands for empty
    std::optional<double>* (*optional_number)(Owner&) = nullptr;               // may be left out
    std::optional<std::array<double, 2>>* (*optional_pair)(Owner&) = nullptr;  // likewise, each in the range
    int (*get_choice)(const Owner&) = nullptr;                                 // index into choices
    void (*set_choice)(Owner&, int) = nullptr;
};

std::span<const Option<Fabric>> fabric_options();
std::span<const Option<StepSettings>> step_options();

/// A hash of the fields on which steps depend, whatever the state. It leaves out the values that a saved state holds itself
/// (gravity, wind, time_step) and the fields that change no step (Option::changes_steps).
std::uint64_t options_hash(const StepSettings& settings);

/// The schemes, one line each: order, kind, contact, cost and stability.
std::string scheme_table_text();

/// These throw SceneError naming `owner_name`, the key, the value and the allowed range; for a fabric also where two keys exclude
/// each other: springs (other than its default or none) and stretch_stiffness, springs.bend and bend_stiffness, spring_damping
/// and damping_time.
void check_options(const Fabric& fabric, std::string_view owner_name);
void check_options(const StepSettings& settings, std::string_view owner_name);

}  // namespace percale
