// What this library was built from and with; CMake says it when it configures.
#pragma once

namespace grit {

struct BuildFacts {
  const char* version;          ///< of grit
  const char* revision;         ///< git's name of it, with "-dirty" for a changed tree; empty outside a repository
  const char* compiler;         ///< e.g. "GNU 12.2.0"
  const char* build_type;       ///< e.g. "Release"
  const char* instruction_set;  ///< what -march= took, e.g. "native"
};

const BuildFacts& build_facts();

}  // namespace grit
