#include "apps/accuracy_judgement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "apps/index_definitions.h"
#include "apps/wording.h"

namespace legible {
namespace {

constexpr double kLinearEnough = 0.05;  // relative difference from the non-linear answer
constexpr size_t kMostPosesNamed = 5;   // one by one

std::string Percent(double part) { return fmt::format("{:.{}f} %", 100 * part, part < 0.1 ? 1 : 0); }

std::string JointErrorText(const AccuracyRun& run) {
  return run.settings.joint_error_m == AccuracySettings().joint_error_m
             ? "joint errors of up to 1e-4 m were assumed: give --joint-error"
             : "";
}

// The verdict in one sentence.
std::string Headline(const IndexComparison& comparison, size_t trusted) {
  const ComparedIndex& any = comparison.indices.front();
  const size_t pairs = std::min(any.by_position.clear_pairs, any.by_rotation.clear_pairs);
  if (pairs < kLeastClearPairs)
    return fmt::format(
        "too little to judge the indices by: {} of poses differ by more than {} in position and rotation "
        "errors; give more "
        "poses, or --box",
        Plural(static_cast<int>(pairs), "pair"), Percent(kClearDifference));
  if (trusted == 0)
    return "no index may be trusted to order poses of this robot by their errors: use the maximal errors "
           "themselves";
  return fmt::format(
      "{} of {} indices may be trusted to order these poses by position and rotation errors: they misrank "
      "less than {} of "
      "the pairs whose errors differ by more than {}",
      trusted, comparison.indices.size(), Percent(kTrustedMisranked), Percent(kClearDifference));
}

// What there is to know of one pose; empty: nothing.
std::string WarningOf(const JudgedPose& pose) {
  if (!pose.message.empty()) return pose.message;
  if (!pose.accuracy || !pose.accuracy->vertex_check) return "";
  const VertexCheck& check = *pose.accuracy->vertex_check;
  if (!check.converged) return "forward kinematics does not converge at some corner of the joint errors";
  return check.relative > kLinearEnough
             ? fmt::format("errors in first order are off by {} of the true ones at the corners",
                           Percent(check.relative))
             : "";
}

}  // namespace

std::vector<std::string> AccuracyWarnings(const AccuracyRun& run) {
  std::vector<std::string> warnings;
  size_t concerned = 0;
  for (const JudgedPose& pose : run.poses) {
    const std::string text = WarningOf(pose);
    if (!text.empty() && ++concerned <= kMostPosesNamed)
      warnings.push_back(fmt::format("{}: {}", pose.name, text));
  }
  if (concerned > kMostPosesNamed)
    warnings.push_back(fmt::format("{} more have a status or an error in first order to look at",
                                   Plural(static_cast<int>(concerned - kMostPosesNamed), "pose")));
  if (run.workspace)
    for (const std::string& warning : WorkspaceWarnings(*run.workspace)) warnings.push_back(warning);
  if (const std::string text = JointErrorText(run); !text.empty()) warnings.push_back(text);
  return warnings;
}

std::vector<std::string> WorkspaceWarnings(const Workspace& workspace) {
  std::vector<std::string> warnings;
  const WorkspaceStatistics& found = workspace.statistics;
  if (found.certainty == Certainty::kRefinement && found.inside < found.samples)
    warnings.emplace_back(
        "the joint ranges cut the box, which Gauss' rule cannot follow: its half widths say too little; use "
        "sobol");
  if (found.quantities.empty())
    warnings.emplace_back(
        "hardly any pose of the box is within reach: no statistics; give a box where the robot goes");
  if (workspace.crosses_singularity || found.singular > 0)
    warnings.emplace_back(
        "a singularity crosses the box: means and variances of the errors do not exist there; read the "
        "quantiles");
  return warnings;
}

std::vector<std::string> VerdictOn(const IndexComparison& comparison) {
  std::vector<std::string> trusted, rest;
  for (const ComparedIndex& index : comparison.indices) {
    if (MayBeTrusted(index.by_position) && MayBeTrusted(index.by_rotation))
      trusted.push_back(IndexLabel(index.key));
    else
      rest.push_back(fmt::format(
          "the {} misranks {} of the pairs whose position errors differ by more than {}, and {} of "
          "those whose rotation errors do",
          IndexLabel(index.key), Percent(index.by_position.misranked), Percent(kClearDifference),
          Percent(index.by_rotation.misranked)));
  }
  std::vector<std::string> verdict = {Headline(comparison, trusted.size())};
  for (const std::string& label : trusted)
    verdict.push_back(
        fmt::format("the {} may be trusted to order poses of this robot by their errors", label));
  verdict.insert(verdict.end(), rest.begin(), rest.end());
  return verdict;
}

}  // namespace legible
