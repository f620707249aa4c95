#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "percale/mesh.h"

// NumPy arrays as plain vectors and back. What comes in is never rounded or cut: an array of another kind or shape throws
// SceneError naming `what`.
namespace percale::python {

namespace py = pybind11;

/// The type of a Python object as messages name it: "str", "numpy.ndarray of shape (3, 2)".
std::string described(py::handle value);

/// (n, 3) numbers; with `rows` so many. Whole numbers are taken, too.
std::vector<Vec3> points_of(py::handle value, const std::string& what, std::optional<std::size_t> rows = {});
/// Three numbers.
Vec3 vector_of(py::handle value, const std::string& what);
/// Four numbers w, x, y, z.
Rotation rotation_of(py::handle value, const std::string& what);
/// An integer or a list of them; 32 bits.
std::vector<int> indices_of(py::handle value, const std::string& what);
/// (n, `columns`) integers of 32 bits, row by row.
std::vector<int> rows_of_indices(py::handle value, const std::string& what, long columns);
/// (n, `columns`) numbers, row by row.
std::vector<double> rows_of_numbers(py::handle value, const std::string& what, long columns);
/// (n, 3, 3) numbers.
std::vector<std::array<Vec3, 3>> corners_of(py::handle value, const std::string& what);
/// How many dimensions an array or a nested list has; throws SceneError where it is none.
long dimensions_of(py::handle value, const std::string& what);

/// Copies, (n, 3).
py::array_t<double> array_of(std::span<const Vec3> points);
py::array_t<double> array_of(const Vec3& vector);
py::array_t<int> array_of(std::span<const int> values);

/// A read-only array over memory that `owner` keeps; (n, `columns`), or (n) for one column.
template <class Number>
py::array shown(std::shared_ptr<const void> owner, const Number* data, std::size_t rows, std::size_t columns) {
    const py::capsule base(new std::shared_ptr<const void>(std::move(owner)),
                           [](void* kept) { delete static_cast<std::shared_ptr<const void>*>(kept); });
    std::vector<std::size_t> shape{rows};
    if (columns > 1) shape.push_back(columns);
    py::array array(py::dtype::of<Number>(), shape, data, base);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

}  // namespace percale::python
