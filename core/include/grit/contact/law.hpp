// How a contact law is written: a struct with the physics of one contact. The loop over all contacts is the SDK's
// (cpu_loop.hpp), and grit_plugin() returns contact_law_plugin<MyLaw>(…) of law_plugin.hpp.
//
//   struct MyLaw : grit::LawBase {
//     struct Material { double modulus = 1e8; void declare(Parameters&); };
//     struct Interface { std::optional<double> friction; void declare(Parameters&); };  // overrides for two materials
//     using Settings = NoParameters;                               // of the law as a whole
//     template <class L> struct Pair { L modulus, friction; };     // members are L or Vec<L>
//     static Pair<double> mix(const Settings&, const Material& a, const Material& b, const Interface&, bool wall);
//
//     static constexpr LawTraits traits{.single_precision = true, .losses = true, .features = {"shear"}};
//     static constexpr unsigned with_shear = 1;                    // bits of the features, in their order
//     static unsigned features(const Pair<double>&);               // those that this pair needs
//
//     template <class L> struct State { Vec<L> shear; };           // the contact history; members as in Pair, or none
//     static constexpr LawField fields[] = {                       // one a member of State, in their order
//         {.name = "shear", .unit = "N", .doc = "shear force on b", .width = 3, .swap = -1, .needed_by = with_shear}};
//
//     template <unsigned Features, class L> [[gnu::always_inline]]
//     static Response<L> evaluate(const ContactPoint<L>&, const Pair<L>&, State<L>&);
//     template <unsigned Features, class L> [[gnu::always_inline]]
//     static Loss<L> losses(const ContactPoint<L>&, const Pair<L>&, const State<L>& before, const State<L>& after,
//                           const Response<L>&);
//     static Stiffness stiffness(const PairSize&, const Pair<double>&);
//     static ElasticEnergy energy(const PairSize&, const Pair<double>&, const State<double>&);
//   };
//
// mix() with `wall`: b is the material of a wall's surface.
// L is a lane: a register of doubles or floats, or one double. So evaluate() and losses() have no branches but `if
// constexpr ((Features & with_shear) != 0)`; they use select(), min(), max(), sqrt(), abs().
// They are also called for lanes that do not touch. Their results are discarded; they must not trap.
// Fields that no feature needs are not kept, and are 0 in State.
// In single precision a divisor is kept above L(tiny<L>), equality is a difference below beyond_rounding<L>, and each
// number of State is rounded to 24 bits at every step.
// evaluate() may be called again at the same instant, with the history that it left, dt = 0 and a turn that is the
// identity. It then returns the same force.
// The normal force may be negative: the law attracts. It does so only where bodies overlap; there is no force at a
// distance. Limits of friction must then be kept from becoming negative.
#pragma once

#include "grit/contact/contact_law.hpp"
#include "grit/contact/contact_point.hpp"
#include "grit/contact/law_base.hpp"
#include "grit/contact/law_check.hpp"
#include "grit/contact/law_traits.hpp"
