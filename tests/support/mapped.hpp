// Points of the maps in docs/evidence/stability, and figures of its table.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace grit::test {

/// Notes a point of a map for scripts/stability.py. Series whose names begin with "predicted" are drawn as lines alone.
inline void map_point(const std::string& map, const std::string& series, double x, double y) {
  char key[32], value[64];
  static int count = 0;
  std::snprintf(key, sizeof key, "|%06d", ++count);
  std::snprintf(value, sizeof value, "%.9g %.9g", x, y);
  testing::Test::RecordProperty("mapped: " + map + "|" + series + key, value);
}

/// Notes a figure for the table of scripts/stability.py, by the name that it has there. Of several tests that tell one
/// the largest counts; within a test the last.
inline void figure(const std::string& name, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  testing::Test::RecordProperty("figure: " + name, text);
}

}  // namespace grit::test
