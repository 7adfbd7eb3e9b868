// The readers of other tools' camera files, for ReadCamera. All throw InputError with file, line and mend.
#pragma once

#include <filesystem>
#include <string>

#include "datasets/camera_file.h"

namespace legible {

// cv::FileStorage with the names that OpenCV's calibration programs give: camera_matrix or cameraMatrix,
// distortion_coefficients or dist_coeffs, image_width and image_height or cameraResolution. 0, 4, 5 or 8
// coefficients, or 12 or 14 of which those beyond are 0; a fisheye where fisheye_model is 1 or
// calibrationModel fisheye.
CameraFile ReadOpenCvCamera(const std::filesystem::path& file, const std::string& text);

// A camchain with one camera: camera_model pinhole with distortion_model radtan, equidistant or none.
CameraFile ReadKalibrCamera(const std::filesystem::path& file, const std::string& text);

// The <camera> of vpXmlParserCamera. Of its models ProjWithKannalaBrandtDistortion counts first, then
// perspectiveProjWithDistortion, then perspectiveProjWithoutDistortion. kud is k1; kdu, ViSP's own
// approximation of the inverse, is passed over.
CameraFile ReadVispCamera(const std::filesystem::path& file, const std::string& text);

// LENSMODEL_PINHOLE, _OPENCV4, _OPENCV5, _OPENCV8. extrinsics (rt_cam_ref in later versions) that are not 0
// become camera_from_base, with a warning: the reference frame may be another camera's.
CameraFile ReadMrcalCamera(const std::filesystem::path& file, const std::string& text);

}  // namespace legible
