#include "grit/testing/probe.hpp"

#include <algorithm>
#include <cmath>
#include <regex>
#include <set>

#include "grit/testing/reading.hpp"

namespace grit {

int probe_contract() { return 0; }

namespace {

bool is_snake_case(const std::string& name) {
  static const std::regex pattern("[a-z][a-z0-9]*(_[a-z0-9]+)*");
  return std::regex_match(name, pattern);
}

/// Numbers are finite, or NaN or infinite if the documentation says so.
bool is_documented(double value, const std::string& doc) {
  return std::isfinite(value) || doc.find(std::isnan(value) ? "NaN" : "infinite") != std::string::npos;
}

/// The complete state of a world as numbers.
std::vector<double> all_of(const FakeWorld& world) {
  std::vector<double> all{world.now, world.time_step, world.density, static_cast<double>(world.steps)};
  const auto vector = [&](const Vec3& v) { all.insert(all.end(), v.begin(), v.end()); };
  for (const auto* rows : {&world.position, &world.velocity, &world.spin, &world.force, &world.moment})
    for (const auto& row : *rows) vector(xyz(row)), all.push_back(row.w);
  for (const auto* vectors : {&world.rotation, &world.displacement})
    for (const auto& v : *vectors) vector(v);
  all.insert(all.end(), world.id.begin(), world.id.end());
  all.insert(all.end(), world.material.begin(), world.material.end());
  for (const auto& c : world.contact) {
    for (const auto* v : {&c.branch, &c.normal, &c.force, &c.moment}) vector(*v);
    all.insert(all.end(), {double(c.a), double(c.b), double(c.with_wall), c.normal_force, c.overlap});
  }
  for (const auto& w : world.wall) {
    for (const auto* v : {&w.position, &w.stage_position, &w.velocity, &w.spin, &w.force, &w.moment, &w.normal})
      vector(*v);
    all.insert(all.end(), {w.area, w.pressure, double(w.contacts), double(std::hash<std::string>()(w.name) >> 12)});
  }
  vector(world.whole.low), vector(world.whole.high), vector(world.box.low), vector(world.box.high);
  return all;
}

TEST_P(ProbeContract, DocumentsItsParameters) {
  Parameters parameters;
  probe_->declare(parameters);
  std::set<std::string> names;
  for (const auto& parameter : parameters.entries()) {
    EXPECT_TRUE(is_snake_case(parameter.name())) << parameter.name();
    EXPECT_TRUE(names.insert(parameter.name()).second) << parameter.name() << " is declared twice";
    EXPECT_TRUE(is_unit(parameter.unit())) << parameter.name() << ": unit \"" << parameter.unit() << '"';
    EXPECT_FALSE(parameter.doc().empty()) << parameter.name();
  }
  EXPECT_EQ(complaints(*probe_), "");
}

TEST_P(ProbeContract, NamesItsChannels) {
  std::set<std::string> names;
  for (const auto& channel : probe_->channels()) {
    EXPECT_TRUE(is_snake_case(channel.name)) << channel.name;
    EXPECT_TRUE(names.insert(channel.name).second) << channel.name << " is declared twice";
    EXPECT_TRUE(is_unit(channel.unit)) << channel.name << ": unit \"" << channel.unit << '"';
    EXPECT_FALSE(channel.doc.empty()) << channel.name;
    EXPECT_EQ(channel.doc.find('\n'), std::string::npos) << channel.name;
    for (const auto extent : channel.shape) EXPECT_GT(extent, 0u) << channel.name;
    if (channel.coordinate.empty()) continue;
    const auto channels = probe_->channels();
    const auto where = std::ranges::find(channels, channel.coordinate, &Channel::name);
    ASSERT_NE(where, channels.end()) << channel.name << ": there is no channel " << channel.coordinate;
    EXPECT_EQ(where->shape, channel.shape) << channel.name;
  }
  EXPECT_FALSE(names.empty());
}

TEST_P(ProbeContract, KeepsItsChannels) {
  const auto described = [this] {
    std::string all;
    for (const auto& channel : probe_->channels()) {
      all += channel.name + '|' + channel.unit + '|' + channel.doc;
      for (const auto extent : channel.shape) all += '|' + std::to_string(extent);
      all += '\n';
    }
    return all;
  };
  const std::string first = described();
  EXPECT_EQ(described(), first);
  sampled(*probe_, world_);
  probe_->fields(world_);
  EXPECT_EQ(described(), first);
}

TEST_P(ProbeContract, FillsEveryValue) {
  const ChannelValues values = sampled(*probe_, world_);
  for (const auto& channel : probe_->channels())
    for (const double value : values.list(channel.name))
      EXPECT_TRUE(is_documented(value, channel.doc)) << channel.name << ": " << value;
}

TEST_P(ProbeContract, FillsEveryValueWithoutBodies) {
  FakeWorld empty = world_;
  empty.contact.clear();
  for (auto* rows : {&empty.position, &empty.velocity, &empty.spin, &empty.force, &empty.moment}) rows->clear();
  empty.id.clear(), empty.material.clear(), empty.rotation.clear(), empty.displacement.clear();
  const ChannelValues values = sampled(*probe_, empty);
  for (const auto& channel : probe_->channels())
    for (const double value : values.list(channel.name))
      EXPECT_TRUE(is_documented(value, channel.doc)) << channel.name << ": " << value;
  probe_->fields(empty);
}

TEST_P(ProbeContract, SurvivesTheWorldOfAFailedRun) {
  FakeWorld failed = world_;
  const double unknown = std::nan("");
  for (auto* rows : {&failed.position, &failed.velocity, &failed.spin})
    if (!rows->empty()) rows->back().x = rows->back().y = rows->back().z = unknown;
  for (auto* vectors : {&failed.rotation, &failed.displacement})
    if (!vectors->empty()) vectors->back().setConstant(unknown);
  sampled(*probe_, failed);
  probe_->fields(failed);
}

TEST_P(ProbeContract, GivesIdenticalValuesAgain) {
  const auto first = sampled(*probe_, world_);
  EXPECT_TRUE(same_bits(sampled(*probe_, world_), first));
  probe_->fields(world_);
  EXPECT_TRUE(same_bits(sampled(*probe_, world_), first));
  const auto other = GetParam().make();
  other->prepare(world_);
  EXPECT_TRUE(same_bits(sampled(*other, world_), first));
}

/// State kept between samples must be in serialize(): a restored probe returns exactly the values of one that was not
/// interrupted.
TEST_P(ProbeContract, ContinuesFromACheckpoint) {
  const int looks = 12, stops_after = 6;
  std::shared_ptr<Probe> goes_on;
  for (int look = 0; look < looks; ++look) {
    const FakeWorld now = later(world_, look);
    const auto expected = sampled(*probe_, now);
    if (goes_on) {
      ASSERT_TRUE(same_bits(sampled(*goes_on, now), expected)) << "sample " << look;
      const auto a = probe_->fields(now), b = goes_on->fields(now);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].values.size(), b[i].values.size()) << a[i].name;
        EXPECT_EQ(std::memcmp(a[i].values.data(), b[i].values.data(), a[i].values.size() * sizeof(double)), 0)
            << a[i].name;
      }
    }
    if (look != stops_after) continue;
    goes_on = GetParam().make();
    goes_on->prepare(world_);
    restore_state(*goes_on, saved_state(*probe_));
    EXPECT_TRUE(saved_state(*goes_on) == saved_state(*probe_));
  }
}

