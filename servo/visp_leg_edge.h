// Edges of legs as features of ViSP, to be stacked in a vpServo task with others.
//
// ViSP 3.5's headers are not C++20: what includes this is compiled as C++17.
#pragma once

#include <visp3/visual_features/vpBasicFeature.h>

#include <Eigen/Core>
#include <array>

#include "servo/interaction.h"
#include "servo/servo_model.h"

namespace legible {

// One edge of one leg. s is its line in the model's pixel frame, a unit vector of three numbers (Andreff et
// al., eq. 5), the error s x s* (eq. 37) and the interaction matrix that of this error (eq. 39), by the twist
// (v, omega) of the camera in its own frame: as if the camera and the base moved and the platform stood
// still. To ViSP that is an eye in hand, although the camera stands. Once:
//
//   LegEdgeFeature seen(model, leg), goal(model, leg);  // for each edge; they must outlive the task
//   goal.BuildGoal(goal_normal);
//   seen.BuildSeen(normal, direction, length_m, goal);
//   vpServo task;
//   task.setServo(vpServo::EYEINHAND_L_cVe_eJe);        // joint speeds; EYEINHAND_CAMERA: the twist
//   task.setInteractionMatrixType(vpServo::CURRENT);
//   task.setLambda(2);
//   task.addFeature(seen, goal);
//
// and in each cycle:
//
//   seen.BuildSeen(normal, direction, length_m, goal);
//   task.set_cVe(vpVelocityTwistMatrix());
//   task.set_eJe(TwistByJointSpeeds(model, directions));
//   vpColVector joint_speeds_m_per_s = task.computeControlLaw();
//
// Six edges of three legs or more are needed. This is the edge law of EvaluateStep where all edges count
// alike, with a vpAdaptiveGain too: for joint speeds ViSP takes that gain at the farthest that a joint has to
// go. Nothing here keeps the limits of joints.
class LegEdgeFeature : public vpBasicFeature {
 public:
  // leg is 0-based; throws std::out_of_range for one that there is not.
  LegEdgeFeature(const ServoModel& model, int leg);

  // What an edge at the goal is: its outline normal in the camera frame, away from the leg (CylinderOutline;
  // ViSP's own limbs point inward).
  void BuildGoal(const Eigen::Vector3d& normal);
  // As it is seen now: with the leg's direction A to B in camera, of which the part in the edge's plane
  // counts, the leg's length, and the goal that the interaction matrix depends on.
  void BuildSeen(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction, double length_m,
                 const LegEdgeFeature& goal);

  void init() override;  // no edge yet
  // s x s*; throws vpException unless both are built.
  vpColVector error(const vpBasicFeature& goal, unsigned int select = FEATURE_ALL) override;
  // Throws vpException before BuildSeen.
  vpMatrix interaction(unsigned int select = FEATURE_ALL) override;
  void print(unsigned int select = FEATURE_ALL) const override;
  LegEdgeFeature* duplicate() const override { return new LegEdgeFeature(*this); }
  void display(const vpCameraParameters& camera, const vpImage<unsigned char>& image,
               const vpColor& color = vpColor::green, unsigned int thickness = 1) const override;
  void display(const vpCameraParameters& camera, const vpImage<vpRGBa>& image,
               const vpColor& color = vpColor::green, unsigned int thickness = 1) const override;

 private:
  void Keep(const ImageLine& line);
  Eigen::Vector3d Line() const { return {s[0], s[1], s[2]}; }
  // ViSP's line x cos(theta) + y sin(theta) = rho, normalised coordinates.
  struct RhoTheta {
    double rho, theta_rad;
  };
  RhoTheta ToRhoTheta() const;

  ServoModel model_;
  int leg_;
  bool has_interaction_ = false;
  Eigen::Matrix<double, 3, 6> interaction_ = Eigen::Matrix<double, 3, 6>::Zero();
};

// The twist of LegEdgeFeature by the joints' speeds (m/s): what vpServo calls eJe. Directions as
// CameraInverseJacobian has them.
vpMatrix TwistByJointSpeeds(const ServoModel& model, const LegDirections& directions);

}  // namespace legible
