// numpy arrays over the memory of a simulation.
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "grit/simulation.hpp"

namespace grit::python {

namespace py = pybind11;

/// Shape and byte strides of one value within its array: none for a number.
struct Inner {
  std::vector<py::ssize_t> shape = {}, strides = {};
};
inline constexpr py::ssize_t number_size = sizeof(double);

template <class Value>
inline const Inner inner_of = {};
template <>
inline const Inner inner_of<Vec3> = {{3}, {number_size}};
template <>
inline const Inner inner_of<Mat3> = {{3, 3}, {number_size, 3 * number_size}};  // column by column
/// x, y, z of a Row.
template <>
inline const Inner inner_of<Row> = {{3}, {number_size}};

template <class Value>
py::dtype number_type() {
  if constexpr (std::is_arithmetic_v<Value>) return py::dtype::of<Value>();
  else return py::dtype::of<double>();
}

/// Read-only arrays of the present instant, without a copy. They keep what they show: let_go() gives the memory of
/// those that are still used to them, and the simulation continues in a copy.
class Arrays {
 public:
  explicit Arrays(Simulation& simulation) : simulation_(simulation) {}
  Arrays(const Arrays&) = delete;
  ~Arrays() { let_go(); }

  /// All rows of an array of World.
  template <class Value>
  py::array whole(WorldArray array, std::span<const Value> rows) {
    return view(array, rows.data(), rows.size(), sizeof(Value), number_type<Value>(), inner_of<Value>);
  }
  /// One member of all rows.
  template <class Struct, class Value>
  py::array member(WorldArray array, std::span<const Struct> rows, Value Struct::*one) {
    const void* const first = rows.empty() ? nullptr : &(rows.front().*one);
    return view(array, first, rows.size(), sizeof(Struct), number_type<Value>(), inner_of<Value>);
  }
  /// Before the simulation changes anything. Needs the GIL.
  void let_go();

 private:
  /// Shared by the arrays of one instant: the memory, once it is theirs.
  struct Lease {
    std::shared_ptr<const void> memory;
  };
  py::array view(WorldArray array, const void* first, std::size_t rows, std::size_t stride, const py::dtype& type,
                 const Inner& inner);

  Simulation& simulation_;
  std::array<std::weak_ptr<Lease>, world_arrays> leases_;
};

}  // namespace grit::python
