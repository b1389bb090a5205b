#include "driver.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "format/number.hpp"
#include "grit/error.hpp"
#include "interpreter.hpp"
#include "simulation/parts.hpp"

namespace grit::python {
namespace {

// Taking the GIL in each step would make small simulations wait for other threads.
constexpr auto signals_every = std::chrono::milliseconds(50);
constexpr auto progress_after = std::chrono::milliseconds(500);
constexpr double progress_every = 0.2;  // s

}  // namespace

/// While it lives the simulation belongs to this thread, and arrays that were taken before do not change.
class Driver::Running {
 public:
  explicit Running(Driver& driver) : driver_(driver) {
    driver_.arrays_.let_go();
    driver_.runs_ = true, driver_.thread_ = std::this_thread::get_id();
    driver_.has_forces_ = false;
  }
  Running(const Running&) = delete;
  ~Running() { driver_.runs_ = false; }
  /// Runs `work` without the GIL.
  template <class Work>
  auto free(const Work& work) {
    const auto freed = [&] {
      const Unlocked unlocked;
      return work();
    };
    try {
      if constexpr (std::is_void_v<decltype(work())>) {
        freed();
        driver_.throw_raised();
      } else {
        auto result = freed();
        driver_.throw_raised();
        return result;
      }
    } catch (...) {
      driver_.throw_raised();
      throw;
    }
  }

 private:
  Driver& driver_;
};

/// An engine whose forces a function in Python returns.
class Driver::PythonEngine final : public Engine {
 public:
  PythonEngine(Driver& driver, std::string name, const EngineRates& rates)
      : driver_(driver), name_(std::move(name)), rates_(rates) {}
  void declare(Parameters&) override {}
  Phase phase() const override { return Phase::forces; }
  void forces(const World&, std::span<Row> force, std::span<Row> moment) const override {
    driver_.act(name_, force, moment);
  }
  EngineRates rates(const World&) const override { return rates_; }

