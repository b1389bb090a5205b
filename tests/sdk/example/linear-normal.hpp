// A spring along the normal and nothing else: the least that a contact law can be.
#pragma once

#include "grit/contact/law.hpp"

struct LinearNormal {
  struct Settings {
    void declare(grit::Parameters&) {}
  };
  struct Material {
    double stiffness = 1e4;
    void declare(grit::Parameters& p) {
      p.add("stiffness", stiffness).unit("N/m").symbol("k").above(0).doc("of one grain's spring; two act in series");
    }
  };
  struct Interface {
    void declare(grit::Parameters&) {}
  };

  template <class L>
  struct Pair {
    L stiffness;
  };
  /// A law remembers one number at least; this one stays zero.
  template <class L>
  struct State {
    L unused;
  };
  static std::vector<grit::StateField> fields() { return {{"unused", "1", "zero", 1}}; }
  static constexpr unsigned feature_bits = 0;
  static unsigned features(const Pair<double>&) { return 0; }
  static constexpr unsigned fields_used(unsigned) { return 0; }

  static Pair<double> mix(const Settings&, const Material& a, const Material& b, const Interface&, bool) {
    return {a.stiffness * b.stiffness / (a.stiffness + b.stiffness)};
  }
  template <unsigned Features, class L>
  [[gnu::always_inline]] static grit::Response<L> evaluate(const grit::ContactPoint<L>& at, const Pair<L>& pair,
                                                           State<L>&) {
    return {.normal_force = pair.stiffness * at.overlap};
  }
  static grit::Stiffness stiffness(const grit::PairSize&, const Pair<double>& pair) {
    return {.normal = pair.stiffness};
  }
  static grit::ElasticEnergy energy(const grit::PairSize& size, const Pair<double>& pair, const State<double>&) {
    return {.normal = 0.5 * pair.stiffness * size.overlap * size.overlap};
  }
};
