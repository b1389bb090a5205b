// Components of a description without their parameters. They decide whether a study is of the same kind of scene.
#pragma once

#include <string>
#include <vector>

#include "grit/description.hpp"

namespace grit {

/// One line each, sorted: the contact law; bodies, walls and engines with their types; stages; periodic axes.
/// `resolved` includes all defaults, as in run.json.
std::vector<std::string> parts_of(const Description& resolved);

/// Whether the seed has an effect: on positions and sizes of a cloud or a stream, or on orientations of clumps whose
/// positions come from a file or a lattice.
bool is_random(const Description& resolved);

}  // namespace grit
