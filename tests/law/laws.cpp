// Laws with one error each. check.py verifies that the compiler gives the messages above each law, and none for the
// others.
#include "grit/contact/law.hpp"

namespace somewhere {

/// A law without evaluate() and traits.
struct Parts : grit::LawBase {
  using Settings = NoParameters;
  using Interface = NoParameters;
  struct Material {
    double modulus = 1;
    void declare(Parameters&) {}
  };
  template <class L>
  struct Pair {
    L modulus;
  };
  template <class L>
  struct State {
    Vec<L> shear;
  };
  static constexpr LawField fields[] = {{.name = "shear", .unit = "N", .doc = "shear force on b", .width = 3}};
  static Pair<double> mix(const Settings&, const Material& a, const Material&, const Interface&, bool) {
    return {a.modulus};
  }
  static Stiffness stiffness(const PairSize&, const Pair<double>& pair) { return {.normal = pair.modulus}; }
  static ElasticEnergy energy(const PairSize&, const Pair<double>&, const State<double>&) { return {}; }
};

struct Right : Parts {
  static constexpr LawTraits traits{};
  template <unsigned Features, class L>
  static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair, State<L>&) {
    const L pressed = select(at.overlap > L(0.0), abs(at.overlap), L(0.0));
    return {.normal_force = min(sqrt(pressed) * pair.modulus, max(pressed, L(1.0)))};
  }
};

struct RightInAllParts : Parts {
  static constexpr LawTraits traits{.single_precision = true, .losses = true, .features = {"shear"}};
  static unsigned features(const Pair<double>&) { return 1; }
  template <unsigned Features, class L>
  static Response<L> evaluate(const ContactPoint<L>&, const Pair<L>&, State<L>&) {
    return {};
  }
  template <unsigned Features, class L>
  static Loss<L> losses(const ContactPoint<L>&, const Pair<L>&, const State<L>&, const State<L>&, const Response<L>&) {
    return {};
  }
};

struct RightAtADistance : Right {
  static constexpr LawTraits traits{.reach = true};
  template <class L>
  static L reach(const Pair<L>&, const L& radius_a, const L& radius_b) {
    return min(radius_a, radius_b);
  }
};

struct RightWithoutHistory : grit::LawBase {
  using Settings = NoParameters;
  using Interface = NoParameters;
  using Material = Parts::Material;
  template <class L>
  using Pair = Parts::Pair<L>;
  template <class L>
  struct State {};
  static constexpr LawTraits traits{};
  static Pair<double> mix(const Settings&, const Material& a, const Material&, const Interface&, bool) {
    return {a.modulus};
  }
  template <unsigned Features, class L>
  static Response<L> evaluate(const ContactPoint<L>&, const Pair<L>&, State<L>&) {
    return {};
  }
  static Stiffness stiffness(const PairSize&, const Pair<double>& pair) { return {.normal = pair.modulus}; }
  static ElasticEnergy energy(const PairSize&, const Pair<double>&, const State<double>&) { return {}; }
};

// error: a contact law has template <unsigned Features, class L> static Response<L> evaluate(const ContactPoint<L>&,
// error: const Pair<L>&, State<L>&); it is missing
struct EvaluateIsMissing : Parts {
  static constexpr LawTraits traits{};
};

// error: it is missing
struct EvaluateIsMisspelt : Parts {
  static constexpr LawTraits traits{};
  template <unsigned Features, class L>
  static Response<L> evalute(const ContactPoint<L>&, const Pair<L>&, State<L>&) {
    return {};
  }
};

// error: evaluate() of a contact law has a wrong signature: write template <unsigned Features, class L> static
struct EvaluateTakesNoState : Parts {
  static constexpr LawTraits traits{};
  template <unsigned Features, class L>
  static Response<L> evaluate(const ContactPoint<L>&, const Pair<L>&) {
    return {};
  }
};

