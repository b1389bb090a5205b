// The page of a run in progress: new data are sent once.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdarg>
#include <functional>

#include "output/writing_mark.hpp"
#include "report/live_page.hpp"
#include "results.hpp"

namespace {
std::function<void(const std::filesystem::path&)> before_each_open;
}

// The library calls this instead of the system's.
extern "C" int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const auto mode = (flags & O_CREAT) != 0 ? va_arg(more, unsigned) : 0u;
  va_end(more);
  if (before_each_open) before_each_open(path);
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

namespace grit::live_tests {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

json channel_of(const json& report, const std::string& name) {
  for (const auto& probe : report.at("runs").at(0).at("probes"))
    for (const auto& channel : probe.at("channels"))
      if (channel.at("name") == name) return channel;
  throw std::runtime_error("there is no " + name);
}

void set_file(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

TEST(LivePage, ReportsARunWithoutResults) {
  const Folder folder;
  LivePage page(folder / "run", "1");
  EXPECT_FALSE(page.refresh());
  EXPECT_THAT(page.html(), HasSubstr("The run is being prepared."));
  const json report = json_of(page.html());
  EXPECT_THAT(report.at("runs"), IsEmpty());
  EXPECT_EQ(report.at("live").at("run"), "1");
  EXPECT_EQ(report.at("live").at("since"), page.since());
  const json news = page.news(page.since());
  EXPECT_EQ(news, json({{"run", "1"}}));
}

TEST(LivePage, SendsNewDataAndKeepsTheNumbersOfTheRest) {
  const Folder folder;
  SmallRun(folder / "run").write();
  LivePage page(folder / "run", "1");
  const std::size_t nothing = page.since();
  ASSERT_TRUE(page.refresh());
  const json first = page.news(nothing);
  EXPECT_THAT(std::string(first.at("head")), HasSubstr("a small run"));
  EXPECT_EQ(first.at("elements").size(), first.at("used").size()) << "all elements";
  EXPECT_FALSE(page.refresh()) << "nothing was written";
  EXPECT_EQ(page.since(), first.at("since"));

  // The same run with another ratio, which is also the first component of the stress.
  SmallRun other(folder / "run");
  other.ratio[1] = 0.5;
  other.options.existing = Existing::overwrite;
  other.write();
  ASSERT_TRUE(page.refresh());
  const json second = page.news(first.at("since"));
  const json changed = channel_of(second.at("report"), "stress_ratio"),
             same = channel_of(second.at("report"), "largest_overlap");
  ASSERT_EQ(second.at("elements").size(), 2u);
  EXPECT_GE(changed.at("data"), first.at("since"));
  const auto text = unpacked(second.at("elements").at(changed.at("data").dump()));
  double value = 0;
  std::memcpy(&value, text.data() + sizeof value, sizeof value);
  EXPECT_EQ(value, 0.5);
  EXPECT_EQ(same.at("data"), channel_of(first.at("report"), "largest_overlap").at("data"));
  EXPECT_LT(same.at("data"), first.at("since"));

  const json all = page.news(nothing);
  EXPECT_EQ(all.at("elements").size(), all.at("used").size()) << "for a page without data";
}

TEST(LivePage, IsTheSameCompleteAndInParts) {
  const Folder folder;
  SmallRun(folder / "run").write();
  LivePage page(folder / "run", "1");
  const std::size_t nothing = page.since();
  ASSERT_TRUE(page.refresh());
  const std::string html = page.html();
  const json news = page.news(nothing);
  EXPECT_EQ(json_of(html), news.at("report"));
  EXPECT_EQ(json_of(html).at("live").at("since"), page.since());
  for (const auto& [number, text] : news.at("elements").items())
    EXPECT_EQ(between(html, "id=\"data-" + number + "\">", "</script>"), std::string(text));
}

TEST(LivePage, MayContactItsServerAndAPageFromDiskMayNot) {
  const Folder folder;
  SmallRun(folder / "run").write();
  const auto place = folder / "run";
  LivePage page(place, "1");
  ASSERT_TRUE(page.refresh());
  EXPECT_THAT(page.html(), HasSubstr("connect-src 'self'; worker-src blob:; "));
  EXPECT_THAT(page.html(), HasSubstr("fetch("));
  const std::string closed = report_page(std::span(&place, 1)).html;
  EXPECT_THAT(closed, Not(HasSubstr("connect-src")));
  EXPECT_THAT(closed, Not(HasSubstr("worker-src")));
  EXPECT_THAT(closed, Not(HasSubstr("class Follower")));
}

TEST(LivePage, ShowsReadablePartsOfADamagedFolder) {
  const Folder folder;
  SmallRun(folder / "run").write();
  set_file(folder / "run/series.h5", "not HDF5");
  LivePage page(folder / "run", "1");
  const std::size_t nothing = page.since();
  ASSERT_TRUE(page.refresh());
  const json news = page.news(nothing);
  EXPECT_THAT(std::string(news.at("head")), HasSubstr("What could not be read"));
  EXPECT_EQ(news.at("report").at("runs").at(0).at("grains").at("frames").size(), 2u);
}

TEST(LivePage, StaysAsItIsWhileTheSeriesAreBeingWritten) {
  const Folder folder;
  SmallRun(folder / "run").write();
  const auto series = folder / "run/series.h5";
  const std::string whole = text_of(series);
  // An hour ago: recent files have to settle.
  const auto write = [&](const std::string& bytes) {
    set_file(series, bytes);
    std::filesystem::last_write_time(series, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  };
  write(whole);
  LivePage page(folder / "run", "1", {}, std::chrono::milliseconds(0));
  ASSERT_TRUE(page.refresh());
  const auto known = page.since();
  const std::string html = page.html();
  {
    const WritingMark mark(series, WritingMark::Absent::leave);
    write(whole.substr(0, whole.size() / 2));
    EXPECT_FALSE(page.refresh());
    EXPECT_EQ(page.html(), html);
    EXPECT_EQ(page.since(), known);
  }
  // As left by a killed writer.
  EXPECT_TRUE(page.refresh());
  EXPECT_THAT(page.html(), AllOf(HasSubstr("What could not be read"), HasSubstr("series.h5: cannot read")));
  write(whole);
  EXPECT_TRUE(page.refresh());
  EXPECT_THAT(page.html(), Not(HasSubstr("What could not be read")));
}

// The folder changes whenever run.json is read.
TEST(LivePage, ReportsUnreadableFilesInAChangingFolderOnlyIfTheyPersist) {
  const Folder folder;
  SmallRun(folder / "run").write();
  set_file(folder / "run/frames/000007.h5", "not HDF5");
  LivePage page(folder / "run", "1");
  std::size_t changes = 0;
  before_each_open = [&](const std::filesystem::path& path) {
    if (path != folder / "run/run.json") return;
    set_file(folder / ("run/frames/1" + std::to_string(10000 + changes++) + ".h5"), "not HDF5 either");
  };
  for (std::size_t look = 0; look < 3; ++look) EXPECT_FALSE(page.refresh());
  EXPECT_TRUE(page.refresh());
  EXPECT_THAT(page.html(), HasSubstr("000007.h5: cannot read"));
  EXPECT_TRUE(page.refresh()) << "and again, as it persists";
  before_each_open = nullptr;
  EXPECT_GE(changes, 5u);
}

}  // namespace
}  // namespace grit::live_tests
