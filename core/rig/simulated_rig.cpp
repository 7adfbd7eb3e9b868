#include "core/rig/simulated_rig.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace legible {
namespace {

// Whoever adds up periods arrives at a multiple of them but for rounding.
constexpr double kSameTime_s = 1e-9;
constexpr double kNever_s = std::numeric_limits<double>::infinity();

SimulationOptions Checked(SimulationOptions options) {
  options.Check();
  return options;
}

}  // namespace

SimulatedRig::SimulatedRig(SimulationTruth truth, SimulationOptions options, PictureSource picture)
    : truth_(std::move(truth)),
      options_(Checked(std::move(options))),
      picture_(std::move(picture)),
      drives_(options_.drives, truth_.robot,
              InverseKinematics(truth_.robot, options_.start.value_or(truth_.robot.home)), options_.seed),
      base_from_platform_(options_.start.value_or(truth_.robot.home)) {
  for (const Fault& fault : options_.faults)
    if (fault.kind == FaultKind::kReadingsFrozen) freezes_s_.push_back(fault.from_s);
  std::sort(freezes_s_.begin(), freezes_s_.end());
  AdvanceTo(0);
}

double SimulatedRig::Now() {
  DemandAnswer();
  return now_s_;
}

void SimulatedRig::WaitUntil(double time_s) {
  if (!std::isfinite(time_s)) throw std::invalid_argument("SimulatedRig: the time is not a finite number");
  AdvanceTo(time_s);
  DemandAnswer();
}

StampedImage SimulatedRig::Grab() {
  if (!picture_) throw std::logic_error("SimulatedRig: this rig has no camera");
  const Frame& frame = NewestFrame();
  if (!drawn_ || drawn_number_ != frame.number) {
    drawn_ = picture_(frame.base_from_platform, frame.covered_legs, frame.number);
    drawn_number_ = frame.number;
  }
  return {frame.time_s, *drawn_};
}

StampedReadings SimulatedRig::ReadJoints() {
  DemandAnswer();
  if (IsActive(FaultKind::kReadingsNan))
    return {now_s_, Vector6d::Constant(std::numeric_limits<double>::quiet_NaN())};
  return {now_s_, IsActive(FaultKind::kReadingsFrozen) ? frozen_readings_m_ : Measure()};
}

void SimulatedRig::CommandSpeeds(const Vector6d& joint_speeds_m_per_s) {
  DemandAnswer();
  drives_.Command(joint_speeds_m_per_s);
  lapse_s_ = now_s_ + kCommandHolds_s;
}

void SimulatedRig::Stop() noexcept {
  if (!IsActive(FaultKind::kLinkLost)) Lapse();
}

const Frame& SimulatedRig::NewestFrame() {
  DemandAnswer();
  if (!newest_) throw NoImageYet();
  return *newest_;
}

TrueMotion SimulatedRig::true_motion() const {
  return {base_from_platform_, drives_.joint_readings_m(), drives_.joint_speeds_m_per_s()};
}

bool SimulatedRig::IsActive(FaultKind kind) const {
  return std::any_of(options_.faults.begin(), options_.faults.end(),
                     [&](const Fault& fault) { return fault.kind == kind && fault.IsActiveAt(now_s_); });
}

void SimulatedRig::DemandAnswer() const {
  if (kinematics_status_ == ForwardKinematicsStatus::kSingular)
    throw RigError("the true robot has come into a singular pose, where its legs do not hold the platform");
  if (kinematics_status_ != ForwardKinematicsStatus::kConverged)
    throw RigError("the true robot's legs have come to lengths that no pose near the last one has");
  if (IsActive(FaultKind::kLinkLost)) throw RigError("the link to the robot is lost");
}

void SimulatedRig::AdvanceTo(double time_s) {
  const auto is_whole = [&] { return kinematics_status_ == ForwardKinematicsStatus::kConverged; };
  while (is_whole()) {
    const double exposure_s = static_cast<double>(next_exposure_) * options_.period_s;
    const double freeze_s = next_freeze_ < freezes_s_.size() ? freezes_s_[next_freeze_] : kNever_s;
    const double next_s = std::min({exposure_s, freeze_s, lapse_s_});
    MoveTo(std::min(next_s, time_s));
    if (next_s > time_s + kSameTime_s || !is_whole()) break;
    if (next_s == lapse_s_)
      Lapse();
    else if (next_s == freeze_s)
      Freeze();
    else
      Expose();
  }
  Receive();
}

void SimulatedRig::MoveTo(double time_s) {
  if (!(time_s > now_s_)) return;
  drives_.Advance(time_s - now_s_);
  now_s_ = time_s;
  const ForwardKinematicsResult pose =
      ForwardKinematics(truth_.robot, drives_.joint_readings_m(), base_from_platform_);
  kinematics_status_ = pose.status;
  if (pose.status == ForwardKinematicsStatus::kConverged) base_from_platform_ = pose.base_from_platform;
}

// The drives' own doing: it needs no link.
void SimulatedRig::Lapse() {
  drives_.Halt();
  lapse_s_ = kNever_s;
}

void SimulatedRig::Freeze() {
  ++next_freeze_;
  const bool is_frozen_already =
      std::any_of(options_.faults.begin(), options_.faults.end(), [&](const Fault& fault) {
        return fault.kind == FaultKind::kReadingsFrozen && fault.from_s < now_s_ && fault.IsActiveAt(now_s_);
      });
  if (!is_frozen_already) frozen_readings_m_ = Measure();
}

// A frame of the camera. Its faults are those of the exposure's time.
void SimulatedRig::Expose() {
  Frame frame;
  frame.time_s = static_cast<double>(next_exposure_) * options_.period_s;
  frame.number = next_exposure_++;
  frame.base_from_platform = base_from_platform_;
  double delay_s = 0;
  bool is_dropped = false, is_frozen = false;
  for (const Fault& fault : options_.faults) {
    if (!fault.IsActiveAt(frame.time_s)) continue;
    if (fault.kind == FaultKind::kLegCovered) frame.covered_legs.push_back(fault.leg);
    if (fault.kind == FaultKind::kFramesLate) delay_s = std::max(delay_s, fault.delay_s);
    is_dropped |= fault.kind == FaultKind::kFramesDropped;
    is_frozen |= fault.kind == FaultKind::kFramesFrozen;
  }
  if (is_dropped) return;
  std::sort(frame.covered_legs.begin(), frame.covered_legs.end());
  frame.covered_legs.erase(std::unique(frame.covered_legs.begin(), frame.covered_legs.end()),
                           frame.covered_legs.end());
  if (is_frozen && last_exposed_) {
    const double time_s = frame.time_s;
    frame = *last_exposed_;
    frame.time_s = time_s;
  }
  last_exposed_ = frame;
  on_the_way_.push_back({frame.time_s + delay_s, std::move(frame)});
}

// What has arrived by now; a late frame that a newer one has overtaken is nothing new.
void SimulatedRig::Receive() {
  const auto has_arrived = [&](const Arrival& arrival) { return arrival.time_s <= now_s_ + kSameTime_s; };
  for (const Arrival& arrival : on_the_way_)
    if (has_arrived(arrival) && (!newest_ || arrival.frame.time_s > newest_->time_s)) newest_ = arrival.frame;
  std::erase_if(on_the_way_, has_arrived);
}

// The same again at the same time, however often it is asked.
Vector6d SimulatedRig::Measure() const { return drives_.Measure(std::bit_cast<std::uint64_t>(now_s_)); }

}  // namespace legible
