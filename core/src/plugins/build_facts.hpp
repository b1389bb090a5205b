// Version, sources and compiler of this library, set by CMake.
#pragma once

namespace grit {

struct BuildFacts {
  const char* version;          ///< of grit
  const char* revision;         ///< by git describe, with "-dirty" for a modified tree; empty outside a repository
  const char* date;             ///< of the revision, as in 2026-01-31; of the build outside a repository
  const char* compiler;         ///< e.g. "GNU 12.2.0"
  const char* build_type;       ///< e.g. "Release"
  const char* flags;            ///< of the compiler, for everything but the launcher
  const char* libraries;        ///< names and versions of those it was built with
  const char* arch;             ///< value of -march, e.g. "native"; also used by GRIT_ISA and for folder names
  const char* instruction_set;  ///< the resulting instruction set, e.g. "x86-64-v3"; as in build tags
};

const BuildFacts& build_facts();

}  // namespace grit
