// Checks at compile time whether a struct is a contact law, with a message for each missing part. How to write a law is
// explained in law.hpp.
#pragma once

#include <algorithm>
#include <concepts>
#include <type_traits>

#include "grit/contact/contact_law.hpp"
#include "grit/contact/contact_point.hpp"
#include "grit/contact/lanes.hpp"
#include "grit/contact/law_traits.hpp"
#include "grit/parameters.hpp"

namespace grit {

namespace law_part {

template <class Law, class L>
using PairOf = typename Law::template Pair<L>;
template <class Law, class L>
using StateOf = typename Law::template State<L>;

template <class T>
concept declares = std::default_initializable<T> && Declarable<T>;
template <class Law>
concept settings = declares<typename Law::Settings>;
template <class Law>
concept material = declares<typename Law::Material>;
template <class Law>
concept interface = declares<typename Law::Interface>;

/// A struct of lanes only: with floats it has half the size that it has with doubles.
template <class Double, class Float>
concept lanes = std::is_trivially_copyable_v<Double> &&
    (std::is_empty_v<Double> || (sizeof(Double) % sizeof(double) == 0 && sizeof(Double) / 2 == sizeof(Float)));
template <class Law>
concept pair = lanes<PairOf<Law, double>, PairOf<Law, float>>;
template <class Law>
concept state = lanes<StateOf<Law, double>, StateOf<Law, float>>;
template <class Law>
concept stateless = std::is_empty_v<StateOf<Law, double>>;

template <class Law>
concept traits = std::same_as<std::remove_cvref_t<decltype(Law::traits)>, LawTraits> &&
    (Law::traits.losses || !Law::traits.losses);
template <class Law>
concept has_fields = std::same_as<std::remove_cvref_t<decltype(Law::fields[0])>, LawField>;

template <class Law>
consteval bool fields_cover_state() {
  std::size_t width = 0;
  for (const LawField& field : Law::fields) width += field.width;
  return width * sizeof(double) == sizeof(StateOf<Law, double>);
}
template <class Law>
consteval bool fields_name_features() {
  return std::ranges::all_of(Law::fields, [](const LawField& field) {
    return field.needed_by == always || (field.needed_by >> detail::feature_count<Law>) == 0;
  });
}

template <class Law>
consteval bool prerequisites_are_features() {
  return std::ranges::all_of(Law::traits.prerequisites,
                             [](unsigned bits) { return (bits >> detail::feature_count<Law>) == 0; });
}

template <class Law>
concept mix = requires(const typename Law::Settings& settings, const typename Law::Material& material,
                       const typename Law::Interface& interface) {
  { Law::mix(settings, material, material, interface, true) } -> std::same_as<PairOf<Law, double>>;
};

template <class Law>
concept has_evaluate = std::is_pointer_v<decltype(&Law::template evaluate<0u, double>)>;
template <class Law, class L>
concept evaluates = requires(const ContactPoint<L>& at, const PairOf<Law, L>& pair, StateOf<Law, L>& state) {
  { Law::template evaluate<0u>(at, pair, state) } -> std::same_as<Response<L>>;
};

template <class Law>
concept has_losses_template = std::is_pointer_v<decltype(&Law::template losses<0u, double>)>;
template <class Law>
concept has_losses_function = std::is_pointer_v<decltype(&Law::losses)>;
template <class Law>
concept has_losses = has_losses_template<Law> || has_losses_function<Law>;
template <class Law, class L>
concept loses = requires(const ContactPoint<L>& at, const PairOf<Law, L>& pair, const StateOf<Law, L>& state,
                         const Response<L>& response) {
  { Law::template losses<0u>(at, pair, state, state, response) } -> std::same_as<Loss<L>>;
};

template <class Law>
concept has_reach_template = std::is_pointer_v<decltype(&Law::template reach<double>)>;
template <class Law>
concept has_reach_function = std::is_pointer_v<decltype(&Law::reach)>;
template <class Law>
concept has_reach = has_reach_template<Law> || has_reach_function<Law>;
template <class Law, class L>
concept reaches = requires(const PairOf<Law, L>& pair, const L& radius) {
  { Law::template reach<L>(pair, radius, radius) } -> std::same_as<L>;
};

template <class Law>
concept has_features = std::is_pointer_v<decltype(&Law::features)>;
template <class Law>
concept features = requires(const PairOf<Law, double>& pair) {
  { Law::features(pair) } -> std::same_as<unsigned>;
};

template <class Law>
concept stiffness = requires(const PairSize& size, const PairOf<Law, double>& pair) {
  { Law::stiffness(size, pair) } -> std::same_as<Stiffness>;
};
template <class Law>
concept energy = requires(const PairSize& size, const PairOf<Law, double>& pair, const StateOf<Law, double>& state) {
  { Law::energy(size, pair, state) } -> std::same_as<ElasticEnergy>;
};

template <class Law>
concept parameters = settings<Law> && material<Law> && interface<Law> && pair<Law> && mix<Law>;
template <class Law>
concept forces =
    state<Law> && evaluates<Law, double> && evaluates<Law, Lane> && stiffness<Law> && energy<Law> && traits<Law>;

/// Whether the optional parts are those that the traits announce.
template <class Law>
consteval bool agrees_with_its_traits() {
  if constexpr (has_fields<Law> == stateless<Law>) return false;
  else if constexpr (has_fields<Law>) {
    if (!fields_cover_state<Law>() || !fields_name_features<Law>()) return false;
  }
  constexpr bool named = detail::feature_count<Law> != 0;
  if (Law::traits.losses != has_losses<Law> || named != has_features<Law>) return false;
  if (Law::traits.losses && !loses<Law, double>) return false;
  if (Law::traits.reach != has_reach<Law>) return false;
  if (Law::traits.reach && !(reaches<Law, double> && reaches<Law, Lane>)) return false;
  if (Law::traits.single_precision && !evaluates<Law, SingleLane>) return false;
  return prerequisites_are_features<Law>() && (!named || features<Law>);
}

}  // namespace law_part

/// Requirement of contact_law_plugin(). check_law() has the same conditions one by one, each with a message.
template <class Law>
concept LawDefinition = law_part::parameters<Law> && law_part::forces<Law> && law_part::agrees_with_its_traits<Law>();

/// Compiles if Law is a LawDefinition; otherwise the error names the missing part.
template <class Law>
consteval bool check_law() {
  static_assert(
      law_part::settings<Law>,
      "a contact law has a struct Settings with void declare(Parameters&); without any settings: using Settings "
      "= NoParameters");
  static_assert(law_part::material<Law>, "a contact law has a struct Material with void declare(Parameters&)");
  static_assert(law_part::interface<Law>,
                "a contact law has a struct Interface with void declare(Parameters&); without any: using Interface = "
                "NoParameters");
  static_assert(law_part::pair<Law>,
                "a contact law has template <class L> struct Pair, whose members are all L or Vec<L>");
  static_assert(
      law_part::state<Law>,
      "a contact law has template <class L> struct State, whose members are all L or Vec<L>; without a contact "
      "history it is empty");
  static_assert(law_part::traits<Law>,
                "a contact law has static constexpr LawTraits traits{…}, which announces its optional parts");
  if constexpr (law_part::settings<Law> && law_part::material<Law> && law_part::interface<Law> && law_part::pair<Law>)
    static_assert(
        law_part::mix<Law>,
        "a contact law has static Pair<double> mix(const Settings&, const Material& a, const Material& b, const "
        "Interface&, bool wall)");
  if constexpr (law_part::pair<Law> && law_part::state<Law>) {
    static_assert(law_part::has_evaluate<Law>,
                  "a contact law has template <unsigned Features, class L> static Response<L> evaluate(const "
                  "ContactPoint<L>&, const Pair<L>&, State<L>&); it is missing");
    static_assert(
        !law_part::has_evaluate<Law> || (law_part::evaluates<Law, double> && law_part::evaluates<Law, Lane>),
        "evaluate() of a contact law has a wrong signature: write template <unsigned Features, class L> static "
        "Response<L> evaluate(const ContactPoint<L>&, const Pair<L>&, State<L>&)");
    static_assert(law_part::stiffness<Law>,
                  "a contact law has static Stiffness stiffness(const PairSize&, const Pair<double>&)");
    static_assert(law_part::energy<Law>,
                  "a contact law has static ElasticEnergy energy(const PairSize&, const Pair<double>&, const "
                  "State<double>&)");
  }
  if constexpr (law_part::traits<Law> && law_part::state<Law> && law_part::pair<Law>) {
    static_assert(law_part::has_fields<Law> || law_part::stateless<Law>,
                  "State has members, so that the law has static constexpr LawField fields[], one entry a member");
    static_assert(!law_part::has_fields<Law> || !law_part::stateless<Law>,
                  "fields[] describes a State without members");
    if constexpr (law_part::has_fields<Law> && !law_part::stateless<Law>) {
      static_assert(law_part::fields_cover_state<Law>(),
                    "fields[] and State differ: one entry a member, in their order, .width = 3 for a Vec<L>");
      static_assert(law_part::fields_name_features<Law>(),
                    "needed_by of an entry of fields[] has a bit for which traits.features has no name");
    }
    static_assert(Law::traits.losses || !law_part::has_losses<Law>,
                  "the law has losses() and does not announce it: set .losses = true in its traits");
    static_assert(
        !Law::traits.losses || law_part::loses<Law, double>,
        "traits.losses is true: the law has template <unsigned Features, class L> static Loss<L> losses(const "
        "ContactPoint<L>&, const Pair<L>&, const State<L>& before, const State<L>& after, const Response<L>&)");
    static_assert(Law::traits.reach || !law_part::has_reach<Law>,
                  "the law has reach() and does not announce it: set .reach = true in its traits");
    static_assert(!Law::traits.reach || (law_part::reaches<Law, double> && law_part::reaches<Law, Lane>),
                  "traits.reach is true: the law has template <class L> static L reach(const Pair<L>&, const L& "
                  "radius_a, const L& radius_b)");
    static_assert(detail::feature_count<Law> != 0 || !law_part::has_features<Law>,
                  "the law has features() and does not announce them: name them in .features of its traits");
    static_assert(detail::feature_count<Law> == 0 || law_part::features<Law>,
                  "traits.features has names: the law has static unsigned features(const Pair<double>&)");
    static_assert(law_part::prerequisites_are_features<Law>(),
                  "an entry of traits.prerequisites has a bit for which traits.features has no name");
    static_assert(!Law::traits.single_precision || law_part::evaluates<Law, SingleLane>,
                  "traits.single_precision is true: evaluate() must take lanes of floats");
  }
  return true;
}

}  // namespace grit
