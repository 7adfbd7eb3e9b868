// Which pose a calibration session should show next: the one from which the poses that the calibrated model
// will predict gain most.
#pragma once

#include <optional>
#include <vector>

#include "calib/image_information.h"
#include "calib/leg_calibration.h"
#include "calib/pose_candidates.h"
#include "calib/pose_error.h"

namespace legible {

struct PoseProposalOptions {
  PoseCandidateOptions candidates;
  // Poses (base_from_platform) that the model shall predict well; empty: drawn over all that is in reach.
  std::vector<Rigid3> cared_for;
  // What a rotation error counts by, beside position errors; none: the platform's radius.
  std::optional<double> lever_m;
  // By what the noise of edges differs from their own sigmas: LegCalibration's, once there is one.
  EdgeNoise noise;
  // An image in which no reading differs by more from a candidate's has taken that candidate.
  double same_pose_m = 0.002;
  // The first images are chosen together, for only together do they determine the parameters: one that gains
  // most by itself is often none of the best few. Fewer images than this determine hardly anything.
  int planned_images = 6;
  int plan_passes = 2;  // of exchange within the plan
  int threads = 2;

  void Check() const;  // throws std::invalid_argument
};

// What a calibration of the images would state as uncertainty (one standard deviation), root mean squares
// over what is meant; nothing where the images leave it open.
struct ExpectedSigma {
  std::optional<double> position_m;    // distance of the predicted platform origin from the true one
  std::optional<double> rotation_rad;  // angle between predicted and true platform
  std::optional<double> focal_length_px, principal_point_px;
  std::optional<double> base_joint_m, platform_joint_m;  // each coordinate, in their frames
  std::optional<double> radius_m, joint_offset_m;
};

struct PoseProposal {
  Rigid3 base_from_platform;
  Vector6d joint_readings_m;  // by the model's robot
  int edges = 0;              // expected to be measured, of twelve
  ExpectedSigma expected;     // with this pose added to what has been seen
};

// Proposes poses one by one for a session. The information that each candidate's image would add does not
// depend on other images and is computed once; a proposal takes the candidate that lowers most, in the
// beginning together with those that will follow,
//   trace(M C),  M = mean over the poses cared for of P^T diag(1, 1, 1, lever^2, lever^2, lever^2) P,
// with C the covariance of the parameters and P the derivative of the predicted pose by them: the mean
// squared error of predicted poses (A-optimal in these). C holds what the estimator knows: the images so far
// and its priors. So that it exists from the first image on, each parameter is taken to be known besides to a
// twentieth of its natural size (Observability: 5 % of the focal length, of a joint's distance from its
// frame's origin, of a radius …); ExpectedSigma is free of that assumption.
//
// Everything is linear about the model: input.start's where there is one, otherwise the drawing and the
// guessed camera. Once there is a calibration, a proposer constructed anew with it as start sees better. To
// resume is to construct with the images that there are. The same input and options propose the same poses.
class PoseProposer {
 public:
  // input.images: what has been seen so far. Throws std::invalid_argument where CalibrateLegs would, with
  // tags (what they will show is not foreseen), without a rigid platform or readings (nothing would be
  // predicted from them), where no pose is in reach and as Add.
  PoseProposer(LegCalibrationInput input, const LegCalibrationOptions& estimation,
               PoseProposalOptions options);

  // Nothing once every candidate has been taken or rejected, or where there are none. A candidate is proposed
  // again until it has been: call Add, or Reject.
  std::optional<PoseProposal> Next() const;

  // An image as it was measured, in whatever pose. Throws std::invalid_argument where it has no joint
  // readings or these lead to no pose from home, std::runtime_error where the model cannot produce the edges
  // at all; either leaves the proposer as it was.
  void Add(const ImageObservation& image);

  // The candidate there will not be proposed (again): the rig could not go there, or saw nothing.
  void Reject(const Rigid3& base_from_platform);

  // Of what has been seen so far.
  ExpectedSigma Expected() const;

  const PoseCandidates& candidates() const { return candidates_; }

 private:
  void AddAt(const ImageObservation& image, const Rigid3& camera_from_platform);
  void Take(const Vector6d& joint_readings_m);
  Eigen::MatrixXd InformationOf(const ImageObservation& image, const Rigid3& camera_from_platform) const;
  EstimationProblem WithoutUnits() const;
  ExpectedSigma SigmaOf(const EstimationProblem& problem, const Eigen::MatrixXd& information) const;

  LegCalibrationInput input_;
  LegCalibrationOptions estimation_;
  PoseProposalOptions options_;
  RigModel model_;
  PoseCandidates candidates_;
  std::vector<Eigen::MatrixXd> roots_;        // of each candidate's information
  std::vector<bool> taken_;                   // of each candidate
  std::vector<Rigid3> camera_from_platform_;  // of each image
  Eigen::MatrixXd by_shared_;                 // ModelBySharedParameters
  PoseErrorForms forms_;
  double lever_m_ = 0;
  Eigen::MatrixXd seen_;  // information of all images
  int images_with_edges_ = 0;
};

}  // namespace legible
