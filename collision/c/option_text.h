#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "c/structs.h"
#include "percale/options.h"

// Options by key and text. The options, their ranges and their words are defined by percale/options.h alone.
namespace percale::c_interface {

/// A finite number that takes the whole text. Throws SceneError naming `key`.
double number_of(std::string_view text, std::string_view key);
/// Several such numbers, separated by spaces or a comma.
std::vector<double> numbers_of(std::string_view text, std::string_view key);
/// A text with as many digits as keep every bit.
std::string exact_text(double number);
/// Throws SceneError naming the key, the value and the range.
void check_in_range(std::string_view key, double value, double lowest, double highest);
int whole_number(std::string_view key, double value);

inline constexpr std::string_view flag_words[] = {"false", "true"};

/// The words of an option; empty for numbers.
template <class Owner>
std::span<const std::string_view> words_of(const Option<Owner>& option) {
    return option.flag ? std::span<const std::string_view>(flag_words) : option.choices;
}

template <class Owner>
bool takes_auto(const Option<Owner>& option) {
    return option.automatic || option.zero_is_auto || option.number_or_auto;
}

/// The index of a word among those of an option. Throws SceneError naming them.
int word_index(std::string_view key, std::string_view word, std::span<const std::string_view> words);

/// Throws SceneError naming the existing keys.
template <class Owner>
const Option<Owner>& option_of(std::span<const Option<Owner>> options, std::string_view key) {
    std::string keys;
    for (const Option<Owner>& option : options) {
        if (option.key == key || (!option.former.empty() && option.former == key)) return option;
        keys += (keys.empty() ? "" : ", ") + std::string(option.key);
    }
    throw SceneError(std::string(key), "there is no such option, there are " + keys);
}

template <class Owner>
void set_option_number(Owner& owner, const Option<Owner>& option, double value) {
    const bool is_number = option.number || option.integer || option.number_or_auto || option.optional_number;
    if (!is_number) throw SceneError(std::string(option.key), "does not hold one number, set it by text");
    if (option.integer) {
        const int whole = whole_number(option.key, value);
        check_in_range(option.key, value, option.lowest, option.highest);
        *option.integer(owner) = whole;
        return;
    }
    check_in_range(option.key, value, option.lowest, option.highest);
    if (option.number) *option.number(owner) = value;
    if (option.automatic) *option.automatic(owner) = false;
    if (option.number_or_auto) *option.number_or_auto(owner) = value;
    if (option.optional_number) *option.optional_number(owner) = value;
}

template <class Owner>
void set_option_auto(Owner& owner, const Option<Owner>& option) {
    if (option.automatic) *option.automatic(owner) = true;
    if (option.zero_is_auto) *option.integer(owner) = 0;
    if (option.number_or_auto) option.number_or_auto(owner)->reset();
}

template <class Owner>
void set_option_pair(Owner& owner, const Option<Owner>& option, std::string_view text) {
    const std::vector<double> numbers = numbers_of(text, option.key);
    if (numbers.size() != 2) throw SceneError(std::string(option.key), "\"" + std::string(text) + "\" is not two numbers");
    for (const double number : numbers) check_in_range(option.key, number, option.lowest, option.highest);
    *option.optional_pair(owner) = {numbers[0], numbers[1]};
}

template <class Owner>
void set_option_text(Owner& owner, const Option<Owner>& option, std::string_view text) {
    if (option.get_choice) return option.set_choice(owner, word_index(option.key, text, option.choices));
    if (option.flag) {
        *option.flag(owner) = word_index(option.key, text, flag_words) == 1;
    } else if (text == "auto" && takes_auto(option)) {
        set_option_auto(owner, option);
    } else if (text == "none" && option.optional_number) {
        option.optional_number(owner)->reset();
    } else if (text == "none" && option.optional_pair) {
        option.optional_pair(owner)->reset();
    } else if (option.optional_pair) {
        set_option_pair(owner, option, text);
    } else {
        set_option_number(owner, option, number_of(text, option.key));
    }
}

/// The value as set_option_text takes it.
template <class Owner>
std::string option_text(Owner owner, const Option<Owner>& option) {
    const auto number_or = [](const std::optional<double>& number, const char* word) {
        return number ? exact_text(*number) : std::string(word);
    };
    if (option.get_choice) return std::string(option.choices[option.get_choice(owner)]);
    if (option.flag) return std::string(flag_words[*option.flag(owner) ? 1 : 0]);
    if (option.automatic && *option.automatic(owner)) return "auto";
    if (option.number) return exact_text(*option.number(owner));
    if (option.integer) {
        const int value = *option.integer(owner);
        return value == 0 && option.zero_is_auto ? "auto" : std::to_string(value);
    }
    if (option.number_or_auto) return number_or(*option.number_or_auto(owner), "auto");
    if (option.optional_number) return number_or(*option.optional_number(owner), "none");
    const auto& pair = *option.optional_pair(owner);
    return pair ? exact_text((*pair)[0]) + " " + exact_text((*pair)[1]) : "none";
}

/// Texts are those of the table of options, which are literals.
template <class Owner>
percale_option described(const Option<Owner>& option) {
    auto reported = default_struct<percale_option>();
    reported.takes_auto = takes_auto(option);
    reported.may_be_none = option.optional_number || option.optional_pair;
    reported.word_count = static_cast<int>(words_of(option).size());
    reported.numbers = reported.word_count > 0 ? 0 : option.optional_pair ? 2 : 1;
    reported.integer = option.integer != nullptr;
    reported.key = option.key.data();
    reported.unit = option.unit.data();
    reported.sentence = option.sentence.data();
    reported.lowest = option.lowest;
    reported.highest = option.highest;
    return reported;
}

}  // namespace percale::c_interface
