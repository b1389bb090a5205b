// `grit check` of a description with hundreds of stages.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <string>

#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;

/// A column under a lid. Each stage presses it harder, along a ramp, and changes friction and damping.
json with_stages(int count) {
  json d = json::parse(R"({
    "contacts": {"type": "linear-rolling"},
    "materials": {"sand": {"density": 2600}, "steel": {"density": 7850}},
    "interfaces": {"sand+steel": {"friction_angle": "12 deg"}},
    "domain": {"low": [0, 0, 0], "high": ["10 mm", "10 mm", "10 mm"], "periodic": [true, true, false]},
    "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {"type": "cloud",
      "low": [0, 0, "1 mm"], "high": ["10 mm", "10 mm", "8 mm"], "count": 100, "sizes": {"type": "uniform"}}}},
    "walls": {
      "floor": {"type": "plane", "material": "steel", "point": [0, 0, 0], "normal": [0, 0, 1]},
      "lid": {"type": "rectangle", "material": "steel", "corner": [0, 0, "9 mm"], "edge_a": [0, "10 mm", 0],
        "edge_b": ["10 mm", 0, 0],
        "motion": {"servo": {"pressure": "1 kPa", "max_velocity": "1 m/s"}}}
    },
    "engines": {"damping": {"type": "local-damping", "coefficient": 0.1}},
    "probes": {"packing": {"type": "packing", "every_time": "1 ms"}},
    "stages": []
  })");
  for (int i = 0; i < count; ++i)
    d["stages"].push_back({{"name", "stage " + std::to_string(i)},
                           {"until", {{"type", "time"}, {"value", "1 ms"}}},
                           {"limit", "2 ms"},
                           {"change",
                            {{"materials", {{"sand", {{"friction_angle", 0.3 + 1e-4 * i}}}}},
                             {"engines", {{"damping", {{"coefficient", 0.1 + 1e-4 * i}}}}}}},
                           {"ramps", json::array({{{"pointer", "/walls/lid/motion/servo/pressure"},
                                                   {"from", 1e3 * (i + 1)},
                                                   {"to", 1e3 * (i + 2)},
                                                   {"duration", "0.5 ms"}}})}});
  return d;
}

/// CPU time of all programs that have ended [s].
double used() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

TEST(ManyStages, AreCheckedInNoTime) {
  const OwnFolder folder;
  folder.write("many.json", with_stages(700).dump());
  const double before = used();
  const auto outcome = grit_in(folder.path(), {"check", "--threads", "1", "many.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_LT(used() - before, 2) << "s; it was 54 s when each stage was read as a whole description";
}

}  // namespace
}  // namespace grit
