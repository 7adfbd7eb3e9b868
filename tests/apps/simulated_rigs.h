// Simulated rigs on the disk, with what is on paper of them, for commands that drive rigs.
#pragma once

#include <fmt/format.h>

#include <functional>

#include "datasets/simulation_file.h"
#include "datasets/synthetic_session.h"
#include "tests/apps/program_fixture.h"

namespace legible {

// A folder with a rig in `rig`: the desktop hexapod, its images `width` pixels wide.
class RigOnDisk : public testing::Test {
 protected:
  explicit RigOnDisk(int width) { MakeRig(width, 1); }

  // In place of the one that is there.
  void MakeRig(int width, int seed) const {
    std::filesystem::remove_all(rig());
    const ProgramRun run = RunLegible({"simulate", "--images", "0", "--width", std::to_string(width),
                                       "--seed", std::to_string(seed), "--out", rig().string()});
    if (run.exit_code != kExitSuccess) throw std::runtime_error(run.err);
  }

  std::filesystem::path rig() const { return folder_.path() / "rig"; }
  std::filesystem::path truth() const { return rig() / "truth.yaml"; }
  std::filesystem::path session() const { return folder_.path() / "session"; }

  void ChangeTruth(const std::function<void(SimulatedTruth&)>& change) const {
    SimulatedTruth simulated = ReadTruth(truth());
    change(simulated);
    WriteTruth(truth(), simulated);
  }

  ProgramRun Capture(std::vector<std::string> options) const {
    options.insert(options.begin(),
                   {"capture", "--rig", "sim:" + truth().string(), "--out", session().string()});
    return RunLegible(options);
  }

  // poses.csv with so many poses named p0, p1, …, near the desktop hexapod's home.
  std::filesystem::path WritePoses(int count) const {
    std::string text = "name,x,y,z,rx,ry,rz\n";
    for (int i = 0; i < count; ++i)
      text += fmt::format("p{},{},{},{},{},{},{}\n", i, 0.02 * std::sin(i), 0.02 * std::cos(i),
                          0.325 + 0.012 * std::sin(3 * i), 0.05 * std::cos(2 * i), 0.05 * std::sin(5 * i),
                          0.01 * (i % 5));
    return folder_.Write("poses.csv", text);
  }

  TemporaryFolder folder_;
};

}  // namespace legible
