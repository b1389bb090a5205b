#include "app/run_jobs.hpp"

#include "app/command.hpp"
#include "app/runs_folder.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/text_file.hpp"
#include "input/scene.hpp"
#include "output/folder_lock.hpp"
#include "output/own_files.hpp"
#include "output/shell_word.hpp"

namespace grit {
namespace {

/// The file of a description or, with --resume, the folder of a run, which holds its description.
RunJob job_of(const std::string& word, const Options& options) {
  RunJob job;
  if (options.has("resume") ? std::filesystem::is_directory(word)
                            : std::filesystem::exists(std::filesystem::path(word) / "run.json")) {
    if (!options.has("resume"))
      throw UsageError(word + " is a folder of results; give a description, or continue its run with --resume");
    if (options.has("out"))
      throw UsageError(word + " is a folder of results, in which its run continues; remove --out");
    job.folder = std::filesystem::path(word).lexically_normal();
    if (job.folder.filename().empty()) job.folder = job.folder.parent_path();
    job.file = (job.folder / "description.json").string();
    if (!std::filesystem::exists(job.file))
      throw FileError(job.file +
                      ": there is no such file, so that no run can continue in this folder; start the run "
                      "again with its description: 'grit run FILE --out " +
                      shell_word(job.folder.string()) + " --overwrite'");
    return job;
  }
  job.file = word;
  if (!options.has("out")) {
    job.folder = default_results(word);
  } else {
    job.folder = options.get<std::string>("out");
    if (options.words().size() > 1) job.folder /= default_results(word).filename();
  }
  return job;
}

/// Reads the description again, as it was before its scenario was expanded.
DescriptionSource source_of(const std::string& file, const std::vector<std::string>& sets) {
  DescriptionSource source{.path = std::filesystem::absolute(file).lexically_normal().string(), .sets = sets};
  if (!std::filesystem::is_regular_file(file)) return source;
  source.written = Description::parse(read_text(file));
  Document document = Document::load(file);
  for (const std::string& assignment : sets) document.set(assignment);
  if (!scenario_type(document).empty()) source.unexpanded = document.json();
  return source;
}

}  // namespace

std::set<std::filesystem::path> inputs_of(const RunJob& job) {
  const Scene& scene = job.opened->scene;
  auto inputs = paths_in(resolved(*scene.description));
  for (const std::string& source : scene.document.sources()) inputs.insert(source);
  inputs.insert(job.file);
  // A run that starts again in its folder reads its own description, which stays the same.
  if (job.existing == Existing::resume) inputs.erase(job.folder / "description.json");
  return inputs;
}

RunJob named_job(const Options& options) { return job_of(options.words().front(), options); }

void open(RunJob& job, const Options& options) {
  const std::shared_ptr<const Registry> registry = options.registry();
  job.opened = std::make_shared<OpenedScene>(registry, load_scene(job.file, options.list("set"), *registry));
}

std::vector<RunJob> jobs_of(const Options& options) {
  const auto& files = options.words();
  std::vector<RunJob> jobs;
  for (const std::string& file : files) {
    RunJob job = job_of(file, options);
    for (const RunJob& other : jobs)
      if (job.folder == other.folder)
        throw UsageError(other.file + " and " + file + " would both write to " + job.folder.string() +
                         "; run them one by one, each with its own --out");
    if (!FolderLock(job.folder).held()) refuse_busy(job.folder);  // before the bodies are made
    if (options.has("overwrite")) job.existing = Existing::overwrite;
    else if (options.has("resume")) job.existing = Existing::resume;
    else if (holds_a_run(job.folder))
      throw FileError(job.folder.string() +
                      " holds the results of a run; choose another folder (--out DIR), continue it (--resume) or "
                      "replace them (--overwrite)");
    if (job.existing != Existing::resume) {
      refuse_results_of_others(job.folder, ResultsOf::run);
      refuse_foreign_files(job.folder);
    }
    jobs.push_back(std::move(job));
  }
  return jobs;
}

void open_all(std::vector<RunJob>& jobs, const Options& options) {
  const std::shared_ptr<const Registry> registry = options.registry();
  std::vector<Problem> problems;
  for (RunJob& job : jobs) try {
      job.opened = std::make_shared<OpenedScene>(registry, load_scene(job.file, options.list("set"), *registry));
      job.source = source_of(job.file, options.list("set"));
      if (job.existing == Existing::overwrite) refuse_inputs(job.folder, inputs_of(job));
    } catch (const DescriptionError& error) {
      for (const Problem& problem : error.problems()) problems.push_back(problem);
    }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
}

}  // namespace grit
