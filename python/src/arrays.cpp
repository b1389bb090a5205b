#include "arrays.hpp"

#include <utility>

namespace grit::python {

void Arrays::let_go() {
  for (std::size_t which = 0; which < leases_.size(); ++which)
    if (const auto lease = std::exchange(leases_[which], {}).lock())
      lease->memory = simulation_.keep(static_cast<WorldArray>(which));
}

py::array Arrays::view(WorldArray array, const void* first, std::size_t rows, std::size_t stride, const py::dtype& type,
                       const Inner& inner) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows)}, strides{static_cast<py::ssize_t>(stride)};
  shape.insert(shape.end(), inner.shape.begin(), inner.shape.end());
  strides.insert(strides.end(), inner.strides.begin(), inner.strides.end());
  if (rows == 0) return py::array(type, std::move(shape), std::move(strides));
  std::weak_ptr<Lease>& known = leases_[static_cast<std::size_t>(array)];
  std::shared_ptr<Lease> lease = known.lock();
  if (!lease) known = lease = std::make_shared<Lease>();
  using Holder = std::shared_ptr<Lease>;
  const py::capsule owner(new Holder(std::move(lease)), [](void* holder) { delete static_cast<Holder*>(holder); });
  py::array result(type, std::move(shape), std::move(strides), first, owner);
  // numpy does not allow to undo this, as the owner is no array.
  py::detail::array_proxy(result.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return result;
}

}  // namespace grit::python
