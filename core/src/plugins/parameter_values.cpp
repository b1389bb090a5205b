#include "plugins/parameter_values.hpp"

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace grit {
namespace {

using Written = std::optional<Description>;

template <class T>
Written value_of(const T* value) {
  return Description(*value);
}
Written value_of(const std::optional<double>* value) {
  if (*value) return Description(**value);
  return std::nullopt;
}
Written value_of(const Vec3* value) { return Description{value->x(), value->y(), value->z()}; }
Written value_of(const std::optional<Vec3>* value) {
  if (*value) return value_of(&**value);
  return std::nullopt;
}
Written value_of(const ObjectTarget& target) {
  Parameters inner;
  target.declare(inner);
  if (inner.choice() != nullptr && inner.choice()->type().empty()) return std::nullopt;
  return write(inner);
}
Written value_of(const OptionalTarget& target) {
  if (!target.present()) return std::nullopt;
  Parameters inner;
  target.declare(inner);
  return write(inner);
}
Written value_of(const ListTarget& target) {
  auto list = Description::array();
  for (std::size_t i = 0; i < target.size(); ++i) {
    Parameters inner;
    target.declare(i, inner);
    list.push_back(write(inner));
  }
  return list;
}
Written value_of(const MapTarget& target) {
  auto map = Description::object();
  for (const auto& name : target.names()) {
    Parameters inner;
    target.declare(name, inner);
    map[name] = write(inner);
  }
  return map;
}

// ---- setting

template <class T>
void set(T* place, const Description& value) {
  *place = value.get<T>();
}
void set(std::optional<double>* place, const Description& value) { *place = value.get<double>(); }
void set(Vec3* place, const Description& value) {
  for (int k = 0; k < 3; ++k) (*place)[k] = value.at(static_cast<std::size_t>(k)).get<double>();
}
void set(std::optional<Vec3>* place, const Description& value) { set(&place->emplace(), value); }
void set(Description* place, const Description& value) { *place = value; }
void set(const ObjectTarget& target, const Description& value) {
  Parameters inner;
  target.declare(inner);
  assign(inner, value);
}
void set(const OptionalTarget& target, const Description& value) {
  Parameters inner;
  target.present() ? target.declare(inner) : target.create(inner);
  assign(inner, value);
}
void set(const ListTarget& target, const Description& value) {
  const bool stays = target.size() == value.size();
  if (!stays) target.clear();
  for (std::size_t i = 0; i < value.size(); ++i) {
    Parameters inner;
    stays ? target.declare(i, inner) : target.append(inner);
    assign(inner, value[i]);
  }
}
void set(const MapTarget& target, const Description& value) {
  const auto names = target.names();
  const bool stays = names.size() == value.size() &&
                     std::ranges::all_of(names, [&](const std::string& name) { return value.contains(name); });
  if (!stays) target.clear();
  for (const auto& [name, one] : value.items()) {
    Parameters inner;
    stays ? target.declare(name, inner) : target.insert(name, inner);
    assign(inner, one);
  }
}

/// Values that write() omits: absent optional ones, lists below their minimum length, choices not made.
template <class T>
void leave_out(const T&) {}
void leave_out(std::optional<double>* place) { place->reset(); }
void leave_out(std::optional<Vec3>* place) { place->reset(); }
void leave_out(std::vector<double>* place) { place->clear(); }
void leave_out(std::vector<std::string>* place) { place->clear(); }
void leave_out(const OptionalTarget& target) { target.remove(); }
void leave_out(const ListTarget& target) { target.clear(); }
void leave_out(const MapTarget& target) { target.clear(); }

// ---- single numbers

/// The keys that are left to follow, and where to note what the number is declared with.
struct Path {
  std::span<const std::string> keys;
  Declared* declared;

  bool ends() const { return keys.empty(); }
  const std::string& first() const { return keys.front(); }
  Path rest() const { return {keys.subspan(1), declared}; }
};
using Found = std::optional<NumberPlace>;

Found number_below(Parameters& parameters, Path path);

std::optional<std::size_t> index_of(const std::string& key, std::size_t size) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  if (error != std::errc() || end != key.data() + key.size() || index >= size) return std::nullopt;
  return index;
}
/// The index that a path ends with.
std::optional<std::size_t> last_index(Path path, std::size_t size) {
  return path.keys.size() == 1 ? index_of(path.first(), size) : std::nullopt;
}
Found found(NumberPlace::Place place) { return NumberPlace(place); }

Found number_in(Description& value, Path path) {
  if (path.ends()) return value.is_number() ? found(&value) : std::nullopt;
  if (value.is_array())
    if (const auto i = index_of(path.first(), value.size())) return number_in(value[*i], path.rest());
  if (!value.is_object() || !value.contains(path.first())) return std::nullopt;
  return number_in(value[path.first()], path.rest());
}

template <class T>
Found number_in(T*, Path) {
  return std::nullopt;
}
Found number_in(double* value, Path path) { return path.ends() ? found(value) : std::nullopt; }
Found number_in(std::int64_t* value, Path path) { return path.ends() ? found(value) : std::nullopt; }
Found number_in(std::optional<double>* value, Path path) {
  return path.ends() && *value ? found(&**value) : std::nullopt;
}
Found number_in(Vec3* value, Path path) {
  const auto i = last_index(path, 3);
  return i ? found(&(*value)[static_cast<int>(*i)]) : std::nullopt;
}
Found number_in(std::optional<Vec3>* value, Path path) { return *value ? number_in(&**value, path) : std::nullopt; }
Found number_in(std::vector<double>* value, Path path) {
  const auto i = last_index(path, value->size());
  return i ? found(&(*value)[*i]) : std::nullopt;
}
Found number_in(Description* value, Path path) { return number_in(*value, path); }
Found number_in(const ObjectTarget& target, Path path) {
  Parameters inner;
  target.declare(inner);
  return number_below(inner, path);
}
Found number_in(const OptionalTarget& target, Path path) {
  if (!target.present()) return std::nullopt;
  Parameters inner;
  target.declare(inner);
  return number_below(inner, path);
}
Found number_in(const ListTarget& target, Path path) {
  const auto i = path.ends() ? std::nullopt : index_of(path.first(), target.size());
  if (!i) return std::nullopt;
  Parameters inner;
  target.declare(*i, inner);
  return number_below(inner, path.rest());
}
Found number_in(const MapTarget& target, Path path) {
  const auto names = target.names();
  if (path.ends() || std::ranges::find(names, path.first()) == names.end()) return std::nullopt;
  Parameters inner;
  target.declare(path.first(), inner);
  return number_below(inner, path.rest());
}

Found number_below(Parameters& parameters, Path path) {
  if (path.ends()) return std::nullopt;
  if (Choice* const choice = parameters.choice(); choice != nullptr && !choice->type().empty())
    choice->declare(parameters);
  if (path.declared != nullptr) {
    path.declared->parameter.reset();  // of the object around
    for (const Check& check : parameters.checks()) path.declared->checks.push_back(check);
  }
  for (const auto& parameter : parameters.entries())
    if (parameter.name() == path.first()) {
      if (path.declared != nullptr) path.declared->parameter = parameter;
      return std::visit([&](const auto& target) { return number_in(target, path.rest()); }, parameter.target());
    }
  if (Description* const values = parameters.values()) return number_in(*values, path);
  return std::nullopt;
}

}  // namespace