TEST_P(ProbeContract, LeavesTheWorldAsItIs) {
  const auto before = all_of(world_);
  sampled(*probe_, world_);
  probe_->fields(world_);
  EXPECT_TRUE(before == all_of(world_));
}

TEST_P(ProbeContract, GivesFieldsAsTables) {
  const auto fields = probe_->fields(world_);
  const auto again = probe_->fields(world_);
  ASSERT_EQ(fields.size(), again.size());
  std::set<std::string> names;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto& field = fields[i];
    EXPECT_TRUE(is_snake_case(field.name)) << field.name;
    EXPECT_TRUE(names.insert(field.name).second) << field.name << " is declared twice";
    EXPECT_TRUE(is_unit(field.unit)) << field.name << ": unit \"" << field.unit << '"';
    EXPECT_FALSE(field.doc.empty()) << field.name;
    ASSERT_GT(field.width, 0u) << field.name;
    EXPECT_EQ(field.values.size() % field.width, 0u) << field.name;
    EXPECT_EQ(field.values.size() / field.width, fields[0].values.size() / fields[0].width) << field.name;
    for (const double value : field.values) EXPECT_TRUE(is_documented(value, field.doc)) << field.name << ": " << value;
    ASSERT_EQ(field.values.size(), again[i].values.size()) << field.name;
    EXPECT_EQ(std::memcmp(field.values.data(), again[i].values.data(), field.values.size() * sizeof(double)), 0)
        << field.name;
  }
}

}  // namespace
}  // namespace grit
