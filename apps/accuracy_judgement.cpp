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
  return run.settings.joint_error_m.empty() ? "joint errors of up to 1e-4 m were assumed: give --joint-error"
                                            : "";
}

bool HasEvidence(const Ranking& ranking) { return ranking.clear_pairs >= kLeastClearPairs; }

// Trusted where there is evidence; of kinds of errors that hardly differ between the poses nothing is asked.
bool MayOrder(const ComparedIndex& index) {
  return (MayBeTrusted(index.by_position) || !HasEvidence(index.by_position)) &&
         (MayBeTrusted(index.by_rotation) || !HasEvidence(index.by_rotation));
}

// "position and rotation", or the one of both that differs between the poses.
std::string KindsOf(const ComparedIndex& index) {
  if (HasEvidence(index.by_position) && HasEvidence(index.by_rotation)) return "position and rotation errors";
  return HasEvidence(index.by_position) ? "position errors" : "rotation errors";
}

// The verdict in one sentence.
std::string Headline(const IndexComparison& comparison, size_t trusted) {
  const ComparedIndex& any = comparison.indices.front();
  if (!HasEvidence(any.by_position) && !HasEvidence(any.by_rotation))
    return fmt::format(
        "too little to judge the indices by: {} of poses differ by more than {} in their errors; give more "
        "poses, or --box",
        Plural(static_cast<int>(std::max(any.by_position.clear_pairs, any.by_rotation.clear_pairs)), "pair"),
        Percent(kClearDifference));
  if (trusted == 0)
    return fmt::format(
        "no index may be trusted to order these poses by {}: use the maximal errors themselves",
        KindsOf(any));
  return fmt::format(
      "{} of {} indices may be trusted to order these poses by {}: they misrank less than {} of the pairs "
      "whose errors "
      "differ by more than {}",
      trusted, comparison.indices.size(), KindsOf(any), Percent(kTrustedMisranked),
      Percent(kClearDifference));
}

// What an index gets wrong; empty where nothing can be said.
std::string MisrankedText(const ComparedIndex& index) {
  std::string text;
  for (const auto& [name, ranking] :
       {std::pair("position", &index.by_position), std::pair("rotation", &index.by_rotation)})
    if (HasEvidence(*ranking))
      text += fmt::format("{}{} of the pairs whose {} errors differ by more than {}",
                          text.empty() ? "" : ", and ", Percent(ranking->misranked), name,
                          Percent(kClearDifference));
  return text.empty() ? "" : fmt::format("the {} misranks {}", IndexLabel(index.key), text);
}

// What there is to know of one pose; empty: nothing.
std::string WarningOf(const JudgedPose& pose) {
  if (!pose.message.empty()) return pose.message;
  if (!pose.accuracy || !pose.accuracy->vertex_check) return "";
  const VertexCheck& check = *pose.accuracy->vertex_check;
  if (!check.converged) return "forward kinematics does not converge at some corner of the joint errors";
  return check.relative > kLinearEnough
             ? fmt::format(
                   "at the corners of the joint errors the true errors are {} off those in first order",
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
    warnings.push_back(
        fmt::format("{} of {} samples lie where the robot can be: too few for statistics; give more "
                    "--samples, or a box where the robot goes",
                    found.inside, found.samples));
  if (workspace.crosses_singularity)
    warnings.emplace_back(
        "a singularity crosses the box: means and variances of the errors do not exist there; read the "
        "quantiles");
  return warnings;
}

std::vector<std::string> VerdictOn(const IndexComparison& comparison) {
  std::vector<std::string> trusted, rest;
  for (const ComparedIndex& index : comparison.indices) {
    const std::string misranked = MisrankedText(index);
    if (misranked.empty()) continue;
    (MayOrder(index) ? trusted : rest).push_back(MayOrder(index) ? IndexLabel(index.key) : misranked);
  }
  std::vector<std::string> verdict = {Headline(comparison, trusted.size())};
  if (!trusted.empty()) verdict.push_back(fmt::format("these may be trusted: {}", fmt::join(trusted, "; ")));
  verdict.insert(verdict.end(), rest.begin(), rest.end());
  return verdict;
}

}  // namespace legible
