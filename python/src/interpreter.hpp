// The lock of the interpreter (GIL), and its end, which threads may meet while they compute.
//
// At its end, Python stops every other thread that takes the lock by pthread_exit(). That unwinds its stack through C++
// and would abort the process. The end therefore waits for what is computed, runs of other threads end by SystemExit
// between two steps, and a thread that Python stops nevertheless waits here for the end of the process.
#pragma once

#include <pybind11/pybind11.h>

namespace grit::python {

namespace py = pybind11;

/// To be called once, when the module is loaded.
void wait_at_the_end();

/// Whether the interpreter ends, and not by this thread.
bool is_ending();

/// Throws SystemExit then, which ends a thread without a message. Needs the GIL.
void leave_at_the_end();

/// Gives up the GIL while it lives. Throws as leave_at_the_end().
class Unlocked {
 public:
  Unlocked();
  Unlocked(const Unlocked&) = delete;
  ~Unlocked();

 private:
  PyThreadState* thread_;
};

/// Has the GIL while it lives.
class Locked {
 public:
  Locked();
  Locked(const Locked&) = delete;
  ~Locked();

 private:
  bool computed_;
  PyGILState_STATE before_;
};

/// Calls a function in Python, which may take long. Throws as leave_at_the_end() after it.
py::object call(const py::object& function, const py::tuple& arguments);

}  // namespace grit::python
