// The error of a servo in words.
#pragma once

#include <string>

#include "servo/control_law.h"

namespace legible {

// An error in the mode's own unit, as users read it best: "0.08 px", "1.25 mrad", "0.120 mm".
std::string ErrorText(ControlMode mode, double error);

// What an error in the image says of the platform's place, as a further clause: "; one image tells …". Empty
// of a law that looks at no images.
std::string CertaintyText(const ControlLawOptions& law, const LawResult& result);

}  // namespace legible
