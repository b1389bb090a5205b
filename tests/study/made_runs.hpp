// Fake runs: folders with given results.
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "output/series.hpp"

namespace grit {

/// series.h5 with probe "test": x, y, and a profile with as many values per sample as y has samples.
inline void make_series(const std::filesystem::path& folder, const std::vector<double>& x,
                        const std::vector<double>& y) {
  std::filesystem::create_directories(folder);
  const std::vector<ProbeGroup> probes{
      {"test", {{"x", "m", "abscissa", {}}, {"y", "Pa", "ordinate", {}}, {"profile", "1", "last", {y.size()}}}}};
  Series series(folder / "series.h5", probes);
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::vector<double> profile(y.size(), 0.0);
    if (i + 1 == x.size()) profile = y;
    const std::span<const double> values[] = {{&x[i], 1}, {&y[i], 1}, profile};
    series.append(0, 0.1 * static_cast<double>(i), i, values);
  }
  series.close();
}

inline void make_run_json(const std::filesystem::path& folder, double cost, const std::string& status = "done",
                          const std::string& message = "") {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "run.json") << nlohmann::json{
      {"status", status}, {"message", message}, {"cpu_s", cost}, {"steps", 10 * cost}, {"bodies", 7}};
}

/// A run with a single value as its metric.
inline void make_run(const std::filesystem::path& folder, double cost, double value) {
  make_run_json(folder, cost);
  make_series(folder, {0, 1}, {0, value});
}

}  // namespace grit
