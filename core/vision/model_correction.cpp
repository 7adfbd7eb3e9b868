#include "core/vision/model_correction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace legible {
namespace {

using Matrix12d = Eigen::Matrix<double, 12, 12>;
using Vector12d = Eigen::Matrix<double, 12, 1>;

// Of camera_from_base, then of base_from_platform.
Vector12d Displacements(const ModelledView& from, const ModelledView& to) {
  Vector12d displacements;
  displacements << Displacement(from.camera_from_base, to.camera_from_base),
      Displacement(from.base_from_platform, to.base_from_platform);
  return displacements;
}

ModelledView Displaced(ModelledView view, const Vector12d& displacements) {
  view.camera_from_base = legible::Displaced(view.camera_from_base, displacements.head<6>());
  view.base_from_platform = legible::Displaced(view.base_from_platform, displacements.tail<6>());
  return view;
}

Vector12d InformationOf(const ViewErrors& errors) {
  const auto of = [](double sigma) { return Eigen::Vector3d::Constant(1 / (sigma * sigma)); };
  Vector12d information;
  information << of(errors.camera_m), of(errors.camera_rad), of(errors.platform_m), of(errors.platform_rad);
  return information;
}

// A point of a leg's axis and of its outline beside it, with the seen line's unit normal in the image there.
struct Place {
  double share = 0;
  Eigen::Vector3d x_in_camera, on_edge;
  Eigen::RowVector3d off_by_point;  // how its off_m changes when on_edge moves
  double off_m = 0;
};

// On the leg, where it passes that point of the image.
std::optional<Place> PlaceAt(const LegInCamera& leg, const Eigen::Vector3d& model_normal,
                             const SeenEdge& edge, const Eigen::Vector2d& end) {
  const Eigen::Vector3d along = leg.b_in_camera - leg.a_in_camera;
  const Eigen::Vector3d across = end.homogeneous().cross(edge.normal);
  Place place;
  place.share = std::clamp(-across.dot(leg.a_in_camera) / across.dot(along), 0.0, 1.0);
  place.x_in_camera = leg.AxisPoint(place.share);
  place.on_edge = place.x_in_camera + leg.radius_m * model_normal;
  const double z = place.on_edge.z(), size = edge.normal.head<2>().norm();
  if (!(z > 0)) return std::nullopt;
  const Eigen::Vector2d x = place.on_edge.hnormalized();
  const Eigen::RowVector2d line = edge.normal.head<2>().transpose() / size;
  // off_m = -z (line . x + n_z / size), but for the change of z itself, which is small where this is.
  place.off_m = -z * (line.dot(x) + edge.normal.z() / size);
  place.off_by_point << -line, line.dot(x);
  return place;
}

std::optional<std::array<Place, 2>> PlacesOf(const LegInCamera& leg, const SeenEdge& edge) {
  const auto axis = LineThrough<double>(leg.a_in_camera, leg.b_in_camera);
  if (!CameraIsOutside(axis, leg.radius_m)) return std::nullopt;
  const Eigen::Vector3d normal = CylinderOutline(axis, leg.radius_m)[static_cast<size_t>(edge.edge)];
  if (!(normal.dot(edge.normal) > 0.5)) return std::nullopt;
  const auto first = PlaceAt(leg, normal, edge, edge.ends[0]),
             last = PlaceAt(leg, normal, edge, edge.ends[1]);
  if (!first || !last) return std::nullopt;
  return std::array<Place, 2>{*first, *last};
}

// d off_m / d displacements.
Eigen::Matrix<double, 1, 12> DerivativeOf(const ModelledView& view, const Leg& leg, const Place& place) {
  const Eigen::Matrix3d camera_rotation_base = view.camera_from_base.rotation.toRotationMatrix();
  const Eigen::Vector3d arm_in_camera = place.x_in_camera - view.camera_from_base.translation;
  const Eigen::Vector3d arm_in_base = view.base_from_platform.rotation * leg.platform_joint_m;
  Eigen::Matrix<double, 3, 12> moves;
  moves << Eigen::Matrix3d::Identity(), -Skew(arm_in_camera), place.share * camera_rotation_base,
      -place.share * camera_rotation_base * Skew(arm_in_base);
  return place.off_by_point * moves;
}

// An edge counts as what it says of the outline, in variances of leg_m; one that is far off as no more than
// kMostSquares.
constexpr double kMostSquares = 9;
double SquaresOf(const std::array<Place, 2>& places, double leg_m) {
  return (places[0].off_m * places[0].off_m + places[1].off_m * places[1].off_m) / (leg_m * leg_m);
}

// What CorrectView minimises, of an edge that is not to be seen at all too.
double MisfitOf(const ModelledView& model, const ModelledView& view, const SeenEdges& seen,
                const CorrectionOptions& options) {
  const Vector12d off = Displacements(model, view);
  double misfit = off.cwiseAbs2().dot(InformationOf(options.errors));
  const LegsInCamera legs = PlaceLegs(view);
  for (const SeenEdge& edge : seen.edges) {
    const auto places = PlacesOf(legs[static_cast<size_t>(edge.leg)], edge);
    const double squares = places ? SquaresOf(*places, options.leg_m) : 1e300;
    misfit += squares / (1 + squares / kMostSquares);
  }
  return misfit;
}

// One Gauss-Newton step.
ModelledView Step(const ModelledView& model, const ModelledView& before, const ModelledView& now,
                  const SeenEdges& seen, const CorrectionOptions& options) {
  Vector12d prior = InformationOf(options.errors);
  Vector12d moment = prior.cwiseProduct(Displacements(now, model));
  if (options.drift) {
    const Vector12d drift = InformationOf(*options.drift);
    moment += drift.cwiseProduct(Displacements(now, before));
    prior += drift;
  }
  Matrix12d information = prior.asDiagonal();
  const LegsInCamera legs = PlaceLegs(now);
  for (const SeenEdge& edge : seen.edges) {
    const auto leg = static_cast<size_t>(edge.leg);
    const auto places = PlacesOf(legs[leg], edge);
    if (!places) continue;
    const double weight =
        std::pow(options.leg_m * (1 + SquaresOf(*places, options.leg_m) / kMostSquares), -2);
    for (const Place& place : *places) {
      const auto row = DerivativeOf(now, now.robot.legs[leg], place);
      information += weight * row.transpose() * row;
      moment -= weight * place.off_m * row.transpose();
    }
  }
  return Displaced(now, information.ldlt().solve(moment));
}

}  // namespace

