#include <iostream>

#include "app/options.hpp"
#include "input/scene.hpp"
#include "simulation/live_scene.hpp"

namespace grit {
namespace {

/// Replaces file names by their full paths from `whole`, so that the output may be saved anywhere.
void name_files(Description& plain, const Description& whole) {
  if (plain.is_string() && whole.is_string()) plain = whole;
  if (plain.is_array() && whole.is_array())
    for (std::size_t i = 0; i < std::min(plain.size(), whole.size()); ++i) name_files(plain[i], whole[i]);
  if (plain.is_object() && whole.is_object())
    for (auto& [key, value] : plain.items())
      if (const auto same = whole.find(key); same != whole.end()) name_files(value, *same);
}

}  // namespace

void expand_options(Options& options) { options.add_set(); }

ExitStatus expand_command(const Options& options) {
  const std::string file = options.only_word("description");
  const auto registry = options.registry();
  const Document document = load_document(file, options.list("set"), *registry);
  const Scene scene = read_scene(document, *registry);
  const LiveScene live(scene);  // throws if the description cannot be run
  Description plain = document.json();
  name_files(plain, resolved(*scene.description));
  std::cout << plain.dump(2) << '\n';
  return ExitStatus::done;
}

}  // namespace grit
