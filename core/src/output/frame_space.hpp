// Whether the disk holds the frames of a run.
#pragma once

#include <filesystem>

#include "bodies/bodies.hpp"
#include "input/scene.hpp"
#include "simulation/expected_frames.hpp"
#include "simulation/live_scene.hpp"

namespace grit {

/// Throws PlacedError if the disk of the results cannot hold the frames; `bytes`: of one of them.
void check_disk(const ExpectedFrames& frames, double bytes, const std::filesystem::path& results);

/// The same before a run, of which the time step is not known yet.
void check_disk(const Scene& scene, const LiveScene& live, const Bodies& bodies, const std::filesystem::path& results);

}  // namespace grit
