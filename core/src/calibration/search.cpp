#include "calibration/search.hpp"

#include <algorithm>
#include <exception>
#include <nlopt.hpp>
#include <optional>
#include <vector>

namespace grit {
namespace {

/// Misfit of a trial that failed, over the worst of the others; and without any.
constexpr double worse = 2, bad = 1e3;

/// BOBYQA needs two parameters.
nlopt::algorithm algorithm_of(const std::string& name, std::size_t parameters) {
  if (name == "crs") return nlopt::GN_CRS2_LM;
  return name == "cobyla" || parameters == 1 ? nlopt::LN_COBYLA : nlopt::LN_BOBYQA;
}

/// What NLopt evaluates. An exception must not pass through its C code.
struct Objective {
  Trials& trials;
  std::size_t most;
  nlopt::opt& optimizer;
  std::optional<SearchEnd> end{};
  std::exception_ptr thrown{};

  double misfit_at(const std::vector<double>& place) {
    // Not all algorithms stop at once: crs evaluates its whole first population.
    if (end || thrown) return bad;
    const std::size_t index = trials.at(
        Eigen::Map<const Eigen::VectorXd>(place.data(), static_cast<Eigen::Index>(place.size())), TrialPurpose::search);
    const Trial& trial = trials.all()[index];
    if (trials.fits(trial)) end = SearchEnd::fits;
    else if (trials.all().size() >= most) end = SearchEnd::trials;
    if (end) optimizer.force_stop();
    if (!trial.failed()) return trials.misfit(trial);
    double worst = 0;
    for (const Trial& other : trials.all())
      if (!other.failed()) worst = std::max(worst, trials.misfit(other));
    return worst > 0 ? worse * worst : bad;
  }

  static double call(const std::vector<double>& place, std::vector<double>&, void* data) {
    auto& self = *static_cast<Objective*>(data);
    try {
      return self.misfit_at(place);
    } catch (...) {
      self.thrown = std::current_exception();
      self.optimizer.force_stop();
      return bad;
    }
  }
};

/// One search from a place, with this first step. Nothing if its steps became small.
std::optional<SearchEnd> search_from(Trials& trials, const OptimizerDescription& description, std::vector<double> place,
                                     double step) {
  nlopt::opt optimizer(algorithm_of(description.algorithm, place.size()), static_cast<unsigned>(place.size()));
  Objective objective{trials, static_cast<std::size_t>(description.trials), optimizer};
  optimizer.set_min_objective(Objective::call, &objective);
  optimizer.set_lower_bounds(0);
  optimizer.set_upper_bounds(1);
  optimizer.set_initial_step(step);
  optimizer.set_xtol_abs(description.resolution);
  // Places that are known cost nothing, but the search must not go on among them for ever.
  optimizer.set_maxeval(static_cast<int>(10 * description.trials));
  try {
    double least = 0;
    optimizer.optimize(place, least);
  } catch (const nlopt::forced_stop&) {
    // The objective says why.
  } catch (const nlopt::roundoff_limited&) {
    // No smaller step makes a difference.
  } catch (const std::runtime_error&) {
    // BOBYQA gives up where scatter hides the effect of its steps.
  }
  if (objective.thrown) std::rethrow_exception(objective.thrown);
  return objective.end;
}

}  // namespace

const char* sentence_of(SearchEnd end) {
  switch (end) {
    case SearchEnd::fits:
      return "the targets are met";
    case SearchEnd::trials:
      return "the trials are used up";
    case SearchEnd::resolution:
      return "its steps are below the resolution";
  }
  return "";
}

SearchEnd search(Trials& trials, const OptimizerDescription& description, double step) {
  nlopt::srand(1);  // the population of crs
  std::vector<double> place;
  for (const ParameterDescription& parameter : trials.parameters())
    place.push_back(std::clamp(parameter.place(parameter.first_value()), 0.0, 1.0));
  if (!trials.all_failed()) {
    const Trial& best = trials.all()[trials.best()];
    place.assign(best.place.begin(), best.place.end());
  }
  return search_from(trials, description, place, step).value_or(SearchEnd::resolution);
}

}  // namespace grit
