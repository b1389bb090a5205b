#include "interpreter.hpp"

#include <cxxabi.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace grit::python {
namespace {

std::atomic<int> computing{0};  // threads without the GIL that will take it again
std::atomic<bool> ending{false};
std::thread::id ends;  // the thread by which the interpreter ends; set before `ending`

/// Does what may take the GIL. There must be nothing between this and Python that has a destructor.
template <class Work>
auto stopped_here(const Work& work) {
  try {
    return work();
  } catch (const abi::__forced_unwind&) {
    for (;;) ::pause();
  }
}

void wait_for_threads() {
  ends = std::this_thread::get_id();
  ending = true;
  while (computing > 0) {
    {
      const py::gil_scoped_release released;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

}  // namespace

void wait_at_the_end() {
  py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_threads));
  // The other threads are not in the child.
  py::module_::import("os").attr("register_at_fork")(py::arg("after_in_child") =
                                                         py::cpp_function([] { computing = 0; }));
}

bool is_ending() { return ending && ends != std::this_thread::get_id(); }

void leave_at_the_end() {
  if (!is_ending()) return;
  PyErr_SetNone(PyExc_SystemExit);
  throw py::error_already_set();
}

Unlocked::Unlocked() {
  leave_at_the_end();
  ++computing;
  thread_ = PyEval_SaveThread();
}

Unlocked::~Unlocked() {
  --computing;
  stopped_here([&] { PyEval_RestoreThread(thread_); });
}

Locked::Locked() : computed_(PyGILState_Check() == 0) {
  if (computed_) --computing;
  before_ = stopped_here([] { return PyGILState_Ensure(); });
}

Locked::~Locked() {
  if (computed_) ++computing;
  PyGILState_Release(before_);
}

py::object call(const py::object& function, const py::tuple& arguments) {
  const auto result = py::reinterpret_steal<py::object>(
      stopped_here([&] { return PyObject_CallObject(function.ptr(), arguments.ptr()); }));
  if (!result) throw py::error_already_set();
  leave_at_the_end();
  return result;
}

}  // namespace grit::python
