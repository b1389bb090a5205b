#include <algorithm>
#include <iostream>
#include <iterator>
#include <optional>
#include <utility>

#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "app/runs_folder.hpp"
#include "grit/error.hpp"
#include "output/own_files.hpp"
#include "report/curve_pictures.hpp"
#include "report/pictures.hpp"
#include "report/report_page.hpp"
#include "storage/atomic_file.hpp"
#include "study/batch.hpp"

namespace grit {
namespace {

/// Throws FileError, with what the converter says.
void convert(const std::filesystem::path& svg, const std::filesystem::path& png) {
  const ScratchFile log;
  const BatchJob job{{"rsvg-convert", "--zoom", "2", "--output", png.string(), svg.string()}, log.path()};
  int status = 0;
  try {
    run_batch(std::span(&job, 1), 1, catch_interrupts(),
              {.ended = [&](std::size_t, int ended) { return (status = ended) == 0; }, .waiting = [](std::size_t) {}});
  } catch (const FileError& error) {
    throw FileError(std::string(error.what()) + "; install Debian's librsvg2-bin");
  }
  if (status != 0) throw FileError(png.string() + ": cannot be written: " + text_of(log.path()));
}

void write_pictures(const std::filesystem::path& folder, const std::vector<NamedPicture>& pictures) {
  for (const auto& [name, picture] : pictures)
    for (const char* kind : {".svg", ".png"}) refuse_foreign_page(folder / (name + kind), "move it away");
  for (const auto& [name, picture] : pictures) {
    const auto svg = folder / (name + ".svg"), png = folder / (name + ".png");
    write_beside_others(svg, picture);
    convert(svg, png);
    std::cout << "picture: " << png.string() << '\n';
  }
}

/// All pictures of a run; what cannot be drawn becomes one of its problems.
std::vector<NamedPicture> pictures_of(RunResults& run) {
  std::vector<NamedPicture> pictures;
  const auto draw = [&](auto work) {
    try {
      work();
    } catch (const FileError& error) {
      run.problems.emplace_back(error.what());
    }
  };
  const auto add = [&](const char* name, std::optional<std::string> picture) {
    if (picture) pictures.push_back({name, std::move(*picture)});
  };
  draw([&] { add("curves", curves_picture(std::span(&run, 1))); });
  draw([&] { std::ranges::move(profile_pictures(run), std::back_inserter(pictures)); });
  draw([&] { std::ranges::move(direction_pictures(run), std::back_inserter(pictures)); });
  draw([&] { add("grains", grains_picture(run)); });
  draw([&] { add("layers", layers_picture(run)); });
  draw([&] { add("force-chains", force_chains_picture(run)); });
  draw([&] { add("linear-chains", chains_picture(run)); });
  draw([&] { std::ranges::move(map_pictures(run), std::back_inserter(pictures)); });
  return pictures;
}

/// Reports unreadable folders and draws the others; the status is that of the first failure.
ExitStatus make_pictures(const std::vector<std::filesystem::path>& folders) {
  ExitStatus status = ExitStatus::done;
  const auto attempt = [&](auto work) {
    const ExitStatus one = report([&] { return work(), ExitStatus::done; });
    if (status == ExitStatus::done) status = one;
  };
  std::vector<RunResults> runs;
  for (const auto& folder : folders) attempt([&] { runs.push_back(read_results(folder)); });
  make_names_unique(runs);
  for (RunResults& run : runs) {
    attempt([&] {
      const auto pictures = pictures_of(run);
      if (pictures.empty() && !run.problems.empty())
        throw FileError(run.folder.string() + ": holds nothing that can be drawn");
      write_pictures(run.folder, pictures);
    });
    for (const std::string& problem : run.problems) std::cerr << "grit: omitted: " << problem << '\n';
  }
  if (runs.size() > 1)
    attempt([&] {
      if (auto curves = curves_picture(runs))
        write_pictures(runs.front().folder, {{"curves-overlaid", std::move(*curves)}});
    });
  return status;
}

/// Reports unreadable folders. Without `out` the page is written to the first readable folder.
ExitStatus make_page(const std::vector<std::filesystem::path>& folders, std::optional<std::filesystem::path> out) {
  const ReportPage page = report_page(folders);
  if (!out) out = page.first / "report.html";
  for (const std::string& why : page.unread) std::cerr << "grit: " << why << '\n';
  refuse_foreign_page(*out);
  write_beside_others(*out, page.html);
  for (const std::string& problem : page.problems) std::cerr << "grit: omitted: " << problem << '\n';
  std::cout << "report: " << out->string() << '\n';
  return page.unread.empty() ? ExitStatus::done : ExitStatus::files;
}

}  // namespace

void report_options(Options& options) {
  namespace po = boost::program_options;
  options.add()("out", po::value<std::string>()->value_name("PAGE"),
                "file of the page; default: report.html in the first folder that holds a run")(
      "png",
      "write pictures into each folder instead of a page: curves.png, profiles-PROBE.png, directions-PROBE.png, "
      "grains.png, layers.png, force-chains.png, linear-chains.png and map-PROBE-FIELD.png, each also as SVG; "
      "for several folders also curves-overlaid.png in the first that holds a run");
}

ExitStatus report_command(const Options& options) {
  if (options.words().empty()) throw UsageError("no folder of results was given; see 'grit report --help'");
  if (options.has("png") && options.has("out")) throw UsageError("--png writes into the folders of results, not --out");
  const std::vector<std::filesystem::path> folders(options.words().begin(), options.words().end());
  if (options.has("png")) return make_pictures(folders);
  return make_page(folders, options.has("out") ? std::optional<std::filesystem::path>(options.get<std::string>("out"))
                                               : std::nullopt);
}

}  // namespace grit
