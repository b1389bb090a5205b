#include <iostream>

#include "app/options.hpp"
#include "input/scene.hpp"

namespace grit {

ExitStatus expand_command(const std::vector<std::string>& words) {
  Options options(command("expand"));
  options.add()("set", boost::program_options::value<std::vector<std::string>>()->composing()->value_name("/POINTER=VALUE"),
                "change a value first; may be given again");
  if (!options.read(words)) return ExitStatus::done;
  const auto registry = options.registry();
  const Document document = load_document(options.only_word("description"), options.list("set"), *registry);
  read_scene(document, *registry);  // what is printed can be run
  std::cout << document.json().dump(2) << '\n';
  return ExitStatus::done;
}

}  // namespace grit
