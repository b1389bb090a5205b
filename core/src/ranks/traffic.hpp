// What a rank has exchanged with others.
#pragma once

namespace grit {

struct Traffic {
  double messages = 0;  ///< sent to single ranks
  double bytes = 0;     ///< of these
  double gathers = 0;   ///< exchanges among all ranks
  double gathered = 0;  ///< bytes received in these
  double seconds = 0;   ///< for all of this, waiting included
};

}  // namespace grit
