// What becomes of the error of a servo: it has arrived, it grows, or it no longer falls.
#pragma once

#include <bitset>
#include <optional>
#include <unordered_map>

#include "servo/duration.h"
#include "servo/stall.h"

namespace legible {

class ServoProgress {
 public:
  // The options' tolerance is in the mode's unit.
  ServoProgress(const ControlLawOptions& law, const SupervisorOptions& options);

  // To be told of each cycle in which the law gave speeds. None: it goes on.
  std::optional<Verdict> Judge(const CycleInput& input, const ServoStep& step, const CommandAnswers& answers);
  // And of each other one: nothing is known of the error meanwhile.
  void Interrupt();

 private:
  using Edges = std::bitset<2 * kLegCount>;

  // Those that an error in the image is the mean over; none where the error is no matter of edges.
  Edges EdgesBehind(const CycleInput& input) const;
  bool HasArrived(const CycleInput& input, const ServoStep& step);
  bool Grows(const CycleInput& input, const ServoStep& step, double smallest_error);

  ControlLawOptions law_;
  SupervisorOptions options_;
  LastingCondition is_within_, grows_;
  // By the edges behind them: other edges, other errors.
  std::unordered_map<Edges, double> smallest_errors_;
  StallWatch stall_;
};

}  // namespace legible
