#include "description/begin.hpp"

namespace grit {

void BeginDescription::declare(Parameters& p) {
  p.add("from", from).file().required().doc("folder of results of the run whose state is the sample");
  p.add("at", at)
      .one_of({"end", "checkpoint", "frame"})
      .doc("end: the end of a complete run; checkpoint: the last checkpoint of an incomplete one; frame: a frame");
  p.add("frame", frame).at_least(-1).doc("number of the frame, as in frames/000012.h5; -1: the last one");
  p.add("time", time).unit("s").at_least(0).doc("time of the frame in its run, instead of its number; the nearest one");
  p.add("springs", springs)
      .one_of({"keep", "drop"})
      .doc(
          "whether contacts keep their shear and rolling springs; fields of the same name are kept with another law; "
          "frames hold none");
  p.check(
      [this](const Complain& complain) {
        if (at != "frame" && (frame >= 0 || time))
          complain("at", '"' + at + "\" with " + (time ? "a time" : "the number of a frame"), "\"at\": \"frame\"");
        if (frame >= 0 && time) complain("time", "the number and the time of a frame", "one of them");
      },
      {"at", "frame", "time"});
}

}  // namespace grit
