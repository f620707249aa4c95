#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "percale/fabric.h"
#include "percale/settings.h"

namespace percale {

/// One field of an options struct, described once: the scene loader, the validator, `percale explain`
/// and the key table of scenes/README.md all walk these lists.
template <class Owner>
struct Option {
    std::string_view key;                                      // dotted key inside the owner's table of a scene file
    std::string_view unit;                                     // "" if it has none
    std::string_view sentence;                                 // what it does
    double lowest = -std::numeric_limits<double>::infinity();  // allowed range of a number, both ends included
    double highest = std::numeric_limits<double>::infinity();
    std::span<const std::string_view> choices = {};  // allowed words, for choices

    // Exactly one of these is set (`automatic` beside `number`); it names the field.
    double* (*number)(Owner&) = nullptr;
    bool* (*automatic)(Owner&) = nullptr;  // beside `number`: the word "auto" sets it and leaves the number as it is
    int* (*integer)(Owner&) = nullptr;
    bool* (*flag)(Owner&) = nullptr;
    std::optional<double>* (*number_or_auto)(Owner&) = nullptr;  // the word "auto" stands for empty
    int (*get_choice)(const Owner&) = nullptr;                   // index into choices
    void (*set_choice)(Owner&, int) = nullptr;
};

std::span<const Option<Fabric>> fabric_options();
std::span<const Option<StepSettings>> step_options();

/// Throw SceneError naming `owner_name`, the key, the value and the allowed range.
void check_options(const Fabric& fabric, std::string_view owner_name);
void check_options(const StepSettings& settings, std::string_view owner_name);

}  // namespace percale
