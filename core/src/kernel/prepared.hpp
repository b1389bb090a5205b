// What a simulation starts from: bodies, and with them the rest of a prepared sample.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "bodies/bodies.hpp"
#include "contact/contact_table.hpp"
#include "contact/wall_contacts.hpp"
#include "domain/deforming_cell.hpp"
#include "motion/walls.hpp"

namespace grit {

/// State of another simulation beside its bodies, at one instant.
struct SampleState {
  DeformingCell cell;
  Walls walls;
  ContactTable pairs;
  WallContacts wall_contacts;
};

struct Prepared {
  Prepared(Bodies alone) : bodies(std::move(alone)) {}
  Prepared(Bodies of_sample, SampleState rest)
      : bodies(std::move(of_sample)), sample(std::make_unique<SampleState>(std::move(rest))) {}

  Bodies bodies;
  std::unique_ptr<SampleState> sample;  ///< null without one
  std::string note;                     ///< what users should know about the sample; may be empty
};

}  // namespace grit
