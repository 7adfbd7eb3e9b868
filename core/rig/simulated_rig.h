// A rig that exists in the computer alone, by a clock of its own: as fast as the computer, and repeatable.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/rig/drives.h"
#include "core/rig/rig.h"
#include "core/rig/simulation_options.h"

namespace legible {

// Draws what the camera sees, the same for the same arguments. Covered legs are 0-based, in order; `frame`
// numbers the exposures and goes with the noise.
using PictureSource = std::function<GrayImage(const Rigid3& base_from_platform,
                                              const std::vector<int>& covered_legs, std::uint64_t frame)>;

// An exposure as it arrived. Where frames are frozen, the stamp is its own and the rest an older one's.
struct Frame {
  double time_s = 0;         // of the exposure
  std::uint64_t number = 0;  // of the exposure whose content this is
  Rigid3 base_from_platform;
  std::vector<int> covered_legs;
};

// What only a simulation knows.
struct TrueMotion {
  Rigid3 base_from_platform;
  Vector6d joint_readings_m = Vector6d::Zero();
  Vector6d joint_speeds_m_per_s = Vector6d::Zero();
};

// The time goes on in WaitUntil only: then the drives move, and the pose follows by the true robot's forward
// kinematics, continued from the pose before. Same calls, same results, up to the last bit; how often
// images, readings or edges are asked for changes nothing.
//
// Faults: see FaultKind. A lost link makes every call but Stop throw RigError (WaitUntil after the time has
// gone on), and Stop does not reach the drives before it is back: the last command that reached them lapses.
// An end stop that is hit holds the joint. If the true robot comes into a singular pose, or one that its legs
// cannot take, all is over: every call but Stop throws RigError.
class SimulatedRig : public Rig {
 public:
  // At rest at options.start or the robot's home, time 0, with the first image exposed. Throws
  // std::invalid_argument if the options do not pass Check or the start is outside a joint's range.
  // Without a picture source it has no camera: Grab throws std::logic_error.
  SimulatedRig(SimulationTruth truth, SimulationOptions options, PictureSource picture = {});

  double Now() override;
  // Throws std::invalid_argument unless the time is finite.
  void WaitUntil(double time_s) override;
  StampedImage Grab() override;
  StampedReadings ReadJoints() override;
  void CommandSpeeds(const Vector6d& joint_speeds_m_per_s) override;
  void Stop() noexcept override;

  // The newest frame that has arrived, as Grab would draw it. Throws RigError as Grab does, also where none
  // has arrived yet.
  const Frame& NewestFrame();

  // What follows never throws, whatever the link does.
  const SimulationTruth& truth() const { return truth_; }
  const SimulationOptions& options() const { return options_; }
  double true_time_s() const { return now_s_; }
  TrueMotion true_motion() const;
  const Drives& drives() const { return drives_; }  // knows largest speeds and end stops since the beginning
  ForwardKinematicsStatus kinematics_status() const { return kinematics_status_; }

 private:
  struct Arrival {
    double time_s = 0;
    Frame frame;
  };

  bool IsActive(FaultKind kind) const;
  void DemandAnswer() const;
  void AdvanceTo(double time_s);
  void MoveTo(double time_s);
  void Lapse();
  void Freeze();
  void Expose();
  void Receive();
  Vector6d Measure() const;

  SimulationTruth truth_;
  SimulationOptions options_;
  PictureSource picture_;
  Drives drives_;
  Rigid3 base_from_platform_;
  ForwardKinematicsStatus kinematics_status_ = ForwardKinematicsStatus::kConverged;
  double now_s_ = 0;
  double lapse_s_ = std::numeric_limits<double>::infinity();  // of the command in force
  std::vector<double> freezes_s_;                             // when readings freeze, in order
  size_t next_freeze_ = 0;
  std::uint64_t next_exposure_ = 0;
  Vector6d frozen_readings_m_ = Vector6d::Zero();

  std::optional<Frame> last_exposed_;  // that was not dropped
  std::vector<Arrival> on_the_way_;
  std::optional<Frame> newest_;
  std::optional<GrayImage> drawn_;  // the image of the frame number below
  std::uint64_t drawn_number_ = 0;
};

}  // namespace legible
