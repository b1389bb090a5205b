// Parameters declared once. From one declaration come reading, checking, the schema, `grit describe`, the reference
// pages, and the defaults written into the results.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "grit/vec.hpp"

namespace grit {

/// A description as JSON; see grit/description.hpp.
using Description = nlohmann::ordered_json;

class Parameters;

/// Something with parameters of its own: an object in a description.
template <class T>
concept Declarable = requires(T& object, Parameters& parameters) {
  object.declare(parameters);
};

/// An object whose kind a description chooses by its key "type": a plugin, or one of a few built-in variants.
class Choice {
 public:
  virtual ~Choice() = default;
  /// What is chosen, for messages: "contact law", "size distribution".
  virtual std::string what() const = 0;
  /// All names that may be chosen, sorted.
  virtual std::vector<std::string> types() const = 0;
  /// The chosen name; empty before a choice.
  virtual std::string type() const = 0;
  /// Chooses `type`, one of types(), with all parameters at their defaults. Throws grit::Error if it cannot be had.
  virtual void choose(const std::string& type) = 0;
  /// Declares the parameters of what was chosen.
  virtual void declare(Parameters& parameters) = 0;
  /// An unchosen twin, for the schema and the reference pages.
  virtual std::unique_ptr<Choice> twin() const = 0;
};

/// A nested object.
struct ObjectTarget {
  std::function<void(Parameters&)> declare;
};

/// An object that may be left out.
struct OptionalTarget {
  std::function<bool()> present;
  std::function<void(Parameters&)> create;   // makes it, with defaults, and declares it
  std::function<void(Parameters&)> declare;  // of the one that is present
  std::function<void()> remove;
};

/// A list of objects.
struct ListTarget {
  std::function<std::size_t()> size;
  std::function<void()> clear;
  std::function<void(Parameters&)> append;
  std::function<void(std::size_t, Parameters&)> declare;
};

/// Objects by name; names are the user's.
struct MapTarget {
  std::function<std::vector<std::string>()> names;
  std::function<void()> clear;
  std::function<void(const std::string&, Parameters&)> insert;
  std::function<void(const std::string&, Parameters&)> declare;
};

using Target = std::variant<double*, std::optional<double>*, std::int64_t*, bool*, std::string*, Vec3*,
                            std::optional<Vec3>*, std::array<bool, 3>*, std::vector<double>*, std::vector<std::string>*,
                            Description*, ObjectTarget, OptionalTarget, ListTarget, MapTarget>;

/// One declared parameter. The setters return the parameter itself, so that a declaration reads as one sentence.
class Parameter {
 public:
  Parameter(std::string name, Target target) : name_(std::move(name)), target_(std::move(target)) {}

  /// SI unit in UDUNITS spelling; "1" (the default) is dimensionless. Angles are "rad".
  Parameter& unit(std::string unit) { return unit_ = std::move(unit), *this; }
  /// The field's symbol, e.g. "E_c".
  Parameter& symbol(std::string symbol) { return symbol_ = std::move(symbol), *this; }
  /// One line.
  Parameter& doc(std::string doc) { return doc_ = std::move(doc), *this; }
  Parameter& required() { return required_ = true, *this; }
  Parameter& at_least(double bound) { return low_ = bound, low_open_ = false, *this; }
  Parameter& above(double bound) { return low_ = bound, low_open_ = true, *this; }
  Parameter& at_most(double bound) { return high_ = bound, high_open_ = false, *this; }
  Parameter& below(double bound) { return high_ = bound, high_open_ = true, *this; }
  /// The strings that are allowed.
  Parameter& one_of(std::vector<std::string> choices) { return choices_ = std::move(choices), *this; }
  /// The text is the path of a file to read. A relative one starts where the description that says it lies; reading
  /// makes it absolute.
  Parameter& file() { return file_ = true, *this; }
  /// How many entries a list must have at least.
  Parameter& entries(std::size_t least) { return least_entries_ = least, *this; }

  const std::string& name() const { return name_; }
  const Target& target() const { return target_; }
  const std::string& unit() const { return unit_; }
  const std::string& symbol() const { return symbol_; }
  const std::string& doc() const { return doc_; }
  bool is_required() const { return required_; }
  double low() const { return low_; }
  double high() const { return high_; }
  bool low_is_open() const { return low_open_; }
  bool high_is_open() const { return high_open_; }
  const std::vector<std::string>& choices() const { return choices_; }
  bool is_file() const { return file_; }
  std::size_t least_entries() const { return least_entries_; }
  /// Whether `value` (SI) lies in the declared range. A value that is not finite never does.
  bool allows(double value) const {
    return value - value == 0 && (low_open_ ? value > low_ : value >= low_) &&
           (high_open_ ? value < high_ : value <= high_);
  }

