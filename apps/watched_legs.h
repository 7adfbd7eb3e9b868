// Which legs a servo by images watches, and where else they may lead it.
#pragma once

#include "apps/progress.h"
#include "apps/servo_run.h"

namespace legible {

// Before anything moves: chooses the legs where the settings ask for it (--legs auto), and adds to the
// warnings every other pose within the joint ranges at which the watched legs point as they do at the goal,
// and whether a singularity of the hidden robot may lie on the straight way there. Reads the joints once, at
// rest: the servo that follows is the same with legs chosen and with these legs named. Does nothing for laws
// that look at no image, or without a goal whose pose is known. Throws InputError where no set of legs leads
// to the goal.
void SettleWatchedLegs(PreparedServo& prepared, ProgressLine& progress);

}  // namespace legible
