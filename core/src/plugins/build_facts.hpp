// What this library was built from and with; CMake says it when it configures.
#pragma once

namespace grit {

struct BuildFacts {
  const char* version;          ///< of grit
  const char* revision;         ///< git's name of it, with "-dirty" for a changed tree; empty outside a repository
  const char* compiler;         ///< e.g. "GNU 12.2.0"
  const char* build_type;       ///< e.g. "Release"
  const char* arch;             ///< what -march= took, e.g. "native"; GRIT_ISA and folders go by this name
  const char* instruction_set;  ///< what the compiler made of that, e.g. "x86-64-v3"; as in build tags
};

const BuildFacts& build_facts();

}  // namespace grit
