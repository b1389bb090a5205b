#include "simulation/prepared_sample.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "bodies/make_bodies.hpp"
#include "description/placed_error.hpp"
#include "grit/error.hpp"
#include "simulation/no_recorder.hpp"
#include "simulation/sample_checks.hpp"
#include "simulation/sample_groups.hpp"
#include "simulation/sample_of_frame.hpp"
#include "simulation/stage_runner.hpp"
#include "storage/state_file.hpp"

namespace grit {
namespace {

/// The file with the state of the sample.
std::filesystem::path file_of(const BeginDescription& begin) {
  const std::filesystem::path folder = begin.from;
  const bool at_end = begin.at == "end";
  auto file = folder / (at_end ? "final.h5" : "checkpoint.h5");
  std::error_code none;
  if (std::filesystem::is_regular_file(file, none)) return file;
  if (!std::filesystem::is_directory(folder))
    throw PlacedError({"begin", "from"}, folder.string() + ": is not a folder; name the folder of results of a run");
  const bool frames = std::filesystem::exists(folder / "frames");
  const bool other = std::filesystem::exists(folder / (at_end ? "checkpoint.h5" : "final.h5"));
  throw PlacedError(
      {"begin", "from"},
      folder.string() + ": holds no " + file.filename().string() +
          (other && at_end ? "; the run is not complete: continue it with 'grit run --resume', or begin at its "
                             "last checkpoint with \"at\": \"checkpoint\", or at a frame"
           : other         ? "; the run is complete: begin at its end with \"at\": \"end\""
           : frames        ? "; begin at a frame with \"at\": \"frame\""
                           : "; name the folder of results of a run"));
}

/// `fields`: of the contact history of the sample.
void check_springs(const ContactLaw& law, const std::string& law_name, const std::vector<StateField>& fields,
                   const std::string& sample, SampleFaults& faults) {
  const std::vector<StateField> kept = law.state();
  std::string lacking;
  for (const StateField& field : fields)
    if (std::ranges::find(kept, field.name, &StateField::name) == kept.end())
      lacking += (lacking.empty() ? "" : ", ") + field.name;
  if (lacking.empty()) return;
  faults.push_back({{"contacts"},
                    "contacts of " + sample + " store " + lacking + ", which the contact law \"" + law_name +
                        "\" does not store with these materials; use the law and parameters of the sample, or "
                        "start without springs: \"begin\": {\"springs\": \"drop\"}"});
}

void check_shapes(const Bodies& bodies, SampleGroups& groups) {
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    const std::uint32_t c = bodies.clumps.clump_of(i);
    if (c == no_clump) groups.takes_sphere(bodies.group_of(bodies.id[i]));
  }
  std::vector<SampleSphere> spheres;
  for (const Clump& clump : bodies.clumps.clump) {
    spheres.clear();
    const auto first = bodies.clumps.spheres.begin() + clump.first, last = bodies.clumps.spheres.begin() + clump.last;
    std::for_each(first, last, [&](std::uint32_t i) {
      spheres.push_back({bodies.clumps.of_body[i].place.norm(), bodies.position[i].w});
    });
    groups.takes_clump(bodies.group_of(bodies.id[*first]), clump.radius, spheres);
  }
}

}  // namespace

Prepared prepared_sample(const LiveScene& live, const Registry& registry, StateRequest state) {
  const SceneDescription& scene = live.now();
  const BeginDescription& begin = *scene.begin;
  if (begin.at == "frame") return sample_of_frame(live, registry, state);
  const std::filesystem::path path = file_of(begin);
  const StateFile file = read_state(path);
  const Scene before = read_scene(Document(file.facts.at("description"), path.string()), registry);
  LiveScene live_before(before);
  Bodies none;
  none.finish(requested_state(live_before.components()));
  Kernel kernel(live_before.now(), live_before.components(), std::move(none), 1);
  NoRecorder recorder;
  StageRunner(before, live_before, kernel, recorder).restore_kernel(file.checkpoint);
  const std::vector<StateField> fields = kernel.state().settings.fields;
  Prepared prepared = kernel.hand_over();

  SampleFaults faults;
  const std::string sample = name_of_sample(begin);
  std::set<std::string> groups;
  for (const BodyGroup& group : prepared.bodies.groups) groups.insert(group.name);
  check_groups(scene, groups, sample, faults);
  check_domain(scene.domain, live_before.now().domain, sample, faults);
  SampleGroups builders(live, sample);
  if (faults.empty()) {
    check_shapes(prepared.bodies, builders);
    faults = builders.faults();
  }
  if (begin.springs == "keep") {
    ContactLaw& law = *live.components().law;
    law.mix(materials_in_use(scene, material_names(scene)), materials_of_bodies(scene));
    check_springs(law, scene.contacts.type(), fields, sample, faults);
  } else {
    prepared.sample->pairs = {}, prepared.sample->wall_contacts = {};
  }
  if (!faults.empty()) throw PlacedError(std::move(faults));
  Bodies& bodies = prepared.bodies;
  for (std::size_t i = 0; i < bodies.count(); ++i)
    builders.builder_of(bodies.group_of(bodies.id[i])).take_over(bodies, i);
  prepared.sample->walls.drop(walls_with_other_geometry(scene, live_before.now()));
  prepared.bodies.request(state);
  return prepared;
}

Prepared prepare(const LiveScene& live, const Registry& registry, StateRequest state) {
  if (live.now().begin) return prepared_sample(live, registry, state);
  return make_bodies(live.now(), live.components(), state);
}

}  // namespace grit
