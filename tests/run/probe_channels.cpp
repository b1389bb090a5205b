// Channels of a probe by name, and faults of a probe that a run reports.
#include "grit/channels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "grit/error.hpp"
#include "support/notes.hpp"

namespace grit::test {
namespace {

using testing::ElementsAre;
using testing::ThrowsMessage;

std::vector<Channel> some_channels() {
  return {{"slip", "m", "", {}}, {"profile", "1", "", {3}}, {"angle", "rad", "", {}}, {"stress", "Pa", "", {2, 2}}};
}

TEST(ChannelValues, AreBoundByName) {
  ChannelValues values("a probe", some_channels());
  values["angle"] = 2;
  values["slip"] = 1;
  const auto stress = values.list("stress");
  ASSERT_EQ(stress.size(), 4u);
  std::ranges::copy(std::vector<double>{6, 7, 8, 9}, stress.begin());
  std::ranges::copy(std::vector<double>{3, 4, 5}, values.list("profile").begin());
  values.check();
  std::vector<double> all;
  for (const auto channel : values.all()) all.insert(all.end(), channel.begin(), channel.end());
  EXPECT_THAT(all, ElementsAre(1, 3, 4, 5, 2, 6, 7, 8, 9)) << "in the order of the channels";
  EXPECT_EQ(values.list("slip").front(), 1) << "a number is a list of one";
  const ChannelValues& constant = values;
  EXPECT_EQ(constant["angle"], 2);
  EXPECT_THAT(constant.list("profile"), ElementsAre(3, 4, 5));
}

TEST(ChannelValues, RefuseUnknownNames) {
  ChannelValues values("a probe", some_channels());
  const char* const message = "a probe has no channel \"slop\"; its channels are slip, profile, angle, stress";
  EXPECT_THAT([&] { values["slop"] = 1; }, ThrowsMessage<PluginError>(message));
  EXPECT_THAT([&] { values.list("slop"); }, ThrowsMessage<PluginError>(message));
  ChannelValues none("a probe", {});
  EXPECT_THAT([&] { none[""] = 1; }, ThrowsMessage<PluginError>("a probe has no channel \"\"; its channels are none"));
}

TEST(ChannelValues, RefuseAListAsANumber) {
  ChannelValues values("a probe", some_channels());
  EXPECT_THAT([&] { values["profile"] = 1; },
              ThrowsMessage<PluginError>("a probe: channel \"profile\" has 3 values; use list(\"profile\")"));
}

TEST(ChannelValues, RefuseAChannelThatIsDeclaredTwice) {
  auto channels = some_channels();
  channels.push_back(channels.front());
  EXPECT_THAT([&] { ChannelValues("a probe", channels); },
              ThrowsMessage<PluginError>("a probe declares the channel \"slip\" twice"));
}

TEST(ChannelValues, ReportMissingValues) {
  const std::vector<Channel> channels{{"slip", "m", "", {}}, {"profile", "1", "", {3}}};
  ChannelValues values("a probe", channels);
  const char* const advice = "; a sample must write all values of all channels";
  EXPECT_THAT([&] { values.check(); },
              ThrowsMessage<PluginError>(std::string("a probe did not write channel \"slip\"") + advice));
  values["slip"] = std::numeric_limits<double>::quiet_NaN();
  values.list("profile")[0] = values.list("profile")[2] = std::nan("7");
  EXPECT_THAT(
      [&] { values.check(); },
      ThrowsMessage<PluginError>(std::string("a probe did not write value 2 of 3 of channel \"profile\"") + advice));
  values.list("profile")[1] = 0;
  EXPECT_NO_THROW(values.check());
  values.clear();
  EXPECT_THROW(values.check(), PluginError) << "each sample writes all again";
}

TEST(ChannelValues, ReportValuesBeyondTheEnd) {
  ChannelValues values("a probe", {{"slip", "m", "", {}}, {"profile", "1", "", {3}}});
  values["slip"] = 1;
  std::ranges::fill(values.list("profile"), 2);
  values.list("profile").data()[3] = 2;
  EXPECT_THAT([&] { values.check(); },
              ThrowsMessage<PluginError>("a probe wrote behind the end of channel \"profile\", which has 3 values"));
}

/// Writes one of its two channels, and optionally an undeclared one; refuses what a test asks for.
class Careless final : public Probe {
 public:
  std::string writes = "first";
  bool refuses = false;
  void declare(Parameters& p) override {
    p.add("writes", writes).doc("the channel that it writes");
    p.add("refuses", refuses).doc("whether it refuses the world");
  }
  void prepare(const World&) override {
    if (refuses) throw ParameterError({{"writes", '"' + writes + '"', "another one"}, {"", "the whole", "less"}});
  }
  std::vector<Channel> channels() const override { return {{"first", "1", "", {}}, {"second", "1", "", {}}}; }
  void sample(const World&, ChannelValues& values) override { values[writes] = 1; }
};

Description watched_by(const Description& probes) {
  static const PluginInfo careless = [] {
    PluginInfo info;
    info.kind = "probe", info.name = "careless", info.version = "1.0.0", info.doc = "writes one channel";
    info.make_probe = []() -> Probe* { return new Careless; };
    return info;
  }();
  installed().add(careless);
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}, {"density", 2600}}, {{{0, 0, 0}, 1e-3}});
  d["stages"] = Description::array({{{"name", "fly"}, {"until", {{"type", "steps"}, {"value", 2}}}, {"limit", 1}}});
  d["probes"] = probes;
  return d;
}

TEST(ProbesOfARun, AreNamedIfTheyWriteTooLittleOrTooMuch) {
  EXPECT_THAT(
      [] {
        run(watched_by({{"mine", {{"type", "careless"}, {"every_steps", 1}}}}));
      },
      ThrowsMessage<PluginError>("probe \"mine\" of type \"careless\" did not write channel \"second\"; a sample "
                                 "must write all values of all channels"));
  EXPECT_THAT(
      [] {
        run(watched_by({{"mine", {{"type", "careless"}, {"every_steps", 1}, {"writes", "third"}}}}));
      },
      ThrowsMessage<PluginError>("probe \"mine\" of type \"careless\" has no channel \"third\"; its channels are "
                                 "first, second"));
}

TEST(ProbesOfARun, ReportAllThatTheyRefuse) {
  const Description refusing = {{"type", "careless"}, {"every_steps", 1}, {"refuses", true}};
  try {
    run(watched_by({{"a", refusing}, {"b", refusing}}));
    FAIL();
  } catch (const DescriptionError& error) {
    std::vector<std::string> all;
    for (const Problem& problem : error.problems()) all.push_back(problem.pointer + ": " + problem.message);
    EXPECT_THAT(all, ElementsAre("/probes/a/writes: found \"first\"; allowed is another one",
                                 "/probes/a: found the whole; allowed is less",
                                 "/probes/b/writes: found \"first\"; allowed is another one",
                                 "/probes/b: found the whole; allowed is less"));
  }
}

}  // namespace
}  // namespace grit::test
