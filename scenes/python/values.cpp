#include "python/values.h"

#include <pybind11/numpy.h>

#include "fields/toml_text.h"
#include "percale/error.h"
#include "python/arrays.h"

namespace percale::python {
namespace {

using scenes::TomlKind;
using scenes::TomlNode;

/// Where in what was given a value stands: "cloth[0].grid".
std::string inside(const std::string& shown, const std::string& key) { return shown.empty() ? key : shown + "." + key; }

TomlNode converted_value(py::handle value, const std::string& name, const std::string& shown);

void put_table(const py::dict& dict, const std::string& name, const std::string& shown, TomlNode& node) {
    node.kind = TomlKind::table;
    for (const auto& [key, value] : dict) {
        if (!py::isinstance<py::str>(key)) throw SceneError(inside(shown, py::repr(key)) + ": a key must be a str");
        const std::string text = key.cast<std::string>();
        node.entries.push_back(converted_value(value, name, inside(shown, text)));
        node.entries.back().key = text;
    }
}

void put_list(const py::sequence& list, const std::string& name, const std::string& shown, TomlNode& node) {
    node.kind = TomlKind::list;
    for (std::size_t i = 0; i < list.size(); ++i)
        node.items.push_back(converted_value(list[i], name, shown + "[" + std::to_string(i) + "]"));
}

void put_integer(py::handle value, const std::string& shown, TomlNode& node) {
    int overflow = 0;
    node.kind = TomlKind::integer;
    node.integer = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
    node.number = static_cast<double>(node.integer);
    if (overflow != 0) throw SceneError(shown + " = " + py::str(value).cast<std::string>() + " has more than 64 bits");
}

/// NumPy's numbers and arrays become Python's by `tolist`.
bool is_of_numpy(py::handle value) { return py::isinstance<py::array>(value) || py::hasattr(value, "tolist"); }

void put_value(py::handle value, const std::string& name, const std::string& shown, TomlNode& node) {
    if (py::isinstance<py::dict>(value)) return put_table(py::reinterpret_borrow<py::dict>(value), name, shown, node);
    if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))
        return put_list(py::reinterpret_borrow<py::sequence>(value), name, shown, node);
    if (py::isinstance<py::int_>(value)) return put_integer(value, shown, node);
    if (py::isinstance<py::float_>(value)) {
        node.kind = TomlKind::number;
        node.number = value.cast<double>();
        return;
    }
    // Paths of pathlib are texts here.
    const bool is_path = py::hasattr(value, "__fspath__");
    if (!py::isinstance<py::str>(value) && !is_path)
        throw SceneError(shown, "must be a dict, list, str, bool, int or float, not " + described(value));
    node.kind = TomlKind::text;
    node.text = (is_path ? py::str(value.attr("__fspath__")()) : py::reinterpret_borrow<py::str>(value)).cast<std::string>();
}

/// Guards against an object that holds itself, which would be followed without end.
struct RecursionGuard {
    RecursionGuard() {
        if (Py_EnterRecursiveCall(" in a value that holds itself") != 0) throw py::error_already_set();
    }
    ~RecursionGuard() { Py_LeaveRecursiveCall(); }
    RecursionGuard(const RecursionGuard&) = delete;
    RecursionGuard& operator=(const RecursionGuard&) = delete;
};

TomlNode converted_value(py::handle value, const std::string& name, const std::string& shown) {
    const RecursionGuard guard;
    TomlNode node;
    node.place = node.key_place = {.file = name};
    if (py::isinstance<py::bool_>(value)) {  // before int, of which it is one
        node.kind = TomlKind::boolean;
        node.text = value.cast<bool>() ? "true" : "false";
    } else if (is_of_numpy(value)) {
        return converted_value(value.attr("tolist")(), name, shown);
    } else {
        put_value(value, name, shown, node);
    }
    return node;
}

}  // namespace

TomlNode node_of(py::handle value, const std::string& name) { return converted_value(value, name, ""); }

double number_from(py::handle value, const std::string& what) {
    const TomlNode node = converted_value(value, "", what);
    if (!node.is_number()) throw SceneError(what, "must be a number, not " + scenes::described(node));
    return node.number;
}

bool flag_from(py::handle value, const std::string& what) {
    const TomlNode node = converted_value(value, "", what);
    if (node.kind != TomlKind::boolean) throw SceneError(what, "must be True or False, not " + scenes::described(node));
    return node.text == "true";
}

std::string text_from(py::handle value, const std::string& what) {
    const TomlNode node = converted_value(value, "", what);
    if (node.kind != TomlKind::text) throw SceneError(what, "must be a str, not " + scenes::described(node));
    return node.text;
}

py::object python_of(const TomlNode& node) {
    switch (node.kind) {
        case TomlKind::integer:
            return py::int_(node.integer);
        case TomlKind::number:
            return py::float_(node.number);
        case TomlKind::boolean:
            return py::bool_(node.text == "true");
        case TomlKind::text:
        case TomlKind::date:
            return py::str(node.text);
        case TomlKind::list:
            break;
        case TomlKind::table: {
            py::dict dict;
            for (const TomlNode& entry : node.entries) dict[py::str(entry.key)] = python_of(entry);
            return dict;
        }
    }
    py::list list;
    for (const TomlNode& item : node.items) list.append(python_of(item));
    return list;
}

std::vector<scenes::Override> overrides_of(py::handle value) {
    std::vector<scenes::Override> overrides;
    if (value.is_none()) return overrides;
    if (!py::isinstance<py::dict>(value))
        throw SceneError("overrides",
                         "must be a dict of dotted keys such as {\"step.time_step\": 0.01}, not " + described(value));
    for (const TomlNode& entry : node_of(value).entries)
        overrides.push_back({.key = entry.key, .value = toml_text(entry), .option = "overrides[\"" + entry.key + "\"]"});
    return overrides;
}

}  // namespace percale::python