// error: evaluate() of a contact law has a wrong signature
struct EvaluateReturnsANumber : Parts {
  static constexpr LawTraits traits{};
  template <unsigned Features, class L>
  static L evaluate(const ContactPoint<L>& at, const Pair<L>&, State<L>&) {
    return at.overlap;
  }
};

// error: evaluate() of a contact law has a wrong signature
struct EvaluateIsForDoublesAlone : Parts {
  static constexpr LawTraits traits{};
  template <unsigned Features, class L>
  static Response<double> evaluate(const ContactPoint<double>&, const Pair<double>&, State<double>&) {
    return {};
  }
};

// error: a contact law has static constexpr LawTraits traits{…}, which announces its optional parts
struct TraitsAreMisspelt : Parts {
  static constexpr LawTraits trait{};
  template <unsigned Features, class L>
  static Response<L> evaluate(const ContactPoint<L>&, const Pair<L>&, State<L>&) {
    return {};
  }
};

// error: single_precison
struct ATraitIsMisspelt : Parts {
  static constexpr LawTraits traits{.single_precison = true};
  template <unsigned Features, class L>
  static Response<L> evaluate(const ContactPoint<L>&, const Pair<L>&, State<L>&) {
    return {};
  }
};

// error: the law has losses() and does not announce it: set .losses = true in its traits
struct LossesAreNotAnnounced : RightInAllParts {
  static constexpr LawTraits traits{.single_precision = true, .features = {"shear"}};
};

// error: traits.losses is true: the law has template <unsigned Features, class L> static Loss<L> losses(const
struct LossesAreMisspelt : Right {
  static constexpr LawTraits traits{.losses = true};
  template <unsigned Features, class L>
  static Loss<L> loses(const ContactPoint<L>&, const Pair<L>&, const State<L>&, const State<L>&, const Response<L>&) {
    return {};
  }
};

// error: the law has features() and does not announce them: name them in .features of its traits
struct FeaturesAreNotAnnounced : RightInAllParts {
  static constexpr LawTraits traits{.losses = true};
};

// error: the law has reach() and does not announce it: set .reach = true in its traits
struct ReachIsNotAnnounced : Right {
  template <class L>
  static L reach(const Pair<L>&, const L&, const L&) {
    return L(0.0);
  }
};

// error: traits.reach is true: the law has template <class L> static L reach(const Pair<L>&, const L& radius_a, const
struct ReachIsMisspelt : Right {
  static constexpr LawTraits traits{.reach = true};
  template <class L>
  static L reaches(const Pair<L>&, const L&, const L&) {
    return L(0.0);
  }
};

// error: traits.reach is true: the law has template <class L> static L reach(const Pair<L>&, const L& radius_a, const
struct ReachReturnsADouble : Right {
  static constexpr LawTraits traits{.reach = true};
  template <class L>
  static double reach(const Pair<L>&, const L&, const L&) {
    return 0;
  }
};

// error: traits.features has names: the law has static unsigned features(const Pair<double>&)
struct FeaturesAreMisspelt : Right {
  static constexpr LawTraits traits{.features = {"shear"}};
  static unsigned feature(const Pair<double>&) { return 1; }
};

// error: fields[] and State differ: one entry a member, in their order, .width = 3 for a Vec<L>
struct AFieldIsMissing : Right {
  template <class L>
  struct State {
    Vec<L> shear;
    L twisting;
  };
  static ElasticEnergy energy(const PairSize&, const Pair<double>&, const State<double>&) { return {}; }
  template <unsigned Features, class L>
  static Response<L> evaluate(const ContactPoint<L>&, const Pair<L>&, State<L>&) {
    return {};
  }
};

// error: needed_by of an entry of fields[] has a bit for which traits.features has no name
struct AFieldNeedsNoFeature : Right {
  static constexpr LawField fields[] = {
      {.name = "shear", .unit = "N", .doc = "shear force on b", .width = 3, .needed_by = 2}};
};

