#include "apps/accuracy_json.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/accuracy_judgement.h"
#include "apps/accuracy_units.h"
#include "apps/index_definitions.h"
#include "apps/program.h"
#include "apps/workspace_json.h"

namespace legible {
namespace {

using nlohmann::ordered_json;

// --- One pose.

ordered_json EightJson(const Eigen::VectorXd& of_coordinate, double position_m, double rotation_rad,
                       const InUnits& units) {
  ordered_json json;
  for (Eigen::Index i = 0; i < of_coordinate.size(); ++i)
    json[CoordinateNames()[static_cast<size_t>(i)]] = of_coordinate[i] / units.Of(i);
  json["position"] = units.Length(position_m);
  json["rotation"] = units.Angle(rotation_rad);
  return json;
}

ordered_json NoErrorsJson() {
  ordered_json json;
  for (const std::string& name : CoordinateNames()) json[name] = nullptr;
  json["position"] = json["rotation"] = nullptr;
  return json;
}

ordered_json EightJson(const ErrorFigures& figures, const InUnits& units) {
  return EightJson(figures.of_coordinate, figures.position_m, figures.rotation_rad, units);
}

ordered_json RangeJson(const ThreePointRange& range) { return {range.least, range.largest}; }

void AddIndices(const PoseAccuracy& accuracy, bool is_natural, ordered_json& json) {
  if (!accuracy.indices) {
    json["condition"] = nullptr;
    json["manipulability"] = nullptr;
    return;
  }
  const Indices& indices = *accuracy.indices;
  ordered_json condition = {{"two", indices.plain.two},
                            {"frobenius", indices.plain.frobenius},
                            {"infinity", indices.plain.infinity},
                            {"frobenius_of_gram", indices.plain.frobenius_of_gram},
                            {"two_normalized", indices.normalized.two},
                            {"frobenius_normalized", indices.normalized.frobenius},
                            {"infinity_normalized", indices.normalized.infinity},
                            {"frobenius_of_gram_normalized", indices.normalized.frobenius_of_gram},
                            {"two_three_point", nullptr},
                            {"frobenius_three_point", nullptr},
                            {"frobenius_three_point_plain", nullptr},
                            {"characteristic_length",
                             {{"two", indices.lengths.two_m},
                              {"frobenius", indices.lengths.frobenius_m},
                              {"infinity", indices.lengths.infinity_m}}},
                            {"natural_length", is_natural}};
  if (indices.three_point) {
    condition["two_three_point"] = RangeJson(indices.three_point->two);
    condition["frobenius_three_point"] = RangeJson(indices.three_point->frobenius_of_gram);
    condition["frobenius_three_point_plain"] = RangeJson(indices.three_point->frobenius);
  }
  json["condition"] = condition;
  json["manipulability"] = indices.manipulability;
}

ordered_json PolyhedronJson(const std::optional<Polyhedron>& polyhedron, double unit) {
  if (!polyhedron) return nullptr;
  return {{"vertices", Columns(polyhedron->vertices / unit)},
          {"facets", polyhedron->facets},
          {"volume", polyhedron->volume / (unit * unit * unit)}};
}

ordered_json EllipsoidJson(const Ellipsoid& ellipsoid, double unit) {
  return {{"semi_axes", List(ellipsoid.semi_axes / unit)}, {"directions", Columns(ellipsoid.directions)}};
}

void AddSets(const ErrorSets& sets, const InUnits& units, ordered_json& json) {
  const double length = units.Of(0), angle = units.Of(3);
  json["polyhedron"] = {{"position", PolyhedronJson(sets.position.polyhedron, length)},
                        {"rotation", PolyhedronJson(sets.rotation.polyhedron, angle)},
                        {"volume_6d", sets.volume_6d / (length * length * length * angle * angle * angle)}};
  json["ellipsoid"] = {{"position", EllipsoidJson(sets.position.ellipsoid, length)},
                       {"rotation", EllipsoidJson(sets.rotation.ellipsoid, angle)}};
}

ordered_json VertexCheckJson(const VertexCheck& check, const InUnits& units) {
  if (!check.converged)
    return {{"status", "failed"},
            {"position_difference", nullptr},
            {"rotation_difference", nullptr},
            {"relative", nullptr}};
  return {{"status", "converged"},
          {"position_difference", units.Length(check.position_difference_m)},
          {"rotation_difference", units.Angle(check.rotation_difference_rad)},
          {"relative", check.relative}};
}

ordered_json SourceJson(const SourceErrors& source, const InUnits& units) {
  ordered_json contributions = ordered_json::array();
  for (const Contribution& one : source.contributions)
    contributions.push_back({{"name", one.parameter},
                             {"position", units.Length(one.position_m)},
                             {"rotation", units.Angle(one.rotation_rad)}});
  return {{"name", source.name},
          {"label", source.name == "joints" ? "joint readings" : source.name},
          {"bound", EightJson(source.bound, units)},
          {"value_95", EightJson(source.value_95, units)},
          {"contributions", contributions}};
}

Eigen::MatrixXd CovarianceInUnits(Eigen::MatrixXd covariance, const InUnits& units) {
  for (Eigen::Index i = 0; i < covariance.rows(); ++i)
    for (Eigen::Index j = 0; j < covariance.cols(); ++j) covariance(i, j) /= units.Of(i) * units.Of(j);
  return covariance;
}

bool HasFullRank(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd scale = covariance.diagonal().cwiseMax(0).cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  return covariance.rows() == 6 &&
         Eigen::FullPivLU<Eigen::MatrixXd>(correlation).setThreshold(1e-9).rank() == 6;
}

void AddSources(const PoseAccuracy& accuracy, const InUnits& units, ordered_json& json) {
  ordered_json sources = ordered_json::array();
  for (const SourceErrors& source : accuracy.sources) sources.push_back(SourceJson(source, units));
  for (const MissingSource& missing : accuracy.missing_sources)
    sources.push_back(
        {{"name", missing.name}, {"bound", nullptr}, {"value_95", nullptr}, {"message", missing.reason}});
  json["sources"] = sources;
  json["together"] = SourceJson(*accuracy.together, units);
  json["together"]["of"] = accuracy.together->name;
  json["region_95"] = nullptr;  // a platform whose errors leave some coordinate exact has no such region
  if (HasFullRank(accuracy.together->covariance))
    json["region_95"] = {{"covariance", Rows(CovarianceInUnits(accuracy.together->covariance, units))},
                         {"chi_squared", kChiSquared95Of6}};
}

ordered_json FreeMotionsJson(const PlatformJacobian& jacobian, const InUnits& units) {
  ordered_json motions = ordered_json::array();
  for (const Eigen::VectorXd& motion : jacobian.free_motions) motions.push_back(units.Twist(motion));
  return motions;
}

void AddAccuracy(const PoseAccuracy& accuracy, const AccuracyRun& run, const InUnits& units,
                 ordered_json& json) {
  json["joint_readings"] = List(accuracy.joint_readings_m / units.length_m());
  const FullInverseJacobian in_unit = InLengthUnit(accuracy.inverse_jacobian, units.length_m());
  if (accuracy.max_error) {
    const MaximalErrors& errors = *accuracy.max_error;
    json["max_error"] = EightJson(errors.of_coordinate, errors.position_m(), errors.rotation_rad(), units);
    json["largest_direction"] = {{"position", List(errors.largest_position_m.normalized())},
                                 {"rotation", List(errors.largest_rotation_rad.normalized())}};
  }
  json["inverse_jacobian"] = Rows(in_unit.matrix);
  json["determinant"] = DeterminantOf(in_unit);
  AddIndices(accuracy, !run.settings.characteristic_length_m, json);
  if (accuracy.jacobian.status == PoseStatus::kSingular) {
    json["free_motions"] = FreeMotionsJson(accuracy.jacobian, units);
    return;
  }
  AddSets(*accuracy.sets, units, json);
  json["nonlinear"] = accuracy.vertex_check ? VertexCheckJson(*accuracy.vertex_check, units) : ordered_json();
  AddSources(accuracy, units, json);
}

ordered_json PoseJson(const JudgedPose& pose, const AccuracyRun& run, const InUnits& units) {
  ordered_json json = {{"name", pose.name},
                       {"pose", units.Twist(pose.coordinates)},
                       {"status", pose.status},
                       {"message", pose.message.empty() ? ordered_json() : ordered_json(pose.message)},
                       {"max_error", NoErrorsJson()},
                       {"inverse_jacobian", nullptr},
                       {"condition", nullptr},
                       {"determinant", nullptr},
                       {"manipulability", nullptr}};
  if (pose.accuracy) AddAccuracy(*pose.accuracy, run, units, json);
  return json;
}

// --- Over poses.

// Of the first two poses with polyhedra.
ordered_json IntersectionJson(const AccuracyRun& run, const InUnits& units) {
  std::vector<const JudgedPose*> two;
  for (const JudgedPose& pose : run.poses)
    if (two.size() < 2 && pose.accuracy && pose.accuracy->sets && pose.accuracy->sets->position.polyhedron &&
        pose.accuracy->sets->rotation.polyhedron)
      two.push_back(&pose);
  if (two.size() < 2) return nullptr;
  const ErrorSets &a = *two[0]->accuracy->sets, &b = *two[1]->accuracy->sets;
  return {
      {"between", {two[0]->name, two[1]->name}},
      {"position", PolyhedronJson(Intersection(*a.position.polyhedron, *b.position.polyhedron), units.Of(0))},
      {"rotation",
       PolyhedronJson(Intersection(*a.rotation.polyhedron, *b.rotation.polyhedron), units.Of(3))}};
}

ordered_json InversionsJson(const ComparedIndex& index, const Comparison& comparison, const InUnits& units,
                            bool of_position) {
  const Ranking& ranking = of_position ? index.by_position : index.by_rotation;
  const auto error = [&](size_t i) {
    return of_position ? units.Length(comparison.indices.position_m[i])
                       : units.Angle(comparison.indices.rotation_rad[i]);
  };
  ordered_json list = ordered_json::array();
  for (const Inversion& inversion : ranking.worst)
    list.push_back({{"of", of_position ? "position" : "rotation"},
                    {"better", comparison.names[inversion.preferred]},
                    {"worse", comparison.names[inversion.rejected]},
                    {"index", {index.values[inversion.preferred], index.values[inversion.rejected]}},
                    {"error", {error(inversion.preferred), error(inversion.rejected)}}});
  return list;
}

std::string UnitOfIndex(const std::string& key, const ordered_json& units) {
  return units.contains(key) ? units.at(key).get<std::string>() : "";
}

ordered_json MisrankedJson(const Ranking& ranking) {
  return ranking.clear_pairs > 0 ? ordered_json(ranking.misranked) : ordered_json();
}

ordered_json ComparisonJson(const Comparison& comparison, const ordered_json& unit_names,
                            const InUnits& units) {
  ordered_json indices = ordered_json::array();
  for (const ComparedIndex& index : comparison.indices.indices) {
    ordered_json inversions = InversionsJson(index, comparison, units, true);
    for (const ordered_json& one : InversionsJson(index, comparison, units, false)) inversions.push_back(one);
    indices.push_back(
        {{"key", index.key},
         {"label", IndexLabel(index.key)},
         {"unit", UnitOfIndex(index.key, unit_names)},
         {"tau", {{"position", index.by_position.tau}, {"rotation", index.by_rotation.tau}}},
         {"misranked",
          {{"position", MisrankedJson(index.by_position)}, {"rotation", MisrankedJson(index.by_rotation)}}},
         {"trusted",
          {{"position", MayBeTrusted(index.by_position)}, {"rotation", MayBeTrusted(index.by_rotation)}}},
         {"worst_inversions", inversions}});
  }
  return {{"over", comparison.over},
          {"poses", comparison.names.size()},
          {"indices", indices},
          {"verdict", VerdictOn(comparison.indices)}};
}

}  // namespace

ordered_json AccuracyJson(const AccuracyRun& run) {
  const InUnits units(run.settings);
  const ordered_json unit_names = UnitsJson(run);
  ordered_json poses = ordered_json::array();
  for (const JudgedPose& pose : run.poses) poses.push_back(PoseJson(pose, run, units));
  ordered_json document = {{"model", run.settings.model.string()},
                           {"robot", NameOf(run.robot.mechanism)},
                           {"program_version", ProgramVersion()},
                           {"warnings", AccuracyWarnings(run)},
                           {"units", unit_names},
                           {"conventions", ConventionsJson(run)},
                           {"definitions", DefinitionsJson(run)},
                           {"joint_error", List(run.options.joint_error_bounds / units.length_m())}};
  document["poses"] = poses;
  document["intersection"] = IntersectionJson(run, units);
  document["comparison"] =
      run.comparison ? ComparisonJson(*run.comparison, unit_names, units) : ordered_json();
  document["workspace"] = run.workspace ? WorkspaceJson(*run.workspace, run.settings) : ordered_json();
  return document;
}

}  // namespace legible
