// As if linked with -ffast-math: subnormal numbers become zero as soon as it is opened.
#include "fixture.hpp"
#ifdef __SSE__
#include <xmmintrin.h>

namespace {
const bool set = (_mm_setcsr(_mm_getcsr() | 0x8040), true);
}
#endif

const grit::PluginInfo* grit_plugin() {
  return fixture::plugin("flushes-to-zero", [](grit::PluginInfo&) {});
}