// error: an entry of traits.prerequisites has a bit for which traits.features has no name
struct APrerequisiteIsNotAFeature : RightInAllParts {
  static constexpr LawTraits traits{
      .single_precision = true, .losses = true, .features = {"shear"}, .prerequisites = {2}};
};

// error: a contact law has template <class L> struct Pair, whose members are all L or Vec<L>
struct PairHasADouble : Right {
  template <class L>
  struct Pair {
    L modulus;
    double friction;
  };
};

// error: a contact law has a struct Material with void declare(Parameters&)
struct MaterialDeclaresNothing : Right {
  struct Material {
    double modulus = 1;
  };
};

// The functions work on lanes of any kind.
template grit::Response<double> Right::evaluate<0>(const grit::ContactPoint<double>&, const Pair<double>&,
                                                   State<double>&);
template grit::Response<grit::Lane> Right::evaluate<0>(const grit::ContactPoint<grit::Lane>&, const Pair<grit::Lane>&,
                                                       State<grit::Lane>&);

static_assert(grit::check_law<Right>());
static_assert(grit::check_law<RightInAllParts>());
static_assert(grit::check_law<RightAtADistance>());
static_assert(grit::check_law<RightWithoutHistory>());
static_assert(grit::check_law<EvaluateIsMissing>());
static_assert(grit::check_law<EvaluateIsMisspelt>());
static_assert(grit::check_law<EvaluateTakesNoState>());
static_assert(grit::check_law<EvaluateReturnsANumber>());
static_assert(grit::check_law<EvaluateIsForDoublesAlone>());
static_assert(grit::check_law<TraitsAreMisspelt>());
static_assert(grit::check_law<LossesAreNotAnnounced>());
static_assert(grit::check_law<LossesAreMisspelt>());
static_assert(grit::check_law<ReachIsNotAnnounced>());
static_assert(grit::check_law<ReachIsMisspelt>());
static_assert(grit::check_law<ReachReturnsADouble>());
static_assert(grit::check_law<FeaturesAreNotAnnounced>());
static_assert(grit::check_law<FeaturesAreMisspelt>());
static_assert(grit::check_law<AFieldIsMissing>());
static_assert(grit::check_law<AFieldNeedsNoFeature>());
static_assert(grit::check_law<APrerequisiteIsNotAFeature>());
static_assert(grit::check_law<PairHasADouble>());
static_assert(grit::check_law<MaterialDeclaresNothing>());

static_assert(grit::LawDefinition<Right> && grit::LawDefinition<RightInAllParts> &&
              grit::LawDefinition<RightAtADistance> && grit::LawDefinition<RightWithoutHistory>);
static_assert(!grit::LawDefinition<EvaluateIsMissing> && !grit::LawDefinition<EvaluateIsMisspelt> &&
              !grit::LawDefinition<EvaluateTakesNoState> && !grit::LawDefinition<EvaluateReturnsANumber> &&
              !grit::LawDefinition<EvaluateIsForDoublesAlone> && !grit::LawDefinition<TraitsAreMisspelt> &&
              !grit::LawDefinition<ReachIsNotAnnounced> && !grit::LawDefinition<ReachIsMisspelt> &&
              !grit::LawDefinition<ReachReturnsADouble> && !grit::LawDefinition<LossesAreNotAnnounced> &&
              !grit::LawDefinition<LossesAreMisspelt> && !grit::LawDefinition<FeaturesAreNotAnnounced> &&
              !grit::LawDefinition<FeaturesAreMisspelt> && !grit::LawDefinition<AFieldIsMissing> &&
              !grit::LawDefinition<AFieldNeedsNoFeature> && !grit::LawDefinition<APrerequisiteIsNotAFeature> &&
              !grit::LawDefinition<PairHasADouble> && !grit::LawDefinition<MaterialDeclaresNothing>);

}  // namespace somewhere
