// All that a run reports, kept in memory bit by bit; the checkpoints that it saves; and runs that go on from them.
#pragma once

#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/notes.hpp"
#include "support/recorded.hpp"

namespace grit::test {

struct Tape final : Recorder {
  struct Entry {
    std::string what;
    std::uint64_t step = 0;
    double time = 0;
    std::vector<double> values;
    /// Also where a value is not a number.
    bool operator==(const Entry& other) const {
      return what == other.what && step == other.step && time == other.time && values.size() == other.values.size() &&
             (values.empty() || std::memcmp(values.data(), other.values.data(), values.size() * sizeof(double)) == 0);
    }
  };
  std::vector<Entry> entries;
  std::vector<Checkpoint> checkpoints;
  std::function<void(const World&)> look = [](const World&) {};  ///< at every sample
  std::function<bool()> refuses = [] { return false; };  ///< whether a frame, or the end of a stage, finds no room
  RunSummary summary;

  void expect_room() const override {
    if (refuses()) throw RefusedRecord("no room");
  }
  void begin(const World&, std::span<const ProbeGroup> probes) override {
    groups_.assign(probes.begin(), probes.end());
  }
  void sample(std::size_t probe, const World& world, std::span<const std::span<const double>> values) override {
    Entry& entry = note(groups_.at(probe).name, world);
    for (const auto& channel : values) entry.values.insert(entry.values.end(), channel.begin(), channel.end());
    look(world);
  }
  void frame(const World& world, std::span<const FieldGroup> fields) override {
    Entry& entry = note("frame", world);
    const auto add = [&](auto begin, auto end) { entry.values.insert(entry.values.end(), begin, end); };
    for (const auto rows : {world.positions(), world.velocities(), world.spins(), world.forces(), world.moments()})
      for (const Row& row : rows) entry.values.insert(entry.values.end(), {row.x, row.y, row.z, row.w});
    for (const std::uint32_t id : world.ids()) entry.values.push_back(id);
    for (const Contact& contact : world.contacts()) {
      entry.values.insert(entry.values.end(), {double(contact.a), double(contact.b), double(contact.feature)});
      for (const Vec3* v : {&contact.force, &contact.moment, &contact.branch}) add(v->begin(), v->end());
    }
    for (const FieldGroup& group : fields)
      for (const Field& field : group.fields) add(field.values.begin(), field.values.end());
  }
  void stage_ended(const World& world, const std::string& what) override { note("end of " + what, world); }
  void serialize(Archive& archive) override {
    std::uint64_t count = entries.size();
    archive(count);
    entries.resize(count);
  }
  void finish(const World&, const RunSummary& how) override { summary = how; }

 private:
  Entry& note(const std::string& what, const World& world) {
    return entries.emplace_back(Entry{what, world.step(), world.time(), {}});
  }
  std::vector<ProbeGroup> groups_;
};

/// A run on tape. `tape` is what was recorded before the checkpoint, and maybe after.
struct Taped {
  Tape tape;
  Simulation simulation;
  const Kernel* kernel;

  /// `stop` is asked at every sample and, every eighth step, between two steps; `refuse` where a frame is due or a
  /// stage ends.
  Taped(const Description& plain, unsigned threads, std::function<bool(const Kernel&)> stop = {},
        const Checkpoint* resume = nullptr, std::vector<Tape::Entry> before = {}, double checkpoint_every = 0,
        std::function<bool(const Kernel&)> refuse = {})
      : simulation(recorded(scene_of(plain), tape, threads)), kernel(&kernel_of(simulation)) {
    tape.entries = std::move(before);
    bool stops = false;
    const auto look = [&](const World&) {
      if (stop && stop(*kernel)) stops = true;
    };
    tape.look = look;
    simulation.interrupt_when([&] { return stops; });
    simulation.on_progress([&](const Progress&) { look(kernel->world()); }, 0);
    simulation.on_checkpoint([&](const Checkpoint& one) { tape.checkpoints.push_back(one); }, checkpoint_every);
    if (resume != nullptr) simulation.resume(*resume);
    if (refuse) tape.refuses = [&] { return refuse(*kernel); };
    try {
      run_recorded(simulation);
    } catch (const RefusedRecord&) {
      tape.summary.status = "refused";
    }
    tape.look = {}, tape.refuses = {};
  }
  Taped(const Taped&) = delete;
};

}  // namespace grit::test
