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
  Squares& operator+=(const Squares& other) {
    sum += other.sum;
    count += other.count;
    return *this;
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

// The least motion of a point that moves its image by that, m, in two directions across the line of sight.
Eigen::Vector2d AcrossSight(const ProjectedPoint& projected, const Eigen::Vector2d& moved_px) {
  const Eigen::Matrix2d gram = projected.d_x * projected.d_x.transpose();
  return gram.llt().matrixL().solve(moved_px);
}

// A group in one image, and where its carrier is there.
struct SeenGroup {
  const GroupSighting* sighting;
  Rigid3 camera_from_carrier;
};

struct GroupErrors {
  Squares px, metres;
  int images = 0;
};

// Nothing where a corner lies behind the camera.
std::optional<GroupErrors> ErrorsOf(const Rigid3& carrier_from_group, const Camera& camera,
                                    const std::vector<SeenGroup>& seen) {
  GroupErrors errors;
  for (const SeenGroup& one : seen) {
    errors.images += one.sighting->corners_px.empty() ? 0 : 1;
    for (size_t k = 0; k < one.sighting->corners_px.size(); ++k) {
      const Eigen::Vector3d x =
          one.camera_from_carrier * (carrier_from_group * one.sighting->corners_in_group_m[k]);
      if (x.z() <= 0) return std::nullopt;
      const ProjectedPoint projected = ProjectWithJacobians(camera, x);
      const Eigen::Vector2d error_px = projected.pixel - one.sighting->corners_px[k];
      errors.px.Add(error_px);
      errors.metres.Add(AcrossSight(projected, error_px));
    }
  }
  return errors;
}

// Two coordinates a corner: the rms of a corner's distance is sqrt(2) that of a coordinate.
std::optional<GroupCheck> CheckOf(const GroupErrors& errors) {
  if (errors.px.count == 0) return std::nullopt;
  return GroupCheck{errors.images, std::sqrt(2.0) * *errors.px.Rms(), std::sqrt(2.0) * *errors.metres.Rms()};
}

// One step of Gauss and Newton towards the place that suits all images.
Rigid3 BetterPlace(const Rigid3& carrier_from_group, const Camera& camera,
                   const std::vector<SeenGroup>& seen) {
  Matrix6d information = Matrix6d::Zero();
  Vector6d moment = Vector6d::Zero();
  for (const SeenGroup& one : seen)
    for (size_t k = 0; k < one.sighting->corners_px.size(); ++k) {
      const MovedPoint corner =
          Move(carrier_from_group, Vector6d::Zero(), one.sighting->corners_in_group_m[k]);
      const ProjectedPoint projected = ProjectWithJacobians(camera, one.camera_from_carrier * corner.x_in_b);
      const Eigen::Matrix<double, 2, 6> jacobian =
          projected.d_x * one.camera_from_carrier.rotation.toRotationMatrix() * corner.d_displacement;
      information += jacobian.transpose() * jacobian;
      moment -= jacobian.transpose() * (projected.pixel - one.sighting->corners_px[k]);
    }
  return Displaced(carrier_from_group, information.ldlt().solve(moment));
}

// The place on its carrier that suits the images together, from the drawn one. Nothing unless the group was
// seen in two images, and where the model puts a corner behind the camera.
std::optional<Rigid3> PlaceGroup(Rigid3 carrier_from_group, const Camera& camera,
                                 const std::vector<SeenGroup>& seen) {
  constexpr int kRounds = 15;
  auto errors = ErrorsOf(carrier_from_group, camera, seen);
  if (!errors || errors->images < 2) return std::nullopt;
  for (int round = 0; round < kRounds; ++round) {
    const Rigid3 next = BetterPlace(carrier_from_group, camera, seen);
    const auto next_errors = ErrorsOf(next, camera, seen);
    if (!next_errors || !(next_errors->px.sum < errors->px.sum)) break;  // there, or no place suits
    carrier_from_group = next;
    errors = next_errors;
  }
  return carrier_from_group;
}

// Where a group's carrier is in an image, by a model that may not have seen it: the platform from the joint
// readings alone.
std::optional<Rigid3> CarrierPose(TagCarrier carrier, const ImageObservation& image,
                                  const LegCalibration& trained, const Rigid3& first) {
  if (carrier == TagCarrier::kBase) return trained.camera_from_base;
  if (!image.joint_readings_m) return std::nullopt;
  const auto fk =
      ForwardKinematics(trained.robot, *image.joint_readings_m, Inverse(trained.camera_from_base) * first);
  if (fk.status != ForwardKinematicsStatus::kConverged) return std::nullopt;
  return trained.camera_from_base * fk.base_from_platform;
}

// Places the group by the images of the other folds and adds what it is off in those of this one.
void AddHeldOutErrors(const CheckedGroup& checked, const LegCalibrationInput& input,
                      const LegCalibration& trained, const LegCalibration& solution,
                      const std::vector<int>& fold_of_image, int fold, GroupErrors& errors) {
  std::vector<SeenGroup> others, held_out;
  for (size_t i = 0; i < input.images.size(); ++i) {
    if (checked.sightings[i].corners_px.empty() || !solution.ReadingsCountIn(i)) continue;
    const auto pose =
        CarrierPose(checked.group.carrier, input.images[i], trained, solution.camera_from_platform[i]);
    if (pose) (fold_of_image[i] == fold ? held_out : others).push_back({&checked.sightings[i], *pose});
  }
  const auto place = PlaceGroup(checked.group.carrier_from_group, trained.camera, others);
  const auto found = place ? ErrorsOf(*place, trained.camera, held_out) : std::nullopt;
  if (!found) return;
  errors.px += found->px;
  errors.metres += found->metres;
  errors.images += found->images;
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
                      const LegCalibrationOptions& options, const std::vector<int>& fold_of_image,
                      const std::vector<CheckedGroup>& groups) {
  if (fold_of_image.size() != input.images.size())
    throw std::invalid_argument("CrossValidate: a fold for each image is needed");
  HeldOut result;
  if (!fold_of_image.empty())
    result.folds = *std::max_element(fold_of_image.begin(), fold_of_image.end()) + 1;
  result.image_rms_px.resize(input.images.size());
  Squares all;
  std::vector<GroupErrors> of_groups(groups.size());
  const bool has_poses = options.rigid_platform && options.use_joint_readings;
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
      all += *squares;
    }
    for (size_t g = 0; g < groups.size(); ++g)
      if (has_poses || groups[g].group.carrier == TagCarrier::kBase)
        AddHeldOutErrors(groups[g], input, trained, solution, fold_of_image, fold, of_groups[g]);
  }
  result.rms_px = all.Rms();
  for (const GroupErrors& errors : of_groups) result.groups.push_back(CheckOf(errors));
  return result;
}

std::optional<GroupCheck> CheckGroup(const TagGroup& group, const Camera& camera,
                                     const std::vector<GroupSighting>& sightings,
                                     const std::vector<Rigid3>& camera_from_carrier) {
  std::vector<SeenGroup> seen;
  for (size_t i = 0; i < sightings.size(); ++i) seen.push_back({&sightings[i], camera_from_carrier[i]});
  const auto place = PlaceGroup(group.carrier_from_group, camera, seen);
  return place ? CheckOf(*ErrorsOf(*place, camera, seen)) : std::nullopt;
}

}  // namespace legible
