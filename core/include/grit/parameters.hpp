// Parameters of components and of the description. Each is declared once; reading, checking, the JSON schema,
// `grit describe`, the reference pages and the values written to the results follow from the declaration.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "grit/vec.hpp"

namespace grit {

/// One degree [rad].
inline constexpr double degree = std::numbers::pi / 180;

/// A description as JSON; see grit/description.hpp.
using Description = nlohmann::ordered_json;

class Parameters;

/// A type with its own parameters: an object in a description.
template <class T>
concept Declarable = requires(T& object, Parameters& parameters) {
  object.declare(parameters);
};

/// An object whose type is chosen by the key "type" of the description: a plugin or a built-in variant.
class Choice {
 public:
  virtual ~Choice() = default;
  /// The kind of object, for messages: "contact law", "size distribution".
  virtual std::string what() const = 0;
  /// All available types, sorted.
  virtual std::vector<std::string> types() const = 0;
  /// One line about an available type.
  virtual std::string type_doc(const std::string& type) const = 0;
  /// How to add types, for messages about unknown ones: "searched: …"; empty if there is no way.
  virtual std::string how_to_add() const { return {}; }
  /// The chosen type; empty before a choice.
  virtual std::string type() const = 0;
  /// Chooses `type`, one of types(), with all parameters at their defaults. Throws grit::Error if it is not available.
  virtual void choose(const std::string& type) = 0;
  /// Declares the parameters of the chosen type.
  virtual void declare(Parameters& parameters) = 0;
  /// A copy without a choice, for the schema and the reference pages.
  virtual std::unique_ptr<Choice> twin() const = 0;
};

/// A nested object.
struct ObjectTarget {
  std::function<void(Parameters&)> declare;
};

/// An optional object.
struct OptionalTarget {
  std::function<bool()> present;
  std::function<void(Parameters&)> create;   // creates it with defaults and declares its parameters
  std::function<void(Parameters&)> declare;  // declares the parameters of the present object
  std::function<void()> remove;
};

/// A list of objects.
struct ListTarget {
  std::function<std::size_t()> size;
  std::function<void()> clear;
  std::function<void(Parameters&)> append;
  std::function<void(std::size_t, Parameters&)> declare;
};

/// Objects by names that the user chooses.
struct MapTarget {
  std::function<std::vector<std::string>()> names;
  std::function<void()> clear;
  std::function<void(const std::string&, Parameters&)> insert;
  std::function<void(const std::string&, Parameters&)> declare;
};

using Target = std::variant<double*, std::optional<double>*, std::int64_t*, bool*, std::string*, Vec3*,
                            std::optional<Vec3>*, std::array<bool, 3>*, std::vector<double>*, std::vector<std::string>*,
                            Description*, ObjectTarget, OptionalTarget, ListTarget, MapTarget>;

/// One declared parameter. The setters return the parameter itself, so that calls can be chained.
class Parameter {
 public:
  Parameter(std::string name, Target target) : name_(std::move(name)), target_(std::move(target)) {}

  /// SI unit in UDUNITS spelling; "1" (the default) is dimensionless. Angles are "rad".
  Parameter& unit(std::string unit) { return unit_ = std::move(unit), *this; }
  /// Usual symbol, e.g. "E_c".
  Parameter& symbol(std::string symbol) { return symbol_ = std::move(symbol), *this; }
  /// Description for users, one line.
  Parameter& doc(std::string doc) { return doc_ = std::move(doc), *this; }
  Parameter& required() { return required_ = true, *this; }
  Parameter& at_least(double bound) { return low_ = bound, low_open_ = false, *this; }
  Parameter& above(double bound) { return low_ = bound, low_open_ = true, *this; }
  Parameter& at_most(double bound) { return high_ = bound, high_open_ = false, *this; }
  Parameter& below(double bound) { return high_ = bound, high_open_ = true, *this; }
  /// Allowed strings.
  Parameter& one_of(std::vector<std::string> choices) { return choices_ = std::move(choices), *this; }
  /// The string is the path of a file to read. A relative path starts in the folder of the description that contains
  /// it; reading makes it absolute.
  Parameter& file() { return file_ = true, *this; }
  /// Minimum number of entries of a list.
  Parameter& entries(std::size_t least) { return least_entries_ = least, *this; }