 private:
  Driver& driver_;
  std::string name_;
  EngineRates rates_;
};

Driver::Driver(Simulation simulation, std::unique_ptr<Samples> samples)
    : samples_(std::move(samples)), simulation_(std::move(simulation)) {
  simulation_.interrupt_when([this] { return stops(); });
  simulation_.on_progress([this](const Progress& progress) { report(progress); }, progress_every);
}

void Driver::refuse_other_threads() const {
  if (runs_ && thread_ != std::this_thread::get_id())
    throw Error(
        "this simulation is running in another thread; wait until run() has returned there, read it in a callback "
        "(@sim.every), or use one simulation per thread");
}

void Driver::refuse_while_running(const char* what) const {
  refuse_other_threads();
  if (runs_ || acts_)
    throw Error(std::string(what) + " cannot be called in a callback of the same simulation; call it after run()");
}

void Driver::refuse_in_engine(const char* what) const {
  refuse_other_threads();
  if (acts_)
    throw Error(std::string(what) +
                " cannot be called in an engine, which acts in the middle of a step; call it in a callback "
                "(@sim.every) or after run()");
}

/// A goal that cannot be reached, so that a loop up to a condition would never end.
void Driver::refuse_done(const Goal& goal) const {
  if (!simulation_.done()) return;
  const World& world = simulation_.world();
  const Goal whole;
  const bool steps = goal.steps != whole.steps && goal.steps > 0,
             later = goal.time != whole.time && goal.time > world.time() + 0.5 * world.dt();
  if (!goal.stage && !steps && !later) return;
  throw Error("the simulation is done: its last stage, \"" + world.stage() + "\", ended at " + number(world.time()) +
              " s, so that it takes no more steps; let loops end where `sim.done` is True, or give this stage a later "
              "end");
}

bool Driver::stops() {
  if (!runs_) return false;
  if (raised_) {
    const Locked locked;
    throw_raised();
  }
  const World& world = simulation_.world();
  // As callbacks by time, at the nearest step.
  if (world.step() >= last_step_ || world.time() >= last_time_ - 0.5 * world.dt()) return true;
  if (const auto now = Clock::now(); now - asked_ >= signals_every || is_ending()) {
    asked_ = now;
    const Locked locked;
    leave_at_the_end();
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return false;
}

py::object Driver::owner() const {
  py::object alive = owner_ ? owner_() : py::none();
  if (alive.is_none())
    throw Error("the simulation that these arrays belong to has been deleted; keep a reference to it");
  return alive;
}

void Driver::throw_raised() {
  if (!raised_) return;
  const py::error_already_set error = *std::exchange(raised_, std::nullopt);
  throw error;
}

void Driver::observe(std::size_t number) {
  if (!runs_) return;
  const Locked locked;
  has_forces_ = true;
  call(owner().attr("_observed"), py::make_tuple(number));
  has_forces_ = false;
  arrays_.let_go();
}

void Driver::act(const std::string& engine, std::span<Row> force, std::span<Row> moment) {
  const Locked locked;
  const auto add = [](const py::handle& values, std::span<Row> rows) {
    if (values.is_none()) return;
    const auto given = py::cast<py::array_t<double, py::array::c_style>>(values);
    const auto row = given.unchecked<2>();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto at = static_cast<py::ssize_t>(i);
      rows[i] += Row{row(at, 0), row(at, 1), row(at, 2), 0};
    }
  };
  const py::object simulation = owner();
  for (bool again = false;; again = true) {
    try {
      acts_ = true;
      const auto added = call(simulation.attr("_acted"), py::make_tuple(engine, force.size())).cast<py::tuple>();
      acts_ = false;
      arrays_.let_go();
      add(added[0], force), add(added[1], moment);
      return;
    } catch (const py::error_already_set& error) {
      acts_ = false;
      arrays_.let_go();
      raised_ = error;
    }
    if (again || !raised_->matches(PyExc_KeyboardInterrupt))
      throw Error("the engine \"" + engine + "\" raised an exception in the middle of a step");
  }
}

void Driver::report(const Progress& now) {
  if (!shows_progress_ || Clock::now() - began_ < progress_after) return;
  const Locked locked;
  call(owner().attr("_progressed"), py::make_tuple(now.stage, now.stage_number, now.stages, now.fraction,
                                                   now.seconds_left, now.time, now.particle_steps_per_second));
}

void Driver::run(const Goal& goal, bool shows_progress) {
  refuse_while_running("run()");
  simulation_.parts().refuse_failed();
  refuse_done(goal);
  // The balance begins when it is first read.
  if (!has_begun_ && simulation_.parts().kernel.state().bodies.energies())
    static_cast<void>(world_with_forces().energies());
  Running running(*this);
  const World& world = simulation_.world();
  const std::uint64_t furthest = std::numeric_limits<std::uint64_t>::max();
  last_step_ = goal.steps > furthest - world.step() ? furthest : world.step() + goal.steps;
  last_time_ = goal.time;
  shows_progress_ = shows_progress;
  began_ = asked_ = Clock::now();
  has_begun_ = true;
  try {
    running.free([&] { return goal.stage ? simulation_.run_stage() : simulation_.run(); });
    has_forces_ = true;
  } catch (const NumericsError&) {
    has_forces_ = failed();  // those of the failure
    throw;
  }
}

Forecast Driver::check() {
  refuse_while_running("check()");
  simulation_.parts().refuse_failed();
  Running running(*this);
  const Forecast forecast = running.free([&] { return simulation_.check(); });
  has_forces_ = !has_begun_;
  return forecast;
}

void Driver::set(const std::string& pointer, const std::string& value) {
  refuse_in_engine("set()");
  simulation_.parts().refuse_failed();
  arrays_.let_go();
  has_begun_ = true, has_forces_ = false;
  try {
    simulation_.set(pointer, Description::parse(value));
  } catch (...) {
    throw_raised();
    throw;
  }
}

std::shared_ptr<const Description> Driver::facts() {
  if (facts_ == nullptr) facts_ = std::make_shared<const Description>(facts_of(simulation_));
  return facts_;
}

SavedState Driver::save() {
  refuse_while_running("save()");
  simulation_.parts().refuse_failed();
  Running running(*this);
  has_begun_ = true;
  return running.free([&] { return SavedState{simulation_.save(), facts()}; });
}

void Driver::resume(const SavedState& saved) {
  refuse_while_running("resume()");
  if (has_begun_)
    throw Error("a simulation that has begun cannot resume from a checkpoint; open the description again");
  Running running(*this);
  running.free([&] {
    check_fits(saved, *facts());
    has_begun_ = true;
    simulation_.resume(saved.checkpoint);
  });
}

std::size_t Driver::every_time(double seconds) {
  refuse_while_running("every()");
  simulation_.every_time(seconds, [this, number = observers_](const World&) { observe(number); });
  return observers_++;
}

std::size_t Driver::every_steps(std::uint64_t steps) {
  refuse_while_running("every()");
  simulation_.every_steps(steps, [this, number = observers_](const World&) { observe(number); });
  return observers_++;
}

std::size_t Driver::at_stage_end() {
  refuse_while_running("at_stage_end()");
  // The end of a stage is repeated if a callback ended the run there.
  simulation_.at_stage_end(
      [this, number = observers_, last = std::pair<std::uint64_t, std::string>()](const World& world) mutable {
        const std::pair now{world.step(), std::string(world.stage())};
        if (std::exchange(last, now) != now) observe(number);
      });
  return observers_++;
}

void Driver::set_engine(const std::string& name, const EngineRates& rates) {
  refuse_in_engine("engine()");
  arrays_.let_go();
  has_forces_ = false;
  simulation_.set_engine(name, std::make_shared<PythonEngine>(*this, name, rates));
}

void Driver::remove_engine(const std::string& name) {
  refuse_in_engine("remove()");
  arrays_.let_go();
  has_forces_ = false;
  simulation_.set_engine(name, nullptr);
}

const World& Driver::world() const {
  refuse_other_threads();
  return simulation_.world();
}

const World& Driver::world_with_forces() {
  refuse_other_threads();
  if (!has_forces_ && !runs_ && !acts_) {
    Running running(*this);
    running.free([&] {
      if (has_begun_) simulation_.step(0);
      else simulation_.check();
    });
    has_forces_ = true;
  }
  return simulation_.world();
}

std::vector<ProbeGroup> Driver::probes() { return simulation().parts().runner.probes(); }

py::array Driver::samples(const std::string& probe, const std::string& channel) {
  const std::vector<ProbeGroup> all = probes();
  return samples_->column(*std::ranges::find(all, probe, &ProbeGroup::name), channel);
}

bool Driver::done() const {
  refuse_other_threads();
  return simulation_.done();
}

bool Driver::failed() {
  refuse_other_threads();
  return simulation_.parts().failure != nullptr;
}

Simulation& Driver::simulation() {
  refuse_other_threads();
  return simulation_;
}

}  // namespace grit::python
