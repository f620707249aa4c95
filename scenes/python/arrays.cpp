#include "python/arrays.h"

#include <cstring>
#include <limits>
#include <string_view>

#include "percale/error.h"

namespace percale::python {
namespace {

std::string shape_text(const py::array& array) { return py::str(array.attr("shape")).cast<std::string>(); }

/// An array of numbers: of kind i, u or, unless they are `whole`, f. Empty ones are of any kind.
py::array numbers_of(py::handle value, const std::string& what, bool whole) {
    const py::array array = py::array::ensure(value);
    if (!array) throw SceneError(what, "must be an array of numbers, not " + described(value));
    const std::string_view allowed = whole ? "iu" : "iuf";
    const bool known = allowed.find(array.dtype().kind()) != std::string_view::npos && array.itemsize() <= 8;
    if (known || array.size() == 0) return array;
    throw SceneError(what, std::string("must be an array of ") + (whole ? "integers" : "numbers") + ", not of dtype " +
                               py::str(array.dtype()).cast<std::string>());
}

void check_shape(const py::array& array, const std::string& what, const std::vector<long>& wanted) {
    bool fits = array.ndim() == static_cast<long>(wanted.size());
    std::string text;
    for (std::size_t axis = 0; axis < wanted.size(); ++axis) {
        if (fits && wanted[axis] >= 0) fits = array.shape(static_cast<long>(axis)) == wanted[axis];
        text += (axis == 0 ? "(" : ", ") + (wanted[axis] < 0 ? "n" : std::to_string(wanted[axis]));
    }
    if (wanted.size() == 1) text += ",";
    if (!fits) throw SceneError(what, "has shape " + shape_text(array) + ", it must be " + text + ")");
}

std::vector<double> doubles_of(const py::array& array) {
    const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
    return {numbers.data(), numbers.data() + numbers.size()};
}

template <class Wide>
std::vector<int> narrowed(const py::array& array, const std::string& what) {
    const auto wide = py::array_t<Wide, py::array::c_style | py::array::forcecast>::ensure(array);
    std::vector<int> values;
    for (long i = 0; i < wide.size(); ++i) {
        const Wide value = wide.data()[i];
        if (!std::in_range<int>(value)) throw SceneError(what, std::to_string(value) + " is no index: it has more than 32 bits");
        values.push_back(static_cast<int>(value));
    }
    return values;
}

std::vector<int> integers_of(const py::array& array, const std::string& what) {
    return array.dtype().kind() == 'u' ? narrowed<std::uint64_t>(array, what) : narrowed<std::int64_t>(array, what);
}

std::vector<Vec3> gathered(const std::vector<double>& numbers) {
    std::vector<Vec3> points(numbers.size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    return points;
}

}  // namespace

std::string described(py::handle value) {
    if (py::isinstance<py::array>(value)) return "an array of shape " + shape_text(py::reinterpret_borrow<py::array>(value));
    return py::str(py::type::handle_of(value).attr("__name__")).cast<std::string>();
}

std::vector<Vec3> points_of(py::handle value, const std::string& what, std::optional<std::size_t> rows) {
    const py::array array = numbers_of(value, what, false);
    check_shape(array, what, {rows ? static_cast<long>(*rows) : -1, 3});
    return gathered(doubles_of(array));
}

Vec3 vector_of(py::handle value, const std::string& what) {
    const py::array array = numbers_of(value, what, false);
    check_shape(array, what, {3});
    return gathered(doubles_of(array)).front();
}

Rotation rotation_of(py::handle value, const std::string& what) {
    const py::array array = numbers_of(value, what, false);
    check_shape(array, what, {4});
    const std::vector<double> q = doubles_of(array);
    return {q[0], q[1], q[2], q[3]};
}

std::vector<int> indices_of(py::handle value, const std::string& what) {
    const py::array array = numbers_of(value, what, true);
    if (array.ndim() > 0) check_shape(array, what, {-1});
    return integers_of(array, what);
}

std::vector<int> rows_of_indices(py::handle value, const std::string& what, long columns) {
    const py::array array = numbers_of(value, what, true);
    check_shape(array, what, {-1, columns});
    return integers_of(array, what);
}

std::vector<double> rows_of_numbers(py::handle value, const std::string& what, long columns) {
    const py::array array = numbers_of(value, what, false);
    check_shape(array, what, {-1, columns});
    return doubles_of(array);
}

std::vector<std::array<Vec3, 3>> corners_of(py::handle value, const std::string& what) {
    const py::array array = numbers_of(value, what, false);
    check_shape(array, what, {-1, 3, 3});
    const std::vector<Vec3> points = gathered(doubles_of(array));
    std::vector<std::array<Vec3, 3>> corners(points.size() / 3);
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
    return corners;
}

long dimensions_of(py::handle value, const std::string& what) { return numbers_of(value, what, false).ndim(); }

py::array_t<double> array_of(std::span<const Vec3> points) {
    py::array_t<double> array(std::vector<std::size_t>{points.size(), 3});
    if (!points.empty()) std::memcpy(array.mutable_data(), points.data(), points.size_bytes());
    return array;
}

py::array_t<double> array_of(const Vec3& vector) {
    py::array_t<double> array(3);
    std::memcpy(array.mutable_data(), vector.data(), sizeof vector);
    return array;
}

py::array_t<int> array_of(std::span<const int> values) {
    py::array_t<int> array(static_cast<long>(values.size()));
    if (!values.empty()) std::memcpy(array.mutable_data(), values.data(), values.size_bytes());
    return array;
}

}  // namespace percale::python