Description write(Parameters& parameters) {
  auto object = Description::object();
  if (Choice* const choice = parameters.choice(); choice != nullptr && !choice->type().empty()) {
    object["type"] = choice->type();
    choice->declare(parameters);
  }
  for (const auto& parameter : parameters.entries())
    if (auto value = write(parameter)) object[parameter.name()] = *std::move(value);
  if (const Description* const values = parameters.values())
    for (const auto& [key, value] : values->items()) object[key] = value;
  return object;
}

std::optional<Description> write(const Parameter& parameter) {
  auto value = std::visit([](const auto& target) { return value_of(target); }, parameter.target());
  // A list below its minimum length was not given.
  if (value && value->is_structured() && value->size() < parameter.least_entries()) return std::nullopt;
  return value;
}

void assign(Parameters& parameters, const Description& values) {
  if (Choice* const choice = parameters.choice()) {
    const auto type = values.find("type");
    if (type != values.end() && *type != choice->type()) choice->choose(type->get<std::string>());
    if (!choice->type().empty()) choice->declare(parameters);
  }
  for (const auto& parameter : parameters.entries()) {
    const auto value = values.find(parameter.name());
    std::visit([&](const auto& target) { value != values.end() ? set(target, *value) : leave_out(target); },
               parameter.target());
  }
}

void NumberPlace::set(double value) const {
  std::visit(
      [&]<class T>(T* place) {
        if constexpr (std::same_as<T, Description>) {
          if (place->is_number_integer()) *place = static_cast<std::int64_t>(value);
          else *place = value;
        } else {
          *place = static_cast<T>(value);
        }
      },
      place_);
}

double NumberPlace::get() const {
  return std::visit(
      []<class T>(T* place) {
        if constexpr (std::same_as<T, Description>) return place->template get<double>();
        else return static_cast<double>(*place);
      },
      place_);
}

bool NumberPlace::is_integer() const {
  if (const auto* const value = std::get_if<Description*>(&place_)) return (*value)->is_number_integer();
  return std::holds_alternative<std::int64_t*>(place_);
}

std::optional<NumberPlace> find_number(Parameters& parameters, std::span<const std::string> keys, Declared* declared) {
  return number_below(parameters, {keys, declared});
}

}  // namespace grit
