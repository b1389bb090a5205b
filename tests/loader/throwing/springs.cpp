// A law as authors write it: a linear spring.
#include "grit/contact/law.hpp"
#include "grit/contact/law_plugin.hpp"
#include "throwing.hpp"

namespace {

struct Springs : grit::LawBase {
  struct Material {
    double contact_modulus = 1e6;
    void declare(Parameters& p) {
      throwing::here("Material::declare()");
      declare_contact_modulus(p, contact_modulus);
    }
  };
  using Interface = NoParameters;
  using Settings = NoParameters;
  template <class L>
  struct Pair {
    L modulus_a, modulus_b;
  };
  static Pair<double> mix(const Settings&, const Material& a, const Material& b, const Interface&, bool wall) {
    throwing::here("mix()");
    return {a.contact_modulus, wall ? a.contact_modulus : b.contact_modulus};
  }
  static constexpr LawTraits traits{};
  template <class L>
  struct State {};

  template <unsigned Features, class L>
  [[gnu::always_inline]] static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair, State<L>&) {
    throwing::here("evaluate()");
    Response<L> response;
    response.normal_force = spring_in_line(pair.modulus_a, at.radius_a, pair.modulus_b, at.radius_b) * at.overlap;
    return response;
  }
  static Stiffness stiffness(const PairSize& size, const Pair<double>& pair) {
    throwing::here("stiffness()");
    return {.normal = spring_in_line(pair.modulus_a, size.radius_a, pair.modulus_b, size.radius_b)};
  }
  static ElasticEnergy energy(const PairSize& size, const Pair<double>& pair, const State<double>&) {
    return {.normal = 0.5 * spring_in_line(pair.modulus_a, size.radius_a, pair.modulus_b, size.radius_b) *
                      size.overlap * size.overlap};
  }
};

}  // namespace

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info =
      grit::contact_law_plugin<Springs>("springs", "1.0.0", "of the tests of the boundary");
  return &info;
}
