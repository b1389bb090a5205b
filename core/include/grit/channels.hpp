// Channels of a probe, and their values at one instant.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grit/error.hpp"

namespace grit {

/// One quantity that a probe returns at every sample.
struct Channel {
  std::string name;                ///< snake_case; also the name of the dataset in series.h5
  std::string unit;                ///< UDUNITS spelling, "1" if dimensionless
  std::string doc;                 ///< one line, with the sign convention
  std::vector<std::size_t> shape;  ///< of one sample: {} for a number, {n} for a list, …
  /// For a list: the channel of the same probe and shape with the coordinate of each number, e.g. "position" [m], or an
  /// angle ("rad" or "degree") for a list by direction. Empty: none.
  std::string coordinate = {};
  std::vector<std::string> components = {};  ///< component of each number, e.g. "xx"; as in Field
};

/// The values of a probe's channels at one instant, by name:
///
///     values["void_ratio"] = e;
///     std::ranges::copy(profile, values.list("profile").begin());
///
/// Names are looked up in a sorted index: get a list once, not in each iteration of a loop. The caller of
/// Probe::sample() calls clear() before it and check() after it.
class ChannelValues {
 public:
  /// `probe` names the probe in messages. Throws PluginError if two channels have the same name.
  ChannelValues(std::string probe, const std::vector<Channel>& channels) : probe_(std::move(probe)) {
    for (const Channel& channel : channels) {
      std::size_t size = 1;
      for (const std::size_t extent : channel.shape) size *= extent;
      places_.push_back({channel.name, numbers_.size(), size});
      index_.push_back(index_.size());
      numbers_.resize(numbers_.size() + size + 1);  // one more, to detect writing past the end
    }
    std::ranges::sort(index_, {}, [this](std::size_t i) { return std::string_view(places_[i].name); });
    for (std::size_t i = 1; i < index_.size(); ++i)
      if (const std::string& name = places_[index_[i]].name; name == places_[index_[i - 1]].name)
        throw PluginError(probe_ + " declares the channel \"" + name + "\" twice");
    for (const Place& place : places_) values_.emplace_back(&numbers_[place.first], place.size);
    clear();
  }
  ChannelValues(ChannelValues&&) = default;
  ChannelValues& operator=(ChannelValues&&) = default;

  /// The value of a channel with one number. Throws PluginError if there is no such channel or if it is a list.
  double& operator[](std::string_view channel) { return numbers_[single(channel).first]; }
  double operator[](std::string_view channel) const { return numbers_[single(channel).first]; }
  /// All numbers of a channel, the last index of its shape running fastest. Throws PluginError if there is no such
  /// channel.
  std::span<double> list(std::string_view channel) {
    const Place& place = find(channel);
    return {&numbers_[place.first], place.size};
  }
  std::span<const double> list(std::string_view channel) const { return values_[place_of(channel)]; }

  /// Marks all values as not written.
  void clear() { std::ranges::fill(numbers_, std::bit_cast<double>(unwritten)); }
  /// Throws PluginError if a value was not written, or if a value was written behind the end of a channel.
  void check() const {
    for (const Place& place : places_) {
      for (std::size_t i = 0; i < place.size; ++i)
        if (!is_written(place.first + i))
          throw PluginError(
              probe_ + " did not write " +
              (place.size == 1 ? "" : "value " + std::to_string(i + 1) + " of " + std::to_string(place.size) + " of ") +
              "channel \"" + place.name + "\"; a sample must write all values of all channels");
      if (is_written(place.first + place.size))
        throw PluginError(probe_ + " wrote behind the end of channel \"" + place.name + "\", which has " +
                          std::to_string(place.size) + (place.size == 1 ? " value" : " values"));
    }
  }
  /// Values of all channels, in the order of their declaration.
  std::span<const std::span<const double>> all() const { return values_; }

 private:
  struct Place {
    std::string name;
    std::size_t first, size;
  };
  // A NaN that no computation produces.
  static constexpr std::uint64_t unwritten = 0x7ff800000005ca1e;
  bool is_written(std::size_t i) const { return std::bit_cast<std::uint64_t>(numbers_[i]) != unwritten; }

  std::size_t place_of(std::string_view channel) const {
    const auto name = [this](std::size_t i) { return std::string_view(places_[i].name); };
    const auto found = std::ranges::lower_bound(index_, channel, {}, name);
    if (found != index_.end() && name(*found) == channel) return *found;
    std::string known;
    for (const Place& place : places_) known += (known.empty() ? "" : ", ") + place.name;
    throw PluginError(probe_ + " has no channel \"" + std::string(channel) + "\"; its channels are " +
                      (known.empty() ? "none" : known));
  }
  const Place& find(std::string_view channel) const { return places_[place_of(channel)]; }
  const Place& single(std::string_view channel) const {
    const Place& place = find(channel);
    if (place.size == 1) return place;
    throw PluginError(probe_ + ": channel \"" + place.name + "\" has " + std::to_string(place.size) +
                      " values; use list(\"" + place.name + "\")");
  }

  std::string probe_;
  std::vector<Place> places_;       // in the order of the channels
  std::vector<std::size_t> index_;  // of places_, by name
  std::vector<double> numbers_;
  std::vector<std::span<const double>> values_;
};

}  // namespace grit
