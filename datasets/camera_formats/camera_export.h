// A camera in the formats of other tools, with what that costs.
#pragma once

#include <string>
#include <vector>

#include "datasets/camera_file.h"
#include "datasets/camera_formats/camera_format.h"

namespace legible {

// How far what the file says lies from the camera, px over the image (FindNearestCamera).
struct ConversionError {
  std::string of;  // "projection", or ViSP's "way back from pixels"
  double rms_px = 0, max_px = 0;
};

struct ExportedCamera {
  std::string text;
  Camera camera;                         // as the file has it
  std::vector<ConversionError> errors;   // none: exact
  std::vector<std::string> left_behind;  // what the format has no place for
};

enum class OpenCvText { kYaml, kXml };

// The format's nearest camera: exact where it has the lens, else fitted over the image with focal lengths and
// principal point (FindNearestCamera).
//   ROS, OpenCV  every lens
//   Kalibr       radtan (k1 k2 p1 p2) or equidistant, whichever comes nearer
//   ViSP         for the fisheye ProjWithKannalaBrandtDistortion, for a pinhole
//   perspectiveProjWithoutDistortion, for
//                others perspectiveProjWithDistortion: one radial coefficient kud, and kdu for the way back
//   mrcal        LENSMODEL_PINHOLE, _OPENCV5, _OPENCV8, the last also for the fisheye; camera_from_base as
//   extrinsics
// Numbers read back as the same bits. Throws std::invalid_argument for a camera without a size.
ExportedCamera ExportCamera(const CameraFile& camera, CameraFormat format,
                            OpenCvText open_cv = OpenCvText::kYaml);

}  // namespace legible