  const std::string& name() const { return name_; }
  const Target& target() const { return target_; }
  Target& target() { return target_; }
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
  /// Whether `value` (SI) is finite and in the declared range.
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

/// Reports a problem of one or several parameters: the key at fault ("" for the whole object, "wall/motion" for a
/// nested one), the value found and the allowed values. The message is that of fault_text().
using Complain = std::function<void(std::string_view key, std::string_view found, std::string_view allowed)>;

/// A condition on several parameters of one object.
struct Check {
  std::function<void(const Complain&)> run;
  std::vector<std::string> about;  // keys; empty: the whole object
  bool despite_problems = false;   // always runs; complaints about keys with known problems are dropped
};

/// The declarations of one object, in the order in which they are read.
class Parameters {
 public:
  /// Declares a number, flag, string, vector or list held in `member`. Its present value is the default. The member
  /// must outlive this object.
  template <class T>
  requires(!Declarable<T> && !std::derived_from<T, Choice>) Parameter& add(std::string name, T& member) {
    return entries_.emplace_back(std::move(name), Target(&member));
  }
  /// Declares a nested object whose type is chosen by its key "type".
  Parameter& add(std::string name, Choice& member) {
    return entries_.emplace_back(std::move(name), ObjectTarget{[&member](Parameters& p) { p.choose(member); }});
  }
  /// Declares a nested object.
  template <Declarable T>
  requires(!std::derived_from<T, Choice>) Parameter& add(std::string name, T& member) {
    return entries_.emplace_back(std::move(name), ObjectTarget{[&member](Parameters& p) { member.declare(p); }});
  }
  /// Declares an optional object.
  template <Declarable T>
  Parameter& add(std::string name, std::optional<T>& member) {
    return entries_.emplace_back(
        std::move(name),
        OptionalTarget{[&member] { return member.has_value(); },
                       [&member](Parameters& p) { member.emplace().declare(p); },
                       [&member](Parameters& p) { member->declare(p); }, [&member] { member.reset(); }});
  }
  /// Declares that the key "type" of this object makes a choice. The parameters of the chosen type are keys of this
  /// object too; readers and writers have them declared after the choice.
  void choose(Choice& choice) { choice_ = {std::shared_ptr<void>(), &choice}; }
  /// The same of a choice that this object keeps.
  void choose(std::shared_ptr<Choice> choice) { choice_ = std::move(choice); }

  /// Declares a list of objects.
  template <Declarable T>
  Parameter& add(std::string name, std::deque<T>& member) {
    return entries_.emplace_back(std::move(name),
                                 ListTarget{[&member] { return member.size(); }, [&member] { member.clear(); },
                                            [&member](Parameters& p) { member.emplace_back().declare(p); },
                                            [&member](std::size_t i, Parameters& p) { member[i].declare(p); }});
  }
  /// Declares named objects. `make` creates a new entry; the default is its default constructor.
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
  /// Declares a parameter of any other target.
  Parameter& add_target(std::string name, Target target) {
    return entries_.emplace_back(std::move(name), std::move(target));
  }
  /// Allows further keys in this object, which are not reported as unknown.
  void leave_open() { open_ = true; }
  /// Keys of this object in a file that are resolved before it is read, e.g. "extends". Messages list them.
  void resolved_before(std::vector<std::string> keys) { resolved_before_ = std::move(keys); }
  /// Adds a check. It runs if the keys `about` were read without a problem; without keys, if the whole object was.
  void check(std::function<void(const Complain&)> check, std::vector<std::string> about = {}) {
    checks_.push_back({std::move(check), std::move(about)});
  }
  /// Adds a check of names that refer to other objects. It always runs, so it must tolerate parameters that could not
  /// be read; its complaints about those are dropped.
  void check_names(std::function<void(const Complain&)> check) { checks_.push_back({std::move(check), {}, true}); }

  /// Adds a function that is called after the object was read and checked without a problem.
  void when_read(std::function<void()> call) { when_read_.push_back(std::move(call)); }
  /// Adds values, in SI, of parameters that are declared elsewhere: those of a component that is described but not
  /// created. Writers add them to the object. They must outlive this object.
  void add_values(Description& values) { values_ = &values; }

  Choice* choice() const { return choice_.get(); }
  const std::deque<Parameter>& entries() const { return entries_; }
  std::deque<Parameter>& entries() { return entries_; }
  const std::vector<Check>& checks() const { return checks_; }
  std::vector<Check>& checks() { return checks_; }
  bool is_open() const { return open_; }
  const std::vector<std::string>& keys_resolved_before() const { return resolved_before_; }
  const std::vector<std::function<void()>>& calls_when_read() const { return when_read_; }
  std::vector<std::function<void()>>& calls_when_read() { return when_read_; }
  /// Null if there are none.
  Description* values() const { return values_; }

 private:
  std::shared_ptr<Choice> choice_;
  Description* values_ = nullptr;
  bool open_ = false;
  std::vector<std::string> resolved_before_;
  std::deque<Parameter> entries_;  // a deque keeps references valid while it grows
  std::vector<Check> checks_;
  std::vector<std::function<void()>> when_read_;
};

/// A choice of built-in variants. Each T has `static constexpr const char *type_name, *type_doc` and declare().
template <class... T>
class OneOf : public Choice {
 public:
  explicit OneOf(std::string what) : what_(std::move(what)) {}
  std::string what() const override { return what_; }
  std::vector<std::string> types() const override { return {T::type_name...}; }
  std::string type_doc(const std::string& type) const override {
    std::string doc;
    ((type == T::type_name ? void(doc = T::type_doc) : void()), ...);
    return doc;
  }
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
