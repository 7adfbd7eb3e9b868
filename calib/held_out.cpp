#include "calib/held_out.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "calib/edge_residuals.h"

namespace legible {
namespace {

struct Squares {
  double sum = 0;
  int count = 0;
  void Add(const Eigen::VectorXd& values) {
    sum += values.squaredNorm();
    count += static_cast<int>(values.size());
  }
  std::optional<double> Rms() const {
    return count > 0 ? std::optional(std::sqrt(sum / count)) : std::nullopt;
  }
};

CalibrationStart StartAt(const LegCalibration& solution) {
  return {solution.camera, solution.robot, solution.camera_from_base, {}};
}

// The image with its edges moved back by what shading does to them in all images alike.
ImageObservation WithoutShading(ImageObservation image, const LegCalibration& trained) {
  for (EdgeObservation& edge : image.edges) {
    const Eigen::Vector2d shading =
        trained.shading_px[static_cast<size_t>(edge.leg)].segment<2>(2 * edge.edge);
    const Eigen::VectorXd place = PlacesAlong(edge);
    for (size_t i = 0; i < edge.samples.size(); ++i)
      edge.samples[i].point_px -=
          (shading[0] + shading[1] * place[static_cast<Eigen::Index>(i)]) * edge.samples[i].normal_px;
  }
  return image;
}

// Of the image's edges once its pose, or the direction of each leg, was fitted to them, all else held.
std::optional<Squares> ErrorAfterFit(const ImageObservation& image, const LegCalibration& trained,
                                     const Rigid3& first, LegCalibrationOptions options) {
  LegCalibrationInput one{trained.robot,   trained.camera, trained.camera_from_base, {image}, {},
                          StartAt(trained)};
  one.start->camera_from_platform = {first};
  options.hold = {true, true, true, true, true, true, true, true};
  options.lasting_shading = 0;
  options.progress = nullptr;
  const LegCalibration fitted = CalibrateLegs(one, options);
  if (fitted.status != CalibrationStatus::kConverged) return std::nullopt;
  Squares squares;
  for (const EdgeResidualSet& edge : fitted.edges) squares.Add(edge.residual_px);
  return squares;
}

// Of the image's edges where the joint readings alone put the platform; nothing where they lead to no pose.
std::optional<Squares> ErrorByReadings(const ImageObservation& image, const LegCalibration& trained,
                                       const Rigid3& first) {
  const Rigid3 guess = Inverse(trained.camera_from_base) * first;
  const auto fk = ForwardKinematics(trained.robot, *image.joint_readings_m, guess);
  if (fk.status != ForwardKinematicsStatus::kConverged) return std::nullopt;
  Squares squares;
  for (const EdgeObservation& edge : image.edges) {
    const Leg& leg = trained.robot.legs[static_cast<size_t>(edge.leg)];
    const auto distances = EdgeDistances(
        trained.camera, trained.camera_from_base * leg.base_joint_m,
        trained.camera_from_base * (fk.base_from_platform * leg.platform_joint_m), leg.radius_m, edge);
    if (distances) squares.Add(*distances);
  }
  return squares;
}

std::optional<Squares> PredictionError(const ImageObservation& image, const LegCalibration& trained,
                                       const Rigid3& first, const LegCalibrationOptions& options) {
  const ImageObservation unshaded = WithoutShading(image, trained);
  const bool by_readings = options.rigid_platform && options.use_joint_readings && image.joint_readings_m;
  return by_readings ? ErrorByReadings(unshaded, trained, first)
                     : ErrorAfterFit(unshaded, trained, first, options);
}

LegCalibration Train(const LegCalibrationInput& input, const LegCalibration& solution,
                     LegCalibrationOptions options, const std::vector<int>& fold_of_image, int fold) {
  LegCalibrationInput training{input.drawing, input.camera,     input.camera_from_base, {},
                               input.known,   StartAt(solution)};
  for (size_t i = 0; i < input.images.size(); ++i) {
    if (fold_of_image[i] == fold) continue;
    training.images.push_back(input.images[i]);
    training.start->camera_from_platform.push_back(solution.camera_from_platform[i]);
  }
  for (const ObservedTagGroup& tags : input.tags) {
    training.tags.push_back({tags.group, {}});
    for (size_t i = 0; i < input.images.size(); ++i)
      if (fold_of_image[i] != fold) training.tags.back().detections.push_back(tags.detections[i]);
  }
  training.board = input.board;
  options.progress = nullptr;
  return CalibrateLegs(training, options);
}

// The least motion of a point that moves its image by that: across the line of sight.
double AcrossSight_m(const ProjectedPoint& projected, const Eigen::Vector2d& moved_px) {
  return (projected.d_x.transpose() * (projected.d_x * projected.d_x.transpose()).inverse() * moved_px)
      .norm();
}

}  // namespace

std::vector<int> FoldsOf(size_t images, int folds, std::optional<std::uint64_t> seed) {
  std::vector<int> fold_of_image(images);
  for (size_t i = 0; i < images; ++i) fold_of_image[i] = static_cast<int>(i % static_cast<size_t>(folds));
  // Fisher-Yates: the standard library's shuffle differs from one library to the other.
  std::mt19937_64 generator(seed.value_or(0));
  for (size_t i = images; seed && i > 1; --i) std::swap(fold_of_image[i - 1], fold_of_image[generator() % i]);
  return fold_of_image;
}

HeldOut CrossValidate(const LegCalibrationInput& input, const LegCalibration& solution,
                      const LegCalibrationOptions& options, const std::vector<int>& fold_of_image) {
  if (fold_of_image.size() != input.images.size())
    throw std::invalid_argument("CrossValidate: a fold for each image is needed");
  HeldOut result;
  if (!fold_of_image.empty())
    result.folds = *std::max_element(fold_of_image.begin(), fold_of_image.end()) + 1;
  result.image_rms_px.resize(input.images.size());
  Squares all;
  for (int fold = 0; fold < result.folds; ++fold) {
    const LegCalibration trained = Train(input, solution, options, fold_of_image, fold);
    if (trained.status != CalibrationStatus::kConverged) {
      ++result.folds_failed;
      continue;
    }
    for (size_t i = 0; i < input.images.size(); ++i) {
      if (fold_of_image[i] != fold || !solution.ReadingsCountIn(i)) continue;
      const auto squares =
          PredictionError(input.images[i], trained, solution.camera_from_platform[i], options);
      if (!squares) continue;
      result.image_rms_px[i] = squares->Rms();
      all.sum += squares->sum;
      all.count += squares->count;
    }
  }
  result.rms_px = all.Rms();
  return result;
}

std::optional<GroupCheck> CheckGroup(const TagGroup& group, const Camera& camera,
                                     const std::vector<GroupSighting>& sightings,
                                     const std::vector<Rigid3>& camera_from_carrier) {
  Rigid3 carrier_from_group = group.carrier_from_group;
  GroupCheck check;
  for (const GroupSighting& sighting : sightings)
    if (!sighting.corners_px.empty()) ++check.images;
  if (check.images < 2) return std::nullopt;

  constexpr int kRounds = 15;
  GroupCheck best;
  for (int round = 0; round <= kRounds; ++round) {
    Matrix6d information = Matrix6d::Zero();
    Vector6d moment = Vector6d::Zero();
    Squares px, metres;
    for (size_t i = 0; i < sightings.size(); ++i)
      for (size_t k = 0; k < sightings[i].corners_px.size(); ++k) {
        const MovedPoint corner =
            Move(carrier_from_group, Vector6d::Zero(), sightings[i].corners_in_group_m[k]);
        const Eigen::Vector3d x = camera_from_carrier[i] * corner.x_in_b;
        if (x.z() <= 0) return std::nullopt;
        const ProjectedPoint projected = ProjectWithJacobians(camera, x);
        const Eigen::Vector2d error = projected.pixel - sightings[i].corners_px[k];
        px.Add(error);
        metres.Add(error.normalized() * AcrossSight_m(projected, error));
        const Eigen::Matrix<double, 2, 6> jacobian =
            projected.d_x * camera_from_carrier[i].rotation.toRotationMatrix() * corner.d_displacement;
        information += jacobian.transpose() * jacobian;
        moment -= jacobian.transpose() * error;
      }
    // Two coordinates a corner: the rms of a corner's distance is sqrt(2) that of a coordinate.
    check.rms_px = *px.Rms() * std::sqrt(2.0);
    check.rms_m = *metres.Rms() * std::sqrt(2.0);
    if (round > 0 && !(check.rms_px < best.rms_px)) break;  // there, or corners that no place suits
    best = check;
    carrier_from_group = Displaced(carrier_from_group, information.ldlt().solve(moment));
  }
  return best;
}

}  // namespace legible
