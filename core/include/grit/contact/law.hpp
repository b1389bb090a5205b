// How to write a contact law: a struct with the physics of one contact. The SDK provides the loop over all contacts
// (cpu_loop.hpp). grit_plugin() returns contact_law_plugin<MyLaw>(…) of law_plugin.hpp.
//
//   struct MyLaw : grit::LawBase {
//     struct Material { double modulus = 1e8; void declare(Parameters&); };
//     struct Interface { std::optional<double> friction; void declare(Parameters&); };  // overrides of a material pair
//     using Settings = NoParameters;                               // of the law as a whole
//     template <class L> struct Pair { L modulus, friction; };     // members are L or Vec<L>
//     static Pair<double> mix(const Settings&, const Material& a, const Material& b, const Interface&, bool wall);
//
//     static constexpr LawTraits traits{.single_precision = true, .losses = true, .features = {"shear"}};
//     static constexpr unsigned with_shear = 1;                    // bits of the features, in their order
//     static unsigned features(const Pair<double>&);               // bits of the features that this pair needs
//
//     template <class L> struct State { Vec<L> shear; };           // contact history; members as in Pair, or none
//     static constexpr LawField fields[] = {                       // one entry per member, in order
//         {.name = "shear", .unit = "N", .doc = "spring force on b", .width = 3, .swap = -1, .needed_by = with_shear}};
//
//     template <unsigned Features, class L> [[gnu::always_inline]]
//     static constexpr Response<L> evaluate(const ContactPoint<L>&, const Pair<L>&, State<L>&);
//     template <unsigned Features, class L> [[gnu::always_inline]]
//     static constexpr Loss<L> losses(const ContactPoint<L>&, const Pair<L>&, const State<L>& before, const State<L>& after,
//                           const Response<L>&);
//     template <class L>                                           // with traits.reach
//     static constexpr L reach(const Pair<L>&, const L& radius_a, const L& radius_b);
//     static Stiffness stiffness(const PairSize&, const Pair<double>&);
//     static ElasticEnergy energy(const PairSize&, const Pair<double>&, const State<double>&);
//   };
//
// mix() combines two materials; with `wall`, b is the material of a wall.
// evaluate() and reach() are constexpr, and call only functions that are: nvcc compiles them for GPUs, too.
// L is a lane: a register of doubles or floats, or one double. Therefore the only branches in evaluate() and losses()
// are `if constexpr ((Features & with_shear) != 0)`; otherwise use select(), min(), max(), sqrt() and abs(). Both are
// also called for lanes that are not in contact. Their results are discarded, but they must not trap. Fields that no
// active feature needs are not kept; they are 0 in State. In single precision, keep divisors above L(tiny<L>) and test
// equality by a difference below beyond_rounding<L>. Each number of State is then rounded to 24 bits in every step.
// evaluate() may be called again at the same instant, with the updated history, dt = 0 and the identity as turn. It
// must then return the same force. The normal force may be negative (attraction); the law must then keep friction
// limits from becoming negative.
// Response::shear is the force of the spring that ContactPoint::velocity stretches. The force on the bodies is larger
// in contacts that overlap: the limit of the spring by Coulomb's law is at.friction_limit(friction, normal_force).
// losses() and energy() are those of the spring.
// Bodies interact while they overlap, or with `.reach = true` while their surfaces are nearer than reach() [m]. The
// contact history then exists from the reach on, with zeros at first, so that it can hold whether there is a bond. Two
// bodies of the largest radius have the largest reach, and it grows at most in proportion to the radii. The normal
// energy is 0 without a bond and where a bond forms; what a bond stores at the reach is dissipated when it breaks.
// stiffness() is called for overlaps ≥ 0; no slope at a distance is larger than that at overlap 0.
#pragma once

#include "grit/contact/contact_law.hpp"
#include "grit/contact/contact_point.hpp"
#include "grit/contact/law_base.hpp"
#include "grit/contact/law_check.hpp"
#include "grit/contact/law_traits.hpp"