LegsInCamera PlaceLegs(const ModelledView& view) {
  return PlaceLegs(view.robot, view.camera_from_base, view.base_from_platform);
}

double OffModel::OffAt_px(double share) const {
  const double between = ends[1].share - ends[0].share;
  if (std::abs(between) < 1e-9) return ends[0].off_px;
  return ends[0].off_px + (ends[1].off_px - ends[0].off_px) * (share - ends[0].share) / between;
}

double OffModel::Largest_m() const { return std::max(std::abs(ends[0].off_m), std::abs(ends[1].off_m)); }

std::optional<OffModel> OffOf(const ModelledView& view, const SeenEdge& edge) {
  const auto places = PlacesOf(PlaceLegs(view)[static_cast<size_t>(edge.leg)], edge);
  if (!places) return std::nullopt;
  const double focal_px = (view.camera.fx_px + view.camera.fy_px) / 2;
  OffModel off;
  for (size_t i = 0; i < 2; ++i) {
    const Place& place = (*places)[i];
    off.ends[i] = {place.share, focal_px * place.off_m / place.on_edge.z(), place.off_m};
  }
  return off;
}

ModelledView CorrectView(const ModelledView& model, const ModelledView& before, const SeenEdges& seen,
                         const CorrectionOptions& options) {
  ModelledView now = before;
  for (int i = 0; i < options.iterations; ++i) now = Step(model, before, now, seen, options);
  return now;
}

ModelledView CorrectViewByMost(const ModelledView& model, const SeenEdges& seen,
                               const CorrectionOptions& options) {
  ModelledView best = model;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kLegCount; ++i)  // kLegCount: none
    for (int j = i; j <= kLegCount; ++j) {
      SeenEdges without = seen;
      std::erase_if(without.edges, [&](const SeenEdge& edge) { return edge.leg == i || edge.leg == j; });
      ModelledView view = CorrectView(model, model, without, options);
      view = CorrectView(model, view, seen, options);
      const double misfit = MisfitOf(model, view, seen, options);
      if (misfit >= least) continue;
      least = misfit;
      best = view;
    }
  return best;
}

}  // namespace legible