 private:
  std::string name_;
  Target target_;
  std::string unit_ = "1", symbol_, doc_;
  bool required_ = false, file_ = false, low_open_ = false, high_open_ = false;
  double low_ = -std::numeric_limits<double>::infinity(), high_ = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices_;
  std::size_t least_entries_ = 0;
};

/// Reports a problem that lies between parameters: the key at fault ("" for the whole object, "wall/motion" for what
/// lies deeper), what was found, what is allowed.
using Complain = std::function<void(std::string_view key, std::string_view found, std::string_view allowed)>;

/// What must hold between the parameters of one object.
struct Check {
  std::function<void(const Complain&)> run;
  std::vector<std::string> about;  // keys; none: all of the object
  bool despite_problems = false;   // runs in any case; complaints where a problem is known already are dropped
};

/// The declarations of one object, in the order in which they are read.
class Parameters {
 public:
  /// Declares a number, flag, text, vector or list held in `member`; its present value is the default. The member must
  /// outlive this object.
  template <class T>
  requires(!Declarable<T> && !std::derived_from<T, Choice>) Parameter& add(std::string name, T& member) {
    return entries_.emplace_back(std::move(name), Target(&member));
  }
  /// Declares a nested object whose key "type" makes the choice.
  Parameter& add(std::string name, Choice& member) {
    return entries_.emplace_back(std::move(name), ObjectTarget{[&member](Parameters& p) { p.choose(member); }});
  }
  /// Declares a nested object.
  template <Declarable T>
  requires(!std::derived_from<T, Choice>) Parameter& add(std::string name, T& member) {
    return entries_.emplace_back(std::move(name), ObjectTarget{[&member](Parameters& p) { member.declare(p); }});
  }
  /// Declares an object that may be left out.
  template <Declarable T>
  Parameter& add(std::string name, std::optional<T>& member) {
    return entries_.emplace_back(
        std::move(name),
        OptionalTarget{[&member] { return member.has_value(); },
                       [&member](Parameters& p) { member.emplace().declare(p); },
                       [&member](Parameters& p) { member->declare(p); }, [&member] { member.reset(); }});
  }
  /// Says that the key "type" of this very object makes a choice, and that the parameters of what is chosen stand
  /// beside those declared here. Whoever reads or writes the object lets the choice declare them once it is made.
  void choose(Choice& choice) { choice_ = &choice; }

  /// Declares a list of objects.
  template <Declarable T>
  Parameter& add(std::string name, std::deque<T>& member) {
    return entries_.emplace_back(std::move(name),
                                 ListTarget{[&member] { return member.size(); }, [&member] { member.clear(); },
                                            [&member](Parameters& p) { member.emplace_back().declare(p); },
                                            [&member](std::size_t i, Parameters& p) { member[i].declare(p); }});
  }
  /// Declares objects by name. `make` gives a new entry; by default it is default-constructed.
  template <Declarable T>
  Parameter& add(
      std::string name, std::map<std::string, T>& member,
      std::type_identity_t<std::function<T(const std::string&)>> make = [](const std::string&) { return T(); }) {
    auto names = [&member] {
      std::vector<std::string> result;
      for (const auto& entry : member) result.push_back(entry.first);
      return result;
    };
    auto insert = [&member, make = std::move(make)](const std::string& key, Parameters& p) {
      member.insert_or_assign(key, make(key)).first->second.declare(p);
    };
    return entries_.emplace_back(
        std::move(name), MapTarget{names, [&member] { member.clear(); }, insert,
                                   [&member](const std::string& key, Parameters& p) { member.at(key).declare(p); }});
  }
  /// Declares something that none of the above fits.
  Parameter& add_target(std::string name, Target target) {
    return entries_.emplace_back(std::move(name), std::move(target));
  }
  /// Says that further keys of this object cannot be known, so that nobody calls them unknown.
  void leave_open() { open_ = true; }
  /// Adds a check that runs after the keys `about` were read without a problem; without keys, after the whole object
  /// was.
  void check(std::function<void(const Complain&)> check, std::vector<std::string> about = {}) {
    checks_.push_back({std::move(check), std::move(about)});
  }
  /// Adds a check of names that refer to others. It runs whatever problems there are, so it must bear values that were
  /// not read; what it says of those is not heard.
  void check_names(std::function<void(const Complain&)> check) { checks_.push_back({std::move(check), {}, true}); }

  /// Adds a call that a reader makes once the object was read and checked without a problem.
  void when_read(std::function<void()> call) { when_read_.push_back(std::move(call)); }
  /// Says that the object also has these values, in SI, of parameters that are declared elsewhere: those of a component
  /// that is described and not alive. A writer adds them. They must outlive this object.
  void add_values(Description& values) { values_ = &values; }

  Choice* choice() const { return choice_; }
  const std::deque<Parameter>& entries() const { return entries_; }
  const std::vector<Check>& checks() const { return checks_; }
  bool is_open() const { return open_; }
  const std::vector<std::function<void()>>& calls_when_read() const { return when_read_; }
  /// Null if there are none.
  Description* values() const { return values_; }

 private:
  Choice* choice_ = nullptr;
  Description* values_ = nullptr;
  bool open_ = false;
  std::deque<Parameter> entries_;  // a deque keeps references valid while it grows
  std::vector<Check> checks_;
  std::vector<std::function<void()>> when_read_;
};

/// A choice among built-in variants. Each T has `static constexpr const char* type_name` and declare().
template <class... T>
class OneOf : public Choice {
 public:
  explicit OneOf(std::string what) : what_(std::move(what)) {}
  std::string what() const override { return what_; }
  std::vector<std::string> types() const override { return {T::type_name...}; }
  std::string type() const override {
    return std::visit(
        []<class V>(const V&) -> std::string {
          if constexpr (std::same_as<V, std::monostate>) return "";
          else return V::type_name;
        },
        value_);
  }
  void choose(const std::string& type) override {
    ((type == T::type_name ? void(value_.template emplace<T>()) : void()), ...);
  }
  void declare(Parameters& parameters) override {
    std::visit(
        [&]<class V>(V& value) {
          if constexpr (!std::same_as<V, std::monostate>) value.declare(parameters);
        },
        value_);
  }
  std::unique_ptr<Choice> twin() const override { return std::make_unique<OneOf>(what_); }
  const std::variant<std::monostate, T...>& value() const { return value_; }
  std::variant<std::monostate, T...>& value() { return value_; }

 private:
  std::string what_;
  std::variant<std::monostate, T...> value_;
};

}  // namespace grit
