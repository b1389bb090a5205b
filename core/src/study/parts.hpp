// What a description is made of, whatever its numbers: by that a study of another scene is told from one of the same.
#pragma once

#include <string>
#include <vector>

#include "grit/description.hpp"

namespace grit {

/// One line each, sorted: the law of contacts, bodies, walls and engines with their types, stages, and axes along which
/// the domain repeats. `resolved` has all its defaults, as that of run.json.
std::vector<std::string> parts_of(const Description& resolved);

/// Whether a seed decides anything of it: places and sizes of a cloud, orientations of clumps that a file has places
/// of.
bool is_random(const Description& resolved);

}  // namespace grit
