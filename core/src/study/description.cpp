#include "study/description.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "input/reader.hpp"

namespace grit {
namespace {

/// Up to here each whole number is a double of its own.
constexpr double largest_seed = 1e15;

/// A value as people would write it: texts without quotes.
std::string plain(const Description& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const auto& one : value) text += (text.empty() ? "" : " ") + plain(one);
  return text;
}

/// A pointer, and where in the study it stands.
struct Changed {
  std::string pointer, where;
};

/// Whether what the first pointer changes has all that the second does.
bool covers(const std::string& one, const std::string& other) { return (other + '/').starts_with(one + '/'); }

/// What is changed twice has the value of the last, and a chart of it is of runs that do not differ.
void check_pointers(const StudyDescription& study, const Complain& complain) {
  std::vector<Changed> varied;
  for (const auto& [name, setting] : study.settings)
    for (std::size_t i = 0; i < setting.pointers.size(); ++i)
      varied.push_back({setting.pointers[i], fmt::format("settings/{}/pointers/{}", name, i)});
  varied.push_back({study.seeds.pointer, "seeds/pointer"});
  for (std::size_t i = 0; i < varied.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (covers(varied[i].pointer, varied[k].pointer) || covers(varied[k].pointer, varied[i].pointer))
        complain(varied[i].where,
                 fmt::format("{}, of which /{} changes {}", varied[i].pointer, varied[k].where, varied[k].pointer),
                 "what no other setting and no seed changes");
}

}  // namespace

void MeanFigure::declare(Parameters& p) {
  p.add("share", share).above(0).at_most(1).doc("of the abscissa's range, at its end, that the mean is taken over");
}
void ValueFigure::declare(Parameters& p) {
  p.add("at", at).required().doc("abscissa at which the curve is read, in the channel's own unit");
}
void FigureDescription::declare(Parameters& p) {
  p.choose(what);
  p.add("of", of).required().doc("channel: probe's name, slash, name of the channel");
  p.add("against", against)
      .doc(
          "channel of the abscissa; left out: time, or the place in a profile. Where it goes back, a curve has what it "
          "passes for the first time");
  p.add("scale", scale).above(0).doc("what errors are divided by; left out: the largest of the reference");
  p.add("value", value).doc("what it should be; left out: what the finest settings give");
  p.add("curve", curve).doc("what the curve should be; left out: what the finest settings give");
  p.check([this](const Complain& complain) {
    check_channel(of, "of", complain), check_channel(against, "against", complain);
    if (value && is_curve()) complain("value", "one value for a curve", "a reference curve, or neither");
    if (value == 0.0 && !scale)
      complain("value", "0 without a scale", "a scale as well, to which errors can be put in relation");
    if (curve && !is_curve()) complain("curve", "a curve for one value", "a reference value, or neither");
  });
}
bool FigureDescription::is_curve() const {
  return std::holds_alternative<CurveFigure>(what.value()) || std::holds_alternative<ProfileFigure>(what.value());
}

void SettingDescription::declare(Parameters& p) {
  p.add("about", about).doc("what it means, in a few words");
  p.add("pointers", pointers).required().entries(1).doc("JSON pointers of what it changes in the scene");
  p.add("values", values)
      .required()
      .doc("from the cheapest to the finest; with several pointers, a list of values for each level");
  p.add("labels", labels).doc("names of the levels; left out: the values themselves");
  p.add("usual", usual).doc("label of the level that counts while other settings vary; left out: the first");
  p.check(
      [this](const Complain& complain) {
        if (!values.is_array() || values.size() < 2) {
          complain("values", "not a list of two or more", "a list of values, the finest last");
          return;
        }
        if (pointers.size() > 1)
          for (std::size_t i = 0; i < values.size(); ++i)
            if (!values[i].is_array() || values[i].size() != pointers.size())
              complain("values/" + std::to_string(i), plain(values[i]),
                       "a list of " + std::to_string(pointers.size()) + " values, one for each pointer");
        if (!labels.empty() && labels.size() != values.size())
          complain("labels", std::to_string(labels.size()) + " labels", "one for each of the values, or none");
        for (std::size_t i = 0; i < levels(); ++i)
          for (std::size_t k = 0; k < i; ++k)
            if (label(i) == label(k)) complain("values", "the level \"" + label(i) + "\" twice", "different levels");
        if (!usual.empty() && usual_level() == levels()) {
          std::vector<std::string> all;
          for (std::size_t i = 0; i < levels(); ++i) all.push_back(label(i));
          complain("usual", '"' + usual + '"', fmt::format("one of the labels: {}", fmt::join(all, ", ")));
        }
      },
      {"pointers", "values", "labels", "usual"});
}
std::string SettingDescription::label(std::size_t level) const {
  return level < labels.size() ? labels[level] : plain(values[level]);
}
std::size_t SettingDescription::usual_level() const {
  std::size_t level = 0;
  while (!usual.empty() && level < levels() && label(level) != usual) ++level;
  return level;
}
std::vector<std::string> SettingDescription::sets(std::size_t level) const {
  std::vector<std::string> sets;
  for (std::size_t k = 0; k < pointers.size(); ++k)
    sets.push_back(pointers[k] + '=' + (pointers.size() > 1 ? values[level][k] : values[level]).dump());
  return sets;
}

void SeedsDescription::declare(Parameters& p) {
  p.add("pointer", pointer).doc("JSON pointer of the seed");
  p.add("values", values).entries(1).doc("seeds: each variant is run with all of them");
  p.check(
      [this](const Complain& complain) {
        for (std::size_t i = 0; i < values.size(); ++i)
          if (values[i] != std::floor(values[i]) || values[i] < 0 || values[i] > largest_seed ||
              std::count(values.begin(), values.end(), values[i]) > 1)
            complain("values/" + std::to_string(i), fmt::format("{}", values[i]),
                     fmt::format("different whole numbers from 0 to {}", largest_seed));
      },
      {"values"});
}

void StudyDescription::declare(Parameters& p) {
  p.add("title", title).doc("one line");
  p.add("scene", scene).file().required().doc("description that is run again and again");
  p.add("set", set).doc("values by JSON pointer that differ from the scene's in all runs");
  p.add("settings", settings).required().doc("what is varied, by name");
  p.add("vary", vary)
      .one_of({"one-at-a-time", "crossed"})
      .doc("each setting alone, the others as usual, and all at their finest; or every combination");
  p.add("seeds", seeds).doc("samples: their scatter is the floor below which accuracy buys nothing");
  p.add("figures", figures).required().doc("what counts, by name");
  p.add("tolerance", tolerance).above(0).doc("error that is good enough");
  p.add("advice", advice)
      .doc("whether 'grit advise' may go by it; false where settings are what the sand is, not how it is computed");
  p.check(
      [this](const Complain& complain) {
        if (!set.is_object()) complain("set", describe_value(set), "an object of values by JSON pointer");
        if (settings.empty()) complain("settings", "none", "at least one");
        if (figures.empty()) complain("figures", "none", "at least one");
      },
      {"set", "settings", "figures"});
  p.check([this](const Complain& complain) { check_pointers(*this, complain); }, {"settings", "seeds"});
}

StudyDescription load_study(const std::filesystem::path& path) {
  StudyDescription study;
  Parameters parameters;
  study.declare(parameters);
  read(Document::load(path), parameters);
  return study;
}

}  // namespace grit
