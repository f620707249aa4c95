#include <memory>

#include "c/handles.h"
#include "c/option_text.h"
#include "percale/fabric_presets.h"

// Library, step settings and fabrics of percale.h.

using namespace percale::c_interface;

namespace {

template <class Handle>
percale_status make_owned(const char* function, Handle** made, const decltype(Handle::value)& value) noexcept {
    return call(function, [&] {
        Handle*& place = demanded(made, "the place for what is made");
        place = std::make_unique<Handle>(Handle{value}).release();
    });
}

template <class Handle, class Options>
percale_status set_by_text(const char* function, Handle* handle, const Options& options, const char* key,
                           const char* value) noexcept {
    return call(function, [&] {
        auto& owner = demanded(handle, "the object").value;
        const auto& option = option_of(options, &demanded(key, "key"));
        set_option_text(owner, option, &demanded(value, "value"));
    });
}

template <class Handle, class Options>
percale_status set_by_number(const char* function, Handle* handle, const Options& options, const char* key,
                             double value) noexcept {
    return call(function, [&] {
        auto& owner = demanded(handle, "the object").value;
        set_option_number(owner, option_of(options, &demanded(key, "key")), value);
    });
}

template <class Handle, class Options>
percale_status report_option(const char* function, const Handle* handle, const Options& options, const char* key,
                             const Buffer<char>& text) noexcept {
    return call(function, [&] {
        const auto& owner = demanded(handle, "the object").value;
        give_text(option_text(owner, option_of(options, &demanded(key, "key"))), text);
    });
}

template <class Options>
percale_status describe(const char* function, const Options& options, std::size_t number, percale_option* reported) noexcept {
    return call(function, [&] {
        percale_option& place = known(reported, "option");
        if (number >= options.size()) {
            throw percale::SceneError("option " + std::to_string(number),
                                      "options are 0 ... " + std::to_string(options.size() - 1));
        }
        place = described(options[number]);
    });
}

template <class Options>
const char* word_of_option(const Options& options, std::size_t number, int word) noexcept {
    if (number >= options.size()) return nullptr;
    const auto words = words_of(options[number]);
    return word < 0 || word >= static_cast<int>(words.size()) ? nullptr : words[word].data();
}

}  // namespace

percale_status percale_create_step_settings(percale_step_settings** settings) { return make_owned(__func__, settings, {}); }
void percale_destroy_step_settings(percale_step_settings* settings) { delete settings; }

percale_status percale_set_step_option(percale_step_settings* settings, const char* key, const char* value) {
    return set_by_text(__func__, settings, percale::step_options(), key, value);
}

percale_status percale_set_step_number(percale_step_settings* settings, const char* key, double value) {
    return set_by_number(__func__, settings, percale::step_options(), key, value);
}

percale_status percale_step_option(const percale_step_settings* settings, const char* key, char* text, size_t capacity,
                                   size_t* count) {
    return report_option(__func__, settings, percale::step_options(), key, {text, capacity, count});
}

size_t percale_step_option_count(void) { return percale::step_options().size(); }

percale_status percale_describe_step_option(size_t number, percale_option* option) {
    return describe(__func__, percale::step_options(), number, option);
}

const char* percale_step_option_word(size_t number, int word) { return word_of_option(percale::step_options(), number, word); }

percale_status percale_create_fabric(const char* preset, percale_fabric** fabric) {
    percale::Fabric value;
    const percale_status status = call(__func__, [&] {
        if (preset != nullptr) value = percale::fabric_preset(preset);
    });
    return status == PERCALE_OK ? make_owned(__func__, fabric, value) : status;
}

void percale_destroy_fabric(percale_fabric* fabric) { delete fabric; }

percale_status percale_set_fabric_option(percale_fabric* fabric, const char* key, const char* value) {
    return set_by_text(__func__, fabric, percale::fabric_options(), key, value);
}

percale_status percale_set_fabric_number(percale_fabric* fabric, const char* key, double value) {
    return set_by_number(__func__, fabric, percale::fabric_options(), key, value);
}

percale_status percale_fabric_option(const percale_fabric* fabric, const char* key, char* text, size_t capacity, size_t* count) {
    return report_option(__func__, fabric, percale::fabric_options(), key, {text, capacity, count});
}

size_t percale_fabric_option_count(void) { return percale::fabric_options().size(); }

percale_status percale_describe_fabric_option(size_t number, percale_option* option) {
    return describe(__func__, percale::fabric_options(), number, option);
}

const char* percale_fabric_option_word(size_t number, int word) {
    return word_of_option(percale::fabric_options(), number, word);
}

percale_status percale_make_fabric_isotropic(percale_fabric* fabric) {
    return call(__func__, [&] {
        percale::Fabric& value = demanded(fabric, "fabric").value;
        value = percale::isotropic(value);
    });
}

size_t percale_fabric_preset_count(void) { return percale::fabric_presets().size(); }

const char* percale_fabric_preset_name(size_t number) {
    const auto presets = percale::fabric_presets();
    return number < presets.size() ? presets[number].name.data() : nullptr;
}

const char* percale_fabric_preset_source(size_t number) {
    const auto presets = percale::fabric_presets();
    return number < presets.size() ? presets[number].source.data() : nullptr;
}
