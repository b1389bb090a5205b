// The compiled part of the Python module grit. python/grit/simulation.py is what users see.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "checkpoints.hpp"
#include "driver.hpp"
#include "errors.hpp"
#include "grit/error.hpp"
#include "input/units.hpp"
#include "interpreter.hpp"
#include "output/series.hpp"
#include "pictures.hpp"
#include "plugins/build_facts.hpp"
#include "simulation/parts.hpp"
#include "world.hpp"

namespace grit::python {
namespace {

StateRequest state_of(const std::vector<std::string>& names) {
  StateRequest all;
  for (const std::string& name : names)
    all = all | (name == "rotation"       ? BodyState::rotation
                 : name == "displacement" ? BodyState::displacement
                                          : BodyState::energy);
  return all;
}

using ChannelFacts = std::tuple<std::string, std::string, std::string>;  // name, unit, description

std::vector<ChannelFacts> columns_of(const ProbeGroup& probe) {
  std::vector<ChannelFacts> all{{time_column.name, time_column.unit, time_column.doc},
                                {step_column.name, step_column.unit, step_column.doc}};
  for (const Channel& one : probe.channels) all.emplace_back(one.name, one.unit, one.doc);
  return all;
}

/// `json`: whether `source` is a description, instead of the path of one. `resumes`: whether resume() follows.
std::unique_ptr<Driver> open(const std::string& source, bool json, unsigned threads, std::vector<std::string> sets,
                             std::vector<std::string> plugin_path, const std::vector<std::string>& state,
                             bool resumes) {
  const SimulationOptions options{
      .threads = threads, .sets = std::move(sets), .plugin_path = std::move(plugin_path), .state = state_of(state)};
  auto samples = std::make_unique<Samples>();
  auto parts = json ? open_parts(Description::parse(source), options, resumes, samples.get())
                    : open_parts(std::filesystem::path(source), options, resumes, samples.get());
  return std::make_unique<Driver>(Simulation(std::move(parts)), std::move(samples));
}

py::bytes bytes_of(const Checkpoint& checkpoint) {
  return {reinterpret_cast<const char*>(checkpoint.state.data()), checkpoint.state.size()};
}

py::tuple pickled(const SavedState& saved) {
  const Checkpoint& checkpoint = saved.checkpoint;
  return py::make_tuple(checkpoint.stage, checkpoint.time, checkpoint.step, bytes_of(checkpoint), saved.facts->dump());
}

SavedState unpickled(const py::tuple& all) {
  if (all.size() != 5) throw Error("this checkpoint was pickled by another grit; run from the start");
  const auto state = all[3].cast<std::string_view>();
  const auto* const first = reinterpret_cast<const std::byte*>(state.data());
  return {{all[0].cast<std::string>(), all[1].cast<double>(), all[2].cast<std::uint64_t>(),
           std::vector<std::byte>(first, first + state.size())},
          std::make_shared<const Description>(Description::parse(all[4].cast<std::string>()))};
}

py::str text_of(const SavedState& saved) {
  const Checkpoint& checkpoint = saved.checkpoint;
  return py::str("<checkpoint: {:.6g} s, step {}, stage '{}', {:.3g} MB>")
      .format(checkpoint.time, checkpoint.step, checkpoint.stage, 1e-6 * static_cast<double>(checkpoint.state.size()));
}

}  // namespace
}  // namespace grit::python

PYBIND11_MODULE(_grit, module) {
  using namespace grit;
  using namespace grit::python;
  translate_errors(py::module_::import("grit.errors"));
  wait_at_the_end();
  module.attr("version") = build_facts().version;
  module.attr("instruction_set") = build_facts().arch;

  py::class_<SavedState>(module, "Checkpoint", "The complete state of a simulation. It can be pickled.")
      .def_property_readonly(
          "stage", [](const SavedState& saved) { return saved.checkpoint.stage; }, "name of the stage that was running")
      .def_property_readonly(
          "time", [](const SavedState& saved) { return saved.checkpoint.time; }, "simulated [s]")
      .def_property_readonly(
          "step", [](const SavedState& saved) { return saved.checkpoint.step; }, "since the start of the run")
      .def("__len__", [](const SavedState& saved) { return saved.checkpoint.state.size(); })
      .def("__repr__", &text_of)
      .def(py::pickle(&pickled, &unpickled));

  py::class_<Forecast>(module, "Forecast", "Size and time step of a run, from its initial state.")
      .def_readonly("bodies", &Forecast::bodies)
      .def_readonly("contacts", &Forecast::contacts, "between bodies")
      .def_readonly("time_step", &Forecast::time_step, "s")
      .def_readonly("critical_time_step", &Forecast::critical_time_step, "s")
      .def_readonly("bytes", &Forecast::bytes, "memory of bodies and contacts")
      .def("__repr__", [](const Forecast& f) {
        return py::str("<forecast: {} bodies, {} contacts, time step {:.3g} s (critical {:.3g} s), {:.3g} MB>")
            .format(f.bodies, f.contacts, f.time_step, f.critical_time_step, 1e-6 * static_cast<double>(f.bytes));
      });

  py::class_<Driver> simulation(module, "Simulation");
  simulation
      .def(py::init(&open), py::arg("source"), py::arg("json"), py::arg("threads"), py::arg("sets"),
           py::arg("plugin_path"), py::arg("state"), py::arg("resumes"), py::call_guard<Unlocked>())
      .def("run",
           [](Driver& driver, std::optional<std::uint64_t> steps, std::optional<double> until, bool stage,
              bool progress) {
             Goal goal{.stage = stage};
             if (steps) goal.steps = *steps;
             if (until) goal.time = *until;
             driver.run(goal, progress);
           })
      .def("own", &Driver::own)
      .def("check", &Driver::check)
      .def("set", &Driver::set)
      .def("save", &Driver::save)
      .def("resume", &Driver::resume)
      .def("write", [](Driver& driver, const std::filesystem::path& path) { write_saved(path, driver.save()); })
      .def("every_time", &Driver::every_time)
      .def("every_steps", &Driver::every_steps)
      .def("at_stage_end", &Driver::at_stage_end)
      .def("set_engine",
           [](Driver& driver, const std::string& name, double stiffness, double damping) {
             driver.set_engine(name, {stiffness, damping});
           })
      .def("remove_engine", &Driver::remove_engine)
      .def("probes",
           [](Driver& driver) {
             std::map<std::string, std::vector<ChannelFacts>> all;
             for (const ProbeGroup& probe : driver.probes()) all[probe.name] = columns_of(probe);
             return all;
           })
      .def("samples", &Driver::samples);
  simulation.def("picture", [](Driver& driver, const std::string& view, const std::string& color) {
    const World& world = driver.world();
    return picture_of(driver.simulation().parts().opened->scene.description->title, world, view, color);
  });
  bind_world(simulation);
  module.def("read_checkpoint", &read_saved);
  module.def("is_unit", &is_unit);
  module.def("picture_of_run", [](const std::filesystem::path& folder) { return picture_of(folder); });
}
