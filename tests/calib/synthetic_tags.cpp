#include "tests/calib/synthetic_tags.h"

#include <random>

#include "calib/base_frame.h"
#include "calib/problem_setup.h"
#include "tests/calib/truth_problem.h"

namespace legible {
namespace {

Tag SquareTag(int id, double side_m, double x_m) {
  const double h = side_m / 2;
  return {id, {Eigen::Vector3d(x_m - h, -h, 0), {x_m + h, -h, 0}, {x_m + h, h, 0}, {x_m - h, h, 0}}};
}

class Drawer {
 public:
  explicit Drawer(const SyntheticTagOptions& options) : options_(options), generator_(options.noise_seed) {}

  ObservedTagGroup Draw(TagGroup group, const std::vector<Rigid3>& camera_from_carrier,
                        const Camera& camera) {
    ObservedTagGroup observed{group, {}};
    // On the base the detector errs alike in every image.
    std::vector<std::array<Eigen::Vector2d, 4>> noise_px(group.tags.size());
    const auto draw_noise = [&] {
      for (auto& of_tag : noise_px)
        for (Eigen::Vector2d& of_corner : of_tag)
          of_corner = {Normal(options_.corner_sigma_px), Normal(options_.corner_sigma_px)};
    };
    draw_noise();
    for (const Rigid3& carrier : camera_from_carrier) {
      observed.detections.emplace_back();
      if (group.carrier == TagCarrier::kPlatform) draw_noise();
      const bool misread = group.carrier == TagCarrier::kPlatform && Chance(options_.misread_fraction);
      for (size_t t = 0; t < group.tags.size(); ++t) {
        TagDetection detection{group.tags[t].id, {}};
        for (size_t k = 0; k < 4; ++k)
          detection.corners_px[k] =
              Project(camera, carrier * (group.carrier_from_group * group.tags[t].corners_m[k])) +
              noise_px[t][k] + Eigen::Vector2d::Constant(misread ? 15 : 0);
        observed.detections.back().push_back(detection);
      }
    }
    if (options_.corner_sigma_px > 0) MisplaceDrawing(observed.group);
    return observed;
  }

 private:
  double Normal(double sigma) { return sigma * std::normal_distribution<double>()(generator_); }
  bool Chance(double probability) { return std::bernoulli_distribution(probability)(generator_); }
  void MisplaceDrawing(TagGroup& group) {
    Vector6d off;
    for (int i = 0; i < 6; ++i) off[i] = Normal(i < 3 ? group.translation_sigma_m : group.rotation_sigma_rad);
    group.carrier_from_group = Displaced(group.carrier_from_group, off);
  }

  const SyntheticTagOptions& options_;
  std::mt19937_64 generator_;
};

}  // namespace

std::vector<ObservedTagGroup> DrawTags(const SyntheticSession& session, const SyntheticTagOptions& options) {
  const SharedParameters truth = TrueParameters(session);
  LegPoints drawn;
  for (size_t i = 0; i < kLegCount; ++i) drawn[i] = session.nominal_robot.legs[i].base_joint_m;
  const Rigid3 camera_from_base = FitBaseFrame(BaseJointsInCamera(truth), drawn).camera_from_base;
  const Rigid3 platform_from_gauge = Inverse(GaugeFromPlatform(session));
  std::vector<Rigid3> base, platform;
  for (const Rigid3& base_from_platform : session.true_base_from_platform) {
    base.push_back(camera_from_base);
    platform.push_back(session.true_camera_from_base * base_from_platform * platform_from_gauge);
  }
  // Both face the camera, which looks from +x.
  const Eigen::Quaterniond towards_x((Eigen::Matrix3d() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished());
  const TagGroup board{"board",
                       TagCarrier::kBase,
                       {towards_x, {0.3, 0, -0.03}},
                       options.translation_sigma_m,
                       options.rotation_sigma_rad,
                       {SquareTag(0, 0.04, -0.06), SquareTag(1, 0.04, 0), SquareTag(2, 0.04, 0.06)}};
  const TagGroup top{"top",
                     TagCarrier::kPlatform,
                     {towards_x, {0.15, 0.02, 0.03}},
                     options.translation_sigma_m,
                     options.rotation_sigma_rad,
                     {SquareTag(10, 0.036, 0)}};
  Drawer drawer(options);
  return {drawer.Draw(board, base, session.true_camera), drawer.Draw(top, platform, session.true_camera)};
}

void AddTagsToProblem(const std::vector<ObservedTagGroup>& tags, double corner_sigma_px,
                      EstimationProblem& problem) {
  AddTags(tags, FitBaseFrame(BaseJointsInCamera(problem.shared), problem.drawn_base_joints).camera_from_base,
          problem);
  const double scale = corner_sigma_px / kLibraryCornerSigma_px;  // that of the detections' covariances
  for (TagObservation& tag : problem.base_tags) tag.sigma_scale = scale;
  for (PoseUnit& unit : problem.units)
    for (TagObservation& tag : unit.tags) tag.sigma_scale = scale;
}

}  // namespace legible
