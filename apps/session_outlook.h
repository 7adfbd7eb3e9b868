// What a session that is being held promises so far, and where it should go on.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib/pose_proposal.h"
#include "calib/session_calibration.h"
#include "core/session/session.h"
#include "core/vision/gray_image.h"

namespace legible {

struct OutlookOptions {
  bool proposes = true;    // false: poses come from elsewhere, and Next has hardly any
  std::uint64_t seed = 1;  // of the candidates for poses
  int threads = 2;
};

// A first look at an image, and the model that it leads to together with those before it.
struct Scout {
  ImageObservation look;
  RigModel model;
};

// What an image shows of the legs.
struct Sighting {
  ImageObservation observation;
  int edges = 0;         // of twelve, as measured
  std::string unusable;  // why the image tells nothing; empty: it does
  // While no model has been calibrated and first looks are few; none where it does not fit the earlier ones.
  std::optional<Scout> scout;
};

// Legs are looked for where the model has them: at first by a first look as a calibration takes it, for a
// camera placed by tape measure; from a few images on by the model that these lead to, which also foretells
// better. Everything depends on the session's images and their order alone: who goes on later goes on the
// same.
class SessionOutlook {
 public:
  // With the images that there are already, which are read. Throws std::invalid_argument as PoseProposer.
  SessionOutlook(const Session& session, const OutlookOptions& options);

  Sighting Look(const std::string& name, const GrayImage& image, const Vector6d& joint_readings_m) const;

  // The session's last image, just added to it, as seen by Look.
  void Add(const Session& session, const Sighting& sighting);

  std::optional<PoseProposal> Next() const { return proposer_->Next(); }
  // There it will not be sent (again); or, where it only showed nothing, not before legs are found otherwise.
  void Reject(const Rigid3& base_from_platform, bool for_good);

  ExpectedSigma Expected() const { return proposer_->Expected(); }
  const PoseCandidates& candidates() const { return proposer_->candidates(); }
  // Images that the model was calibrated from; 0: it is the drawing's.
  int images_in_model() const { return images_in_model_; }
  // Why the last attempt to calibrate failed; empty: it did not.
  const std::string& trouble() const { return trouble_; }

 private:
  void Propose(std::vector<ImageObservation> images);
  Sighting Measure(const RigModel& model, const std::string& name, const GrayImage& image,
                   const Vector6d& joint_readings_m, const LegEdgeOptions& options) const;
  RigModel Model() const;
  ImageObservation LookRoughly(const std::string& name, const GrayImage& image,
                               const Vector6d& joint_readings_m) const;
  std::optional<RigModel> Scouted(std::vector<ImageObservation> looks) const;
  bool Calibrate(const Session& session, size_t images);
  void Take(const Sighting& sighting);
  void AddToProposer(const ImageObservation& observation);

  OutlookOptions options_;
  LegCalibrationInput input_;  // start: the model
  EdgeNoise noise_;
  std::vector<ImageObservation> scouts_;
  std::optional<RigModel> scouted_;             // what they lead to
  std::vector<ImageObservation> observations_;  // by first looks
  std::vector<Rigid3> rejected_, rejected_for_now_;
  std::string trouble_;
  int images_in_model_ = 0;
  bool tells_something_ = false;  // some image; else no model can come of them
  std::unique_ptr<PoseProposer> proposer_;
};

}  // namespace legible
