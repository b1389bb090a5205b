#include "input/writer.hpp"

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

}  // namespace

Description write(Parameters& parameters) {
  auto object = Description::object();
  if (Choice* const choice = parameters.choice(); choice != nullptr && !choice->type().empty()) {
    object["type"] = choice->type();
    choice->declare(parameters);
  }
  for (const auto& parameter : parameters.entries())
    if (auto value = write(parameter)) object[parameter.name()] = *std::move(value);
  return object;
}

std::optional<Description> write(const Parameter& parameter) {
  auto value = std::visit([](const auto& target) { return value_of(target); }, parameter.target());
  // A list that is shorter than it may be was not given.
  if (value && value->is_structured() && value->size() < parameter.least_entries()) return std::nullopt;
  return value;
}

}  // namespace grit
