// The largest stable time step.
#pragma once

#include "contact/contact_table.hpp"
#include "contact/wall_contacts.hpp"
#include "grit/contact/contact_law.hpp"
#include "scene/bodies.hpp"

namespace grit {

/// A lower bound of 2 / ω_max [s]. Each body's mass and inertia are shared out among its contacts in proportion to what
/// they ask for; ω_max² is then at most the largest over the contacts of Q_a + Q_b, with Q the sum over a body's
/// contacts of max(k_n/m, k_s (1/m + r²/I) + k_r/I, k_t/I) (the element bound of Irons and Treharne,
/// doi 10.1002/eqe.4290010107; Gershgorin's rows give the same without rotations). Pairs nearer than `near` [m] count
/// as touching (`closing` as in ContactTable::Instant), and every body has at least one contact with its like. Viscous
/// damping ζ lowers it by √(1 + ζ²) − ζ.
double critical_time_step(const Bodies& bodies, const ContactTable& pairs, const WallContacts& walls,
                          const ContactLaw& law, const ImageShift* shifts, double closing, double near);

}  // namespace grit
